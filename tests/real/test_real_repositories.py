"""Exported repositories of other people: migrated, compiled in place, and their Python components stepped.

`RCYAML_REAL` is a folder with a repository in each folder: a tree of files, not bare git. Other repositories are looked
up for interfaces in `robocomp/interfaces/IDSLs`, if it is there. The last test prints a table. Nothing of them is part
of rcyaml: what they teach becomes a test with code of our own.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

FOLDER = os.environ.get("RCYAML_REAL", "")
REPOSITORIES = sorted(path for path in Path(FOLDER).iterdir() if path.is_dir()) if FOLDER else []
RCYAML = [sys.executable, "-m", "robocomp_yaml"]
STEP = Path(__file__).with_name("step.py")
IDSLS = "robocomp/interfaces/IDSLs"
MADE, STEPPED = 0.97, 0.95
OWN_FAULTS = ("RC6101", "RC6003", "RC6009")
"""An import that is nowhere, and several components in one folder."""
FAULTS_OF_CODE = re.compile(
    r"FileNotFoundError|EOFError|termios\.error|SystemExit|No end:|attempted relative import|model is not found"
)
"""Files and devices that are not in the repository, a terminal, code that waits for a fake, or is no script."""

pytestmark = [
    pytest.mark.skipif(not REPOSITORIES, reason="RCYAML_REAL names no folder with exported repositories"),
    pytest.mark.processes,
]


@dataclass
class Figures:
    """What became of the components of a repository, by name and cause."""

    components: int = 0
    made: int = 0
    not_made: list[str] = field(default_factory=list)
    stepped: int = 0
    python_2: int = 0
    not_stepped: list[str] = field(default_factory=list)
    class_reports: list[str] = field(default_factory=list)
    """What is said of the user's classes, for a person to judge: none of it may be false."""


TABLE: dict[str, Figures] = {}


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*RCYAML, *words], cwd=folder, text=True, capture_output=True, timeout=600)


def components(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*.cdsl.yaml")):
        if ".rcyaml" not in path.parts:
            yield path


@pytest.mark.parametrize("repository", REPOSITORIES, ids=lambda path: path.name)
def test_a_repository(repository: Path, tmp_path: Path) -> None:
    folder = tmp_path / repository.name
    shutil.copytree(repository, folder, symlinks=True)
    search = ["-I", str(Path(FOLDER) / IDSLS)] if (Path(FOLDER) / IDSLS).is_dir() else []
    migrated = run(folder, "migrate", ".", *(search if repository.name != "robocomp" else []))
    assert migrated.returncode in (0, 1) and "Traceback" not in migrated.stderr, migrated.stderr
    checked = run(folder, "check", "--format", "json")
    assert "Traceback" not in checked.stderr, checked.stderr
    compiled = run(folder, "compile", "--format", "json")
    assert "Traceback" not in compiled.stderr, compiled.stderr
    faults = json.loads(compiled.stdout)["diagnostics"]
    figures = TABLE[repository.name] = Figures()
    figures.class_reports = [
        f"{one['code']} {one['file']}:{one['line']}: {one['message']}" for one in faults
        if one["code"].startswith("RC62") and one["code"] != "RC6207"
    ]  # fmt: skip
    excused = 0
    for document in components(folder):
        figures.components += 1
        home = document.parent
        if (home / "generated/component.cmake").exists() or (home / "generated/component.py").exists():
            figures.made += 1
            continue
        mine = {one["code"] for one in faults if one["file"] and (folder / one["file"]).parent == home}
        excused += bool(mine & set(OWN_FAULTS))
        figures.not_made.append(f"{document.relative_to(folder)}: {', '.join(sorted(mine)) or 'see its imports'}")
    assert figures.made >= MADE * (figures.components - excused), figures.not_made
    step_python(folder, figures)
    told = [one for one in figures.not_stepped if not FAULTS_OF_CODE.search(one) and not lacks_setting(folder, one)]
    stepped = figures.stepped + len(told)
    assert not stepped or figures.stepped >= STEPPED * stepped, told


def step_python(folder: Path, figures: Figures) -> None:
    for document in components(folder):
        home = document.parent
        worker = home / "src/specificworker.py"
        if not (home / "generated/component.py").exists() or not worker.exists():
            continue
        if "compatibility: robocomp" not in document.read_text(encoding="utf-8"):
            continue
        if subprocess.run([sys.executable, "-m", "py_compile", worker], capture_output=True, timeout=60).returncode:
            figures.python_2 += 1
            continue
        try:
            done = subprocess.run(
                [sys.executable, STEP, home],
                cwd=home,
                text=True,
                capture_output=True,
                timeout=60,
                stdin=subprocess.DEVNULL,
            )
            found = json.loads(done.stdout[done.stdout.rindex('{"stage"') :])
        except (subprocess.TimeoutExpired, ValueError):
            found = {"stage": "start", "wrong": "No such file: it ended without a report"}
        if found["stage"] == "done":
            figures.stepped += 1
        else:
            wrong = found["wrong"].strip().splitlines() or [""]
            last = wrong[0] if wrong[0].startswith("No end:") else " ".join(wrong[-2:])
            figures.not_stepped.append(f"{home.relative_to(folder)}: {found['stage']}: {last}")


def lacks_setting(folder: Path, wrong: str) -> bool:
    """Whether the code needs a setting that another configuration of the component has, but not `etc/config`."""
    home, _, message = wrong.partition(": ")
    key = re.search(r"KeyError: '([\w.]+)'", message)
    etc = folder / home / "etc"
    texts = {path.name: path.read_text(errors="replace") for path in etc.glob("config*") if path.suffix != ".yaml"}
    setting = re.compile(rf"(?m)^\s*{re.escape(key[1])}\s*=") if key else None
    with_it = {name for name, text in texts.items() if setting and setting.search(text)}
    return bool(with_it) and "config" not in with_it


def test_table(capsys: pytest.CaptureFixture[str]) -> None:
    """The table by repository, with every component that is not made or not stepped, and its cause."""
    with capsys.disabled():
        print("\nrepository | components | made | stepped | Python 2 | not stepped | reports on classes")
        for name, one in TABLE.items():
            counts = [one.components, one.made, one.stepped, one.python_2, len(one.not_stepped), len(one.class_reports)]
            print(name, *counts, sep=" | ")
            for line in (*one.not_made, *one.not_stepped, *one.class_reports):
                print(f"    {line}")
    assert set(TABLE) <= {path.name for path in REPOSITORIES}
