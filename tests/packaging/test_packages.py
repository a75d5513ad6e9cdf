"""The wheel and the sdist carry what rcyaml needs, and work where no checkout is near."""

from __future__ import annotations

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from packaging.metadata import Metadata

import robocomp_yaml
from conftest import ROOT, in_long, read_tree, write_tree

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
    assert data_files("robocomp_yaml/_data/") | {"robocomp_yaml/py.typed"} <= names
    of_languages = (
        path.relative_to(ROOT).as_posix() for path in ROOT.glob("robocomp_yaml/languages/*/templates/**/*.*")
    )
    assert {path for path in of_languages if "__pycache__" not in path} <= names
    assert not [name for name in names if name.startswith(("tests/", "docs/", "examples/"))]


def test_the_sdist_has_all_data(built: Path) -> None:
    (sdist,) = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert data_files() <= names
    assert {"pyproject.toml", "README.md", "LICENSE", "Makefile", "tests/conftest.py"} <= names


def test_the_package_index_takes_it_and_its_links_lead_somewhere(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = Metadata.from_email(archive.read(name), validate=True)
    assert str(metadata.version) == robocomp_yaml.__version__
    assert metadata.description_content_type == "text/markdown"
    assert {"Homepage", "Documentation", "Changelog", "Issues"} <= set(metadata.project_urls or {})
    links = re.findall(r"\]\(([^)\s]+)\)", metadata.description or "")
    assert len(links) > 10
    assert [link for link in links if not link.startswith(("https://", "#"))] == []
    assert f"/blob/v{metadata.version}/docs/tutorial/README.md" in (metadata.description or "")
    assert f"https://raw.githubusercontent.com/robocomp/rcyaml/v{metadata.version}/docs/pictures/flow.svg" in links


@pytest.fixture(scope="module")
def bin_(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the commands are of an environment into which the wheel is installed, which `build` made from the sdist."""
    return installed(built, tmp_path_factory.mktemp("installed") / "venv", sys.executable)


def installed(built: Path, environment: Path, python: str) -> Path:
    run(python, "-m", "venv", str(environment))
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


LIBRARY = """\
from robocomp_yaml import api
plan = api.load("robot").compile()
assert not plan.has_errors, plan.diagnostics
print(len(plan.files), "files,", sum(told.severity == api.ERROR for told in api.load("wrong").check()), "error")
"""


def python_of(version: str) -> str | None:
    """A Python of this version that makes environments: the first on the path, or one that pyenv keeps."""
    kept = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv").glob(
        f"versions/{version}.*/bin/python{version}"
    )
    for python in (shutil.which(f"python{version}"), *map(str, sorted(kept))):
        if python and subprocess.run([python, "-c", "import ensurepip, venv"], capture_output=True).returncode == 0:
            return python
    return None


@pytest.mark.parametrize("version", ["3.11", pytest.param("3.12", marks=in_long), "3.13"])
def test_it_works_with_each_python(version: str, built: Path, bin_: Path, tmp_path: Path) -> None:
    if version != f"{sys.version_info[0]}.{sys.version_info[1]}":
        python = python_of(version)
        if python is None:
            pytest.skip(f"there is no python{version} on this machine that makes environments")
        bin_ = installed(built, tmp_path / "venv", python)
    work = write_tree(tmp_path / "work", {"robot": None, "wrong/Arm.idsl.yaml": "module: 3\n", "use.py": LIBRARY})
    rcyaml = str(bin_ / "rcyaml")
    assert run(rcyaml, "--version") == f"rcyaml, version {robocomp_yaml.__version__}\n"
    run(rcyaml, "init", "robot", cwd=work)
    run(rcyaml, "new", "interface", "Arm", cwd=work / "robot")
    run(rcyaml, "new", "component", "ArmComp", "--implements", "Arm", cwd=work / "robot")
    assert "nothing wrong" in run(rcyaml, "check", cwd=work / "robot")
    assert "error" not in run(rcyaml, "compile", cwd=work / "robot")
    assert "Arm" in " ".join(read_tree(work / "robot"))
    said = run(str(bin_ / "python"), "use.py", cwd=work)
    assert re.fullmatch(r"[1-9]\d* files, 1 error\n", said)


def test_another_build_of_the_same_version_compiles_again(built: Path, bin_: Path, tmp_path: Path) -> None:
    work = write_tree(tmp_path / "work", {"Speech.idsl.yaml": "module: RoboCompSpeech\n", "speech.cdsl.yaml": SPEECH})
    compile_ = (str(bin_ / "rcyaml"), "compile")
    run(*compile_, cwd=work)
    assert "0 files written" in run(*compile_, cwd=work)
    (wheel,) = built.glob("*.whl")
    other = rebuilt(
        wheel, tmp_path, "robocomp_yaml/languages/python/templates/runtime/log.py", b"Do not edit", b"DO NOT EDIT"
    )
    install(bin_, other, "--force-reinstall", "--no-deps")
    assert "3 files written" in run(*compile_, cwd=work), "the file, and two that know the version of all"
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
