"""Rules, types and layers of the code, as `make lint` looks at them; and that the API is typed for those who use it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT, write_tree
from tools import lint

USER = """\
from robocomp_yaml import api

workspace = api.load("robot", include=["shared"], overlay={"Arm.idsl.yaml": "module: RoboCompArm\\n"})
errors: list[api.Diagnostic] = [told for told in workspace.check() if told.severity == api.ERROR]
places: list[tuple[str, int]] = [(told.span.file, told.span.line) for told in errors]
plan: api.Compilation = workspace.compile()
written: list[str] = [file.path for file in plan.apply().files] if not plan.has_errors else []
processes: list[str] = [process.name for process in workspace.network().processes.values()]
values: api.Values = workspace.values("arm")
rows: list[api.Value] = workspace.values("arm").rows()
try:
    carried: api.Migration = api.migrate("old", output="new")
    print(carried.lost, [file.path for file in carried.files])
except (api.Refused, api.Faulty) as error:
    print(error)
"""
MISTAKES = {
    "a folder that is no text": ('api.load("robot", ', "api.load(3, ", "arg-type"),
    "an option that is not there": ("include=", "includes=", "call-arg"),
    "an attribute that is not there": ("told.span.line", "told.line", "attr-defined"),
    "a name that is no part of it": ("api.Values", "api.Analysis", "name-defined"),
    "one value for a list": ("rows: list[api.Value]", "rows: api.Value", "assignment"),
}


@pytest.mark.parametrize("name", lint.CHECKS)
def test_nothing_is_found(name: str) -> None:
    done = lint.run(lint.CHECKS[name])
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_check_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert lint.main("typos") == 2
    assert "unknown: typos; there are rules, " in capsys.readouterr().err


def mypy(folder: Path, text: str) -> subprocess.CompletedProcess[str]:
    """What mypy says of a user's script, in a folder where nothing is known of this project."""
    write_tree(folder, {"use.py": text, "mypy.ini": "[mypy]\nstrict = true\n"})
    cache = ROOT / ".mypy_cache" / "users"
    command = [sys.executable, "-m", "mypy", "--config-file", "mypy.ini", "--cache-dir", str(cache), "use.py"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_a_script_of_a_user_is_typed(tmp_path: Path) -> None:
    done = mypy(tmp_path, USER)
    assert done.returncode == 0, done.stdout + done.stderr


def test_its_mistakes_are_seen(tmp_path: Path) -> None:
    """All in one script, and each is told at its line."""
    wrong = USER
    for before, after, _ in MISTAKES.values():
        assert before in wrong
        wrong = wrong.replace(before, after)
    said = mypy(tmp_path, wrong).stdout
    for what, (_, after, code) in MISTAKES.items():
        line = next(number for number, text in enumerate(wrong.splitlines(), 1) if after in text)
        assert any(one.startswith(f"use.py:{line}:") and f"[{code}]" in one for one in said.splitlines()), (what, said)
