"""The wheel and the sdist carry what rcyaml needs, and work where no checkout is near."""

from __future__ import annotations

import base64
import hashlib
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from conftest import ROOT, read_tree, write_tree

pytestmark = pytest.mark.slow

DATA = {"schemas": "schemas", "templates": "templates", "migrate": "migrate", "docs/diagnostics": "diagnostics"}
"""Folders of the checkout, and what they are called inside of the package."""
SPEECH = "component: SpeechComp\nlanguage: python\nimports: [Speech]\n"
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


def data_files(inside: str = "") -> set[str]:
    return {
        f"{f'{inside}{called}' if inside else name}/{path.relative_to(ROOT / name).as_posix()}"
        for name, called in DATA.items()
        for path in (ROOT / name).rglob("*")
        if path.is_file() and path.suffix not in (".pyc", ".swp") and "__pycache__" not in path.parts
    }


def test_the_wheel_has_all_data(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    assert data_files("robocomp_yaml/_data/") <= names
    of_languages = (path.relative_to(ROOT).as_posix() for path in ROOT.glob("robocomp_yaml/languages/*/templates/**/*.*"))
    assert {path for path in of_languages if "__pycache__" not in path} <= names
    assert not [name for name in names if name.startswith(("tests/", "docs/", "examples/"))]


def test_the_sdist_has_all_data(built: Path) -> None:
    (sdist,) = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert data_files() <= names
    assert {"pyproject.toml", "README.md", "LICENSE", "Makefile", "tests/conftest.py"} <= names


@pytest.fixture(scope="module")
def bin_(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the commands are of an environment into which the wheel is installed, which `build` made from the sdist."""
    environment = tmp_path_factory.mktemp("installed") / "venv"
    run(sys.executable, "-m", "venv", str(environment))
    (wheel,) = built.glob("*.whl")
    install(environment / "bin", wheel)
    return environment / "bin"


def install(bin_: Path, wheel: Path, *options: str) -> None:
    run(str(bin_ / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *options, str(wheel))


def test_it_works_outside_the_checkout(bin_: Path, tmp_path: Path) -> None:
    work = write_tree(tmp_path / "work", COMPONENT)
    rcyaml = str(bin_ / "rcyaml")
    run(rcyaml, "migrate", "old", cwd=work)
    run(rcyaml, "check", cwd=work)
    run(rcyaml, "compile", cwd=work)
    run(rcyaml, "schema", "idsl", cwd=work)
    assert "Wrong:" in run(rcyaml, "explain", "RC2003", cwd=work)
    tree = read_tree(work)
    assert {"slice/Speech.ice", "old/slice/Mouth.ice", "etc/config", "bin/SpeechComp"} <= set(tree)
    assert {"src/specificworker.py", "generated/genericworker.py"} <= set(tree)
    run(rcyaml, "compile", "--check", cwd=work)


def test_another_build_of_the_same_version_compiles_again(built: Path, bin_: Path, tmp_path: Path) -> None:
    work = write_tree(tmp_path / "work", {"Speech.idsl.yaml": "module: RoboCompSpeech\n", "speech.cdsl.yaml": SPEECH})
    compile_ = (str(bin_ / "rcyaml"), "compile")
    run(*compile_, cwd=work)
    assert "0 files written" in run(*compile_, cwd=work)
    (wheel,) = built.glob("*.whl")
    other = rebuilt(wheel, tmp_path, "robocomp_yaml/languages/python/templates/runtime/log.py", b"Do not edit", b"DO NOT EDIT")
    install(bin_, other, "--force-reinstall", "--no-deps")
    assert "1 file written" in run(*compile_, cwd=work)
    assert "DO NOT EDIT" in (work / "generated/runtime/log.py").read_text(encoding="utf-8")
    assert "0 files written" in run(*compile_, cwd=work)


def rebuilt(wheel: Path, folder: Path, file: str, before: bytes, after: bytes) -> Path:
    """A wheel of the same name in another folder, with one file of the package changed."""
    with zipfile.ZipFile(wheel) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    old, new = content[file], content[file].replace(before, after)
    assert old != new
    (record,) = (name for name in content if name.endswith(".dist-info/RECORD"))
    content |= {file: new, record: content[record].replace(recorded(old), recorded(new))}
    with zipfile.ZipFile(folder / wheel.name, "w") as archive:
        for name, data in content.items():
            archive.writestr(name, data)
    return folder / wheel.name


def recorded(data: bytes) -> bytes:
    """As RECORD names the contents of a file."""
    return b"sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=")
