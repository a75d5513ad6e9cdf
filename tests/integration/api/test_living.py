"""The living analysis: every diagnostic moves with its line and goes with its cause; files that appear and vanish."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from msgspec.structs import replace

from conftest import Tree, write_tree
from robocomp_yaml import api
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files, Repeated
from robocomp_yaml.network.network import Network

ROWS = [row for row in table().values() if row.command.startswith("check")]
LONGEST = 100_000


def shown(networks: Mapping[str, Network]) -> str:
    """The networks as text, without the functions that look up the origin of values."""
    return repr({path: replace(network, settings={}) for path, network in networks.items()})


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])


def _texts(files: Files) -> Tree:
    return {path: str(it) if isinstance(it, Repeated) else it for path, it in files.items()}


def _shifted(files: Tree) -> dict[str, str]:
    """The documents with another line above all others, as an editor has them."""
    return {
        path: f"# more\n{text}"
        for path, text in files.items()
        if isinstance(text, str) and path.endswith(".yaml") and not text.startswith(("-> ", "%", "\ufeff"))
    }


def _is_as_fresh(living: api.LivingWorkspace) -> list[api.Diagnostic]:
    found, fresh = living.load(), api.load(overlay=living.unsaved)
    assert found.check() == fresh.check()
    assert shown(found.networks) == shown(fresh.networks)
    return found.check()


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_a_diagnostic_moves_with_its_line_and_goes_with_its_cause(row: Code) -> None:
    wrong, right = _texts(row.wrong), _texts(row.right)
    if sum(len(text) for text in wrong.values() if text is not None) > LONGEST:
        pytest.skip("it takes long")
    write_tree(Path(), wrong)
    if any(path.startswith("site-packages/") for path in wrong):
        sys.path.insert(0, os.path.abspath("site-packages"))
    living = api.follow()
    before = [one for one in _is_as_fresh(living) if one.code == row.id]
    for path, text in _shifted(wrong).items():
        living.edit(path, text)
        _is_as_fresh(living)
    after = [one for one in _is_as_fresh(living) if one.code == row.id]
    assert len(before) == len(after)
    for path in living.unsaved:
        living.edit(path, None)
    assert [one for one in _is_as_fresh(living) if one.code == row.id] == before
    for path in wrong.keys() - right.keys():
        if Path(path).is_file() and not path.startswith("site-packages/"):
            Path(path).unlink()
    for path, content in right.items():
        if isinstance(content, str) and path.endswith(".yaml"):
            living.edit(path, content)
        elif not Path(path).is_symlink():
            write_tree(Path(), {path: content})
    _is_as_fresh(living)
