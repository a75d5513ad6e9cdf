"""A compile is skipped if nothing changed, whatever is wrong with its documents; any other one is run."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.api import compile_stamps
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files, Repeated

# Without a stamp: a file that cannot be read may become readable unnoticed; programs matter only for `check`; of a file
# that a compile does not write, more is read than is in the stamp; the cause of a failing plug-in is unknown; a user's
# file is in the way.
NEVER = {"RC0001", "RC0081", "RC0082", "RC0083", "RC2010", "RC3330", "RC4403", "RC4404"}


def _paths(row: Code) -> list[str]:
    words = shlex.split(row.command)
    return words[1:] if words[0] == "check" and not any(word[0] in "-*" for word in words) else []


ROWS = [row for row in table().values() if _paths(row) and row.id not in NEVER]


def _plain(files: Files) -> dict[str, str | bytes | None]:
    return {name: str(it) if isinstance(it, Repeated) else it for name, it in files.items()}


def _run(paths: list[str]) -> api.Outcome:
    return api.load(*paths).compile().apply()


def _told(outcome: api.Outcome) -> object:
    return outcome.diagnostics, sorted((file.path, file.action) for file in outcome.files), outcome.left_out


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_documents_with_errors(row: Code, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(write_tree(tmp_path, _plain(row.wrong)))
    paths = _paths(row)
    _run(paths)
    again = _run(paths)
    kept = compile_stamps.earlier_outcome(compile_stamps.CompileArguments(paths, ()))
    assert kept is not None, "the compile is run again"
    assert _told(kept) == _told(again)
    for name in {*row.wrong} - {*row.right}:
        if os.path.lexists(name):
            os.unlink(name) if not os.path.isdir(name) or os.path.islink(name) else os.rmdir(name)
    write_tree(tmp_path, {name: it for name, it in _plain(row.right).items() if row.wrong.get(name) != it})
    assert compile_stamps.earlier_outcome(compile_stamps.CompileArguments(paths, ())) is None, (
        "the error is reported after its cause is removed"
    )
