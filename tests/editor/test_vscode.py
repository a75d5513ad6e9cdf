"""The extension for VS Code: its parts by themselves, its package, and its problem matchers on real output."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from conftest import ROOT
from editor.robot import write_robot
from robocomp_yaml.link.workspace_files import GLOBS
from terminals import COMMAND, environment

EXTENSION = ROOT / "editors/vscode"
MANIFEST = json.loads((EXTENSION / "package.json").read_text())
pytestmark = pytest.mark.processes


def node(*command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    if shutil.which(command[0]) is None:
        pytest.skip(f"the extension needs {command[0]} (Debian: apt install nodejs npm)")
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the extension beside its libraries, which are installed once for this user."""
    lock = hashlib.sha256((EXTENSION / "package-lock.json").read_bytes()).hexdigest()[:12]
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rcyaml" / "editor-tests"
    libraries = cache / f"vscode-{lock}"
    if not libraries.is_dir():
        part = cache / f"vscode-{lock}.{os.getpid()}"
        part.mkdir(parents=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(EXTENSION / name, part)
        done = node("npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", folder=part)
        if done.returncode == 0 and not libraries.exists():
            part.rename(libraries)
        shutil.rmtree(part, ignore_errors=True)
        if not libraries.exists():
            pytest.skip(f"npm cannot install the libraries: {done.stderr.strip().splitlines()[-1:]}")
    folder = tmp_path_factory.mktemp("extension") / "editors/vscode"
    shutil.copytree(EXTENSION, folder, ignore=shutil.ignore_patterns("node_modules", "dist", "*.vsix"))
    shutil.copy(ROOT / "LICENSE", folder.parents[1])
    (folder / "node_modules").symlink_to(libraries / "node_modules")
    return folder


def test_its_parts(tmp_path: Path) -> None:
    done = node("node", "--test", "test/", folder=EXTENSION)
    assert done.returncode == 0, done.stdout


def test_it_is_packaged_without_the_libraries(installed: Path) -> None:
    version = node("node", "-p", "process.versions.node", folder=installed).stdout.strip()
    if int(version.partition(".")[0]) < 20:
        pytest.skip(f"vsce needs Node 20, and this is {version}")
    done = node("npm", "run", "package", folder=installed)
    assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(installed / "rcyaml.vsix") as package:
        names = set(package.namelist())
    assert {"extension/package.json", "extension/dist/extension.js", "extension/readme.md"} <= names
    assert not [name for name in names if "node_modules" in name or "/src/" in name or "/test/" in name]


def test_its_kinds_are_ours() -> None:
    script = (
        "const {kindOf} = require('./src/documents'); const kinds = JSON.parse(process.argv[1]);"
        "console.log(JSON.stringify(kinds.map((path) => kindOf('/w/' + path))))"
    )
    globs = [(kind, glob.replace("*", "arm")) for kind, patterns in GLOBS.items() for glob in patterns]
    done = node("node", "-e", script, json.dumps([path for _, path in globs]), folder=EXTENSION)
    assert json.loads(done.stdout) == [kind for kind, _ in globs]


def test_its_problem_matcher_reads_what_rcyaml_prints(tmp_path: Path) -> None:
    write_robot(tmp_path)
    (tmp_path / "components/wheels/wheels.cdsl.yaml").write_text("component: A\nlanguage: python\nrequires: [Gone]\n")
    (tmp_path / "interfaces/Odd.idsl.yaml").write_text("module: RoboCompOdd\ntypes: {P: {struct: {x: itn}}}\n")
    printed = subprocess.run(
        [*COMMAND, "check"], cwd=tmp_path, capture_output=True, text=True, env=environment(), check=False
    ).stdout.splitlines()
    first, second = (re.compile(one["regexp"]) for one in MANIFEST["contributes"]["problemMatchers"][0]["pattern"])
    found = [
        (head[2], place[1], int(place[2]), int(place[3]))
        for line, following in itertools.pairwise(printed)
        if (head := first.match(line)) and (place := second.match(following))
    ]
    assert ("RC2003", "components/wheels/wheels.cdsl.yaml", 3, 12) in found
    assert ("RC1010", "interfaces/Odd.idsl.yaml", 2, 25) in found
    assert len(found) == sum(bool(first.match(line)) for line in printed)


def test_its_problem_matcher_knows_the_begin_and_the_end_of_a_run_of_watch(tmp_path: Path) -> None:
    watch = MANIFEST["contributes"]["problemMatchers"][1]["background"]
    (tmp_path / "Odd.idsl.yaml").write_text("module: RoboCompOdd\n")
    printed = subprocess.run(
        [*COMMAND, "compile"], cwd=tmp_path, capture_output=True, text=True, env=environment(), check=False
    ).stdout.splitlines()
    assert re.match(watch["endsPattern"], printed[-1]) and re.match(watch["endsPattern"], "3 documents: 1 error")
    assert re.match(watch["beginsPattern"], "interfaces/Odd.idsl.yaml changed")


def test_its_check_of_the_program_finds_ours() -> None:
    script = "require('./src/program').problemOf(process.argv[1], '/').then((problem) => console.log(problem))"
    program = Path(sys.executable).with_name("rcyaml")
    if not program.is_file():
        pytest.skip("rcyaml is not installed beside this Python")
    done = node("node", "-e", script, str(program), folder=EXTENSION)
    assert done.stdout.strip() == ""
