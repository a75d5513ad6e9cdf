"""What somebody sees who tries commands in the wrong folder, with the wrong file, or with a word that is nearly right."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree

Run = Callable[..., Any]

COMPONENT = {
    "rcyaml.yaml": "",
    "arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n",
    "arm.pdsl.yaml": "component: arm.cdsl.yaml\ntypes:\n  Motor: {struct: {id: int, key: string}}\n"
    "parameters:\n  pin: {type: int, range: [0, 9], default: 1}\n  motors: {list: Motor}\n",
    "etc/config.yaml": "parameters:\n  pin: {env: PIN}\n  motors: [{id: 1, key: {env: KEY}}]\n",
}


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    write_tree(tmp_path, COMPONENT)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "etc" / "config.yaml"


@pytest.mark.parametrize("command", ["compile", "fmt"])
def test_an_empty_folder_has_one_summary(
    command: str, rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = rcyaml(command).stdout.splitlines()
    assert lines[-1] == "0 documents: 1 error" and sum(line.startswith("0 documents") for line in lines) == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["run"], "this folder has no component; `rcyaml new component NAME` writes one"),
        (["migrate"], "`rcyaml migrate .` converts all below this folder"),
        (["top"], "`rcyaml new deployment NAME` writes one"),
        (["explain", "RC9999"], "`rcyaml explain` lists all"),
        (["fmt", "nowhere"], "Invalid value for 'PATH': Path 'nowhere' does not exist"),
        (["deploy", "plan", "nowhere.yaml"], "Invalid value for 'DDSL': Path 'nowhere.yaml' does not exist"),
        (["deploy", "export"], "Missing option '--as'. Choose from: compose, icegrid, rcmanager, systemd"),
        (["mock", "notes.txt"], "--script notes.txt reads a script"),
        (["mock", "Pump.idsl.yaml"], "is a file: an interface or topic is named"),
    ],
)
def test_a_command_says_what_to_type_instead(
    words: list[str], said: str, rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))  # no deployment runs, whatever other tests have left
    for name in ("notes.txt", "Pump.idsl.yaml"):
        (tmp_path / name).write_text("hi\n")
    done = rcyaml(*words)
    assert done.exit_code == 2 and said in " ".join(done.stderr.split())


def test_a_value_out_of_range_is_shown_as_it_was_typed(rcyaml: Run, arm: Path) -> None:
    before = arm.read_text()
    done = rcyaml("config", "set", "pin", "12")
    assert done.exit_code == 1 and "1 │ 12\n" in done.stderr and "parameters:" not in done.stderr
    assert arm.read_text() == before


@pytest.mark.parametrize(
    ("path", "value", "reference"),
    [
        ("pin", "5", "{env: PIN}"),
        ("motors", "[{id: 2, key: secret}]", "{env: KEY}"),
        ("motors[0].key", "x", "{env: KEY}"),
    ],
)
def test_a_reference_is_not_replaced_by_plain_text(
    path: str, value: str, reference: str, rcyaml: Run, arm: Path
) -> None:
    before = arm.read_text()
    done = rcyaml("config", "set", path, value)
    assert done.exit_code == 2 and f"from {reference}: change it there" in " ".join(done.stderr.split())
    assert arm.read_text() == before


def test_another_reference_or_the_default_replace_it(rcyaml: Run, arm: Path) -> None:
    assert rcyaml("config", "set", "pin", "{env: OTHER}").exit_code == 0
    assert rcyaml("config", "set", "motors", "[{id: 2, key: {env: KEY}}]").exit_code == 0
    assert rcyaml("config", "set", "pin", "null").exit_code == 0
    assert rcyaml("config", "set", "pin", "5").exit_code == 0


def test_explain_needs_only_the_digits(rcyaml: Run) -> None:
    assert rcyaml("explain", "2003").stdout == rcyaml("explain", "RC2003").stdout


@pytest.mark.parametrize("columns", [60, 80, 300])
def test_explanations_fit_the_terminal(
    columns: int, rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    for code in ("RC0101", "RC2003", "RC4002"):
        lines = rcyaml("explain", code).stdout.partition("\n\n")[2].splitlines()  # without the message
        assert max(map(len, lines)) <= min(columns, 100)


def test_the_files_of_an_explanation_are_apart(rcyaml: Run, tmp_path: Path) -> None:
    lines = rcyaml("explain", "RC2003").stdout.splitlines()
    assert all(lines[number - 1] == "" for number, line in enumerate(lines) if line.startswith("  # "))


def test_quiet_json_is_still_json(rcyaml: Run, arm: Path) -> None:
    assert json.loads(rcyaml("-q", "check", "--format", "json").stdout)["diagnostics"] == []
    assert rcyaml("-q", "check").stdout == ""


def test_the_kinds_are_a_table(rcyaml: Run, arm: Path) -> None:
    rcyaml("init")
    lines = rcyaml("schema").stdout.splitlines()
    assert len({line.index(".rcyaml/schemas/") for line in lines}) == 1


def test_an_unknown_language_of_a_new_entry_is_wrong_usage(rcyaml: Run, arm: Path) -> None:
    rcyaml("new", "deployment", "Robot")
    done = rcyaml("edit", "add", "leg", "LegComp", "--new", "--language", "rust")
    assert done.exit_code == 2 and "'rust' is not one of 'python', 'cpp', 'java'" in " ".join(done.stderr.split())
    done = rcyaml("edit", "add", "leg", "arm.cdsl.yaml", "--language", "python")
    assert done.exit_code == 2 and "add --new" in done.stderr


def test_the_place_of_a_node_as_json(rcyaml: Run, arm: Path) -> None:
    rcyaml("new", "deployment", "Robot")
    data = json.loads(rcyaml("edit", "place", "arm", "10", "20", "--format", "json").stdout)
    assert data["name"] == "arm" and data["position"] == [10, 20]
    assert json.loads(rcyaml("edit", "place", "arm", "--format", "json").stdout)["position"] is None
