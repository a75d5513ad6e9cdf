"""Every code has a wrong example that gives it and a right one that gives nothing."""

from __future__ import annotations

import json
import os
import re
import shlex
import socket
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import use_folders_in, write_tree
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.codes.files import NOTHING_FOUND, UNKNOWN_KIND
from robocomp_yaml.diag.codes.machines import UNKNOWN_ELEMENT
from robocomp_yaml.diag.page import Files, Repeated
from robocomp_yaml.source.discover import KINDS

pytestmark = pytest.mark.processes  # examples with programs ask the machine

ROWS = list(table().values())


@pytest.fixture(autouse=True)
def _nothing_more_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])


def _run(row: Code, files: Files, rcyaml: Callable[..., Result], folder: Path) -> list[dict[str, object]]:
    if "icegrid" in row.command:
        pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    texts = {path: str(it) if isinstance(it, Repeated) else it for path, it in files.items()}
    write_tree(folder, {path: _with_free_ports(it) if isinstance(it, str) else it for path, it in texts.items()})
    if any(path.startswith("site-packages/") for path in files):
        sys.path.insert(0, str(folder / "site-packages"))  # a plug-in that is installed; the fixture takes it away
    words = [name for word in shlex.split(row.command) for name in (sorted(os.listdir()) if word == "*" else [word])]
    result = rcyaml(*words, "--format", "json")
    return json.loads(result.stdout)["diagnostics"]


def _with_free_ports(text: str) -> str:
    """An example that listens at a port does so at one that nobody has."""
    for port in re.findall(r"create_server\(\('127\.0\.0\.1', (\d+)\)\)", text):
        with socket.create_server(("127.0.0.1", 0)) as free:
            text = text.replace(port, str(free.getsockname()[1]))
    return text


@pytest.fixture(autouse=True)
def own_folders(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """What an example installs is not there for the next one."""
    use_folders_in(tmp_path_factory.mktemp("user"), monkeypatch)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_the_wrong_example_gives_the_code(row: Code, rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    said = _run(row, row.wrong, rcyaml, tmp_path)
    assert row.id in [d["code"] for d in said]
    assert {d["code"] for d in said if d["severity"] == "error"} <= {row.id}
    assert {d["severity"] for d in said if d["code"] == row.id} == {row.severity}
    if row.command.startswith("check"):
        _can_be_fixed(said, rcyaml)


def _can_be_fixed(said: list[dict[str, object]], rcyaml: Callable[..., Result]) -> None:
    """What a hint says was meant is an edit, too, but in XML, whose elements have two names; and what can be fixed is,
    once, and leaves no more errors."""
    for told in said:
        if "did you mean" in str(told["hint"]) and told["code"] != UNKNOWN_ELEMENT.id:
            assert told["fixes"], told
            assert str(told["facts"]["meant"]) in str(told["hint"])  # type: ignore[index]
    if any(told["fixes"] for told in said):
        fixed, again = (json.loads(rcyaml("check", "--unsafe-fixes", "--format", "json").stdout) for _ in range(2))
        assert fixed["fixed"] and not again["fixed"]
        assert _errors(fixed["diagnostics"]) <= _errors(said)


def _errors(said: list[dict[str, object]]) -> int:
    return sum(told["severity"] == "error" for told in said)


@pytest.mark.parametrize("row", [row for row in ROWS if row.says], ids=lambda row: row.id)
def test_the_wrong_example_is_among_what_it_can_say(row: Code, rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    """A fact in a message fits any text, but not the messages' own words."""
    pattern = "|".join(_pattern(message) for message in row.says)
    for found in _run(row, row.wrong, rcyaml, tmp_path):
        assert found["code"] != row.id or re.fullmatch(pattern, str(found["message"])), found["message"]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_readers_see_words_apart(row: Code) -> None:
    """Where a fact goes on with a message's words, `says` has the messages that there are: no `takenWHEN`."""
    assert not [message for message in row.says or (row.message,) if re.search(r"(\w|\}['\"`]?)\{", message)]


def _pattern(message: str) -> str:
    message = re.sub(r" \(.*\)$", "", message)  # for readers
    parts = re.split(r"(?<!\{)\{[^{}]+\}(?!\})", message)
    return ".+".join(re.escape(part.replace("{{", "{").replace("}}", "}")) for part in parts)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_the_right_example_gives_nothing(row: Code, rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    assert _run(row, row.right, rcyaml, tmp_path) == []


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_it_is_explained(row: Code, rcyaml: Callable[..., Result]) -> None:
    shown = rcyaml("explain", row.id.lower())
    assert shown.exit_code == 0
    assert shown.stdout.startswith(f"{row.id} ({row.severity}): ")
    assert "Wrong:" in shown.stdout and "Right:" in shown.stdout


def test_the_list_has_them_all(rcyaml: Callable[..., Result]) -> None:
    assert [line.split()[0] for line in rcyaml("explain").stdout.splitlines()] == list(table())


def test_an_unknown_code_is_wrong_usage(rcyaml: Callable[..., Result]) -> None:
    result = rcyaml("explain", "RC209")
    assert result.exit_code == 2
    assert "did you mean RC" in result.stderr


@pytest.mark.parametrize("row", [UNKNOWN_KIND, NOTHING_FOUND], ids=lambda row: row.id)
def test_all_kinds_of_documents_are_named(row: Code) -> None:
    assert [kind for kind in KINDS if not re.search(rf"`(\.{kind}\.yaml|{kind})`", row.why)] == []
