"""`rcyaml fmt`: documents in the one layout, written whole or not at all."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
UNTIDY = "module:   RoboCompLaser # one\ntypes:\n    Scan: {sequence:   float}\n"
TIDY = "module: RoboCompLaser # one\ntypes:\n  Scan: {sequence: float}\n"
FILES = {
    "Laser.idsl.yaml": UNTIDY,
    "sub/Other.idsl.yaml": "module: RoboCompOther\n",
    "broken.cdsl.yaml": "component: {a\n",
    "rcyaml.yaml": "interfaces:   [ . ]\n",
    "notes.yaml": "a:    1\n",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_tree(tmp_path, FILES)
    return tmp_path


def test_documents_are_laid_out_and_others_stay(rcyaml: Run, folder: Path) -> None:
    run = rcyaml("fmt")
    assert run.exit_code == 1  # since one is broken
    assert "RC0101" in run.output and "broken.cdsl.yaml:1:" in run.output
    assert "2 documents formatted, 2 as they were" in run.output
    texts = {name: (folder / name).read_text() for name in FILES}
    assert texts == FILES | {"Laser.idsl.yaml": TIDY, "rcyaml.yaml": "interfaces: [.]\n"}


def test_a_second_time_nothing_changes(rcyaml: Run, folder: Path) -> None:
    (folder / "broken.cdsl.yaml").unlink()
    assert rcyaml("fmt").exit_code == 0
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*.yaml")}
    run = rcyaml("fmt", "--check")
    assert (run.exit_code, run.output) == (0, "0 documents would be formatted, 3 as they were\n")
    assert rcyaml("fmt").exit_code == 0
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.yaml")} == before


@pytest.mark.parametrize("option", ["--check", "--diff"])
def test_what_would_change_is_shown_and_not_written(rcyaml: Run, folder: Path, option: str) -> None:
    run = rcyaml("fmt", option, "Laser.idsl.yaml")
    assert run.exit_code == (1 if option == "--check" else 0)
    assert ("would format  Laser.idsl.yaml" if option == "--check" else "+  Scan:") in run.output
    assert (folder / "Laser.idsl.yaml").read_text() == UNTIDY


def test_json(rcyaml: Run, folder: Path) -> None:
    told = json.loads(rcyaml("fmt", "--diff", "--format", "json").stdout)
    assert [one["code"] for one in told["diagnostics"]] == ["RC0101"]
    assert [(one["path"], one["action"]) for one in told["files"]] == [
        ("Laser.idsl.yaml", "format"),
        ("rcyaml.yaml", "format"),
    ]
    assert "+module: RoboCompLaser # one" in told["files"][0]["diff"]
    assert [one["action"] for one in json.loads(rcyaml("fmt", "--format", "json").stdout)["files"]] == ["formatted"] * 2


def test_a_file_that_cannot_be_written_is_left_and_the_command_fails(rcyaml: Run, folder: Path) -> None:
    if os.geteuid() == 0:
        os.chmod(folder / "Laser.idsl.yaml", 0)  # root is refused by the mode as well
    else:
        os.chmod(folder / "Laser.idsl.yaml", stat.S_IRUSR)
    run = rcyaml("fmt", "Laser.idsl.yaml")
    assert run.exit_code == 1
    assert "left       Laser.idsl.yaml: it is read-only" in run.output
    os.chmod(folder / "Laser.idsl.yaml", 0o644)
    assert (folder / "Laser.idsl.yaml").read_text() == UNTIDY


def test_the_mode_of_a_file_stays(rcyaml: Run, folder: Path) -> None:
    os.chmod(folder / "Laser.idsl.yaml", 0o640)
    rcyaml("fmt", "Laser.idsl.yaml")
    assert (folder / "Laser.idsl.yaml").stat().st_mode & 0o777 == 0o640


def test_standard_input(rcyaml: Run, folder: Path) -> None:
    assert rcyaml("fmt", "-", stdin=UNTIDY).stdout == TIDY
    run = rcyaml("fmt", "-", stdin="a: {b\n")
    assert (run.exit_code, run.stdout) == (1, "")
    assert "<stdin>:1:" in run.stderr
    run = rcyaml("fmt", "-", "--check", stdin=UNTIDY)
    assert (run.exit_code, run.stdout) == (1, "")
    run = rcyaml("fmt", "-", "--check", stdin=TIDY)
    assert (run.exit_code, run.stdout) == (0, "")
    run = rcyaml("fmt", "-", "--diff", stdin="a:   1\n")
    assert (run.exit_code, run.stdout) == (0, "--- a/<stdin>\n+++ b/<stdin>\n@@ -1 +1 @@\n-a:   1\n+a: 1\n")
    assert rcyaml("fmt", "-", "--format", "json", stdin="").exit_code == 2
    assert rcyaml("fmt", "-", "Laser.idsl.yaml", stdin="").exit_code == 2


def test_secrets_are_hidden_in_what_would_change(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "a.cdsl.yaml": "component: A\nlanguage: python\n",
        "a.pdsl.yaml": "component: a.cdsl.yaml\nparameters: {key: {type: string, secret: true}}\n",
        "etc/config.yaml": "component: ../a.cdsl.yaml\nparameters:\n    key:    hunter2\n",
    })  # fmt: skip
    run = rcyaml("fmt", "--diff")
    assert "+  key: " in run.output and "hunter2" not in run.output


def test_names_that_are_no_documents(rcyaml: Run, folder: Path) -> None:
    run = rcyaml("fmt", "notes.yaml")
    assert run.exit_code == 1 and (folder / "notes.yaml").read_text() == FILES["notes.yaml"]
    assert rcyaml("fmt", "nowhere.idsl.yaml").exit_code == 2
