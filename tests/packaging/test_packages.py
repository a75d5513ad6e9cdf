"""The wheel and the sdist carry what rcyaml needs, and work where no checkout is near."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from conftest import ROOT, read_tree, write_tree

pytestmark = pytest.mark.slow

DATA = ("schemas", "templates", "migrate")
COMPONENT = {
    "Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n",
    "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
    "old/Mouth.idsl": "module RoboCompMouth { interface Mouth { void open(); }; };\n",
}


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--outdir", str(folder), str(ROOT))
    return folder


def run(*command: str, cwd: Path | None = None) -> str:
    plain = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "RCYAML"))}
    done = subprocess.run(command, cwd=cwd, env=plain, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def data_files(inside: str) -> set[str]:
    return {
        f"{inside}{name}/{path.relative_to(ROOT / name).as_posix()}"
        for name in DATA
        for path in (ROOT / name).rglob("*")
        if path.is_file() and path.suffix not in (".pyc", ".swp") and "__pycache__" not in path.parts
    }


def test_the_wheel_has_all_data(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    assert data_files("robocomp_yaml/_data/") <= names
    assert not [name for name in names if name.startswith(("tests/", "docs/", "examples/"))]


def test_the_sdist_has_all_data(built: Path) -> None:
    (sdist,) = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert data_files("") <= names
    assert {"pyproject.toml", "README.md", "LICENSE", "Makefile", "tests/conftest.py"} <= names


def test_it_works_outside_the_checkout(built: Path, tmp_path: Path) -> None:
    """The wheel, which `build` has made from the sdist."""
    (package,) = built.glob("*.whl")
    run(sys.executable, "-m", "venv", str(tmp_path / "venv"))
    python = str(tmp_path / "venv" / "bin" / "python")
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", str(package))
    work = write_tree(tmp_path / "work", COMPONENT)
    rcyaml = str(tmp_path / "venv" / "bin" / "rcyaml")
    run(rcyaml, "migrate", "old", cwd=work)
    run(rcyaml, "check", cwd=work)
    run(rcyaml, "compile", cwd=work)
    run(rcyaml, "schema", "idsl", cwd=work)
    tree = read_tree(work)
    assert {"slice/Speech.ice", "old/slice/Mouth.ice", "etc/config", "bin/SpeechComp"} <= set(tree)
    assert {"src/specificworker.py", "generated/genericworker.py"} <= set(tree)
    run(rcyaml, "compile", "--check", cwd=work)
