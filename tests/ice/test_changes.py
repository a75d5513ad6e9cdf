"""A component with code of its user, and each change that its documents can see, there and back: it builds and runs
afterwards with `src/` as it was, and with what `--merge` makes of it."""

from __future__ import annotations

import filecmp
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree
from cpp_programs import FAST, cmake, needs_cpp, needs_qt
from processes import Storm
from scenario import INTERFACES

Run = Callable[..., Result]
Keys = Mapping[str, object]

BASE: Keys = {"component": "Robot", "imports": ["Types", "Arm"], "implements": ["Arm"]}
ARM, BETRAY = INTERFACES["Arm.idsl.yaml"], "      betray:"
PDSL = "component: robot.cdsl.yaml\nparameters:\n  speed: {type: int, default: 3, range: [1, 9]}\n"
MACHINE = {
    "initial": "idle", "final": "end", "states": {"work": {}}, "transitions": {"idle": "work", "work": ["end"]}
}  # fmt: skip
HAND = {"Hand": {"interface": "Hand", "absent": "ignore"}}
QT = {"toolkit": "qt", "base": "QWidget"}


@dataclass(frozen=True)
class Change:
    """`keys` are what the component's document has then, and `files` are documents that are then otherwise. Of C++'s,
    one of each kind `is_built` in every run of the tests."""

    name: str
    keys: Keys = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    languages: tuple[str, ...] = ("python", "cpp")
    is_built: bool = False


CHANGES = [
    Change("a proxy", {"requires": [HAND]}),
    Change("an implemented interface", {"implements": ["Arm", "Hand"]}, is_built=True),
    Change("all of a module", {"implements": [], "imports": ["Types"]}),
    Change("a published topic", {"publishes": ["ArmEvents"]}),
    Change("a subscribed topic", {"subscribes": ["ArmEvents"]}, is_built=True),
    Change("a method", files={"Arm.idsl.yaml": ARM.replace(BETRAY, f"      wave: {{in: {{n: int}}}}\n{BETRAY}")},
           is_built=True),
    Change("another name of a method", files={"Arm.idsl.yaml": ARM.replace(BETRAY, "      deceive:")}),
    Change("a parameter", {"parameters": "robot.pdsl.yaml"}, {"robot.pdsl.yaml": PDSL}, is_built=True),
    Change("a state machine", {"statemachine": MACHINE}),
    Change("a window", {"gui": QT}),
    Change("a window and a state machine", {"gui": QT, "statemachine": MACHINE}),
    Change("a library", {"uses": {"libraries": [{"link": "m"}, {"pip": "click"}]}}, languages=("cpp",)),
    Change("a package", {"uses": {"libraries": [{"pip": "click"}]}}, languages=("python",)),
    Change("a period and words", {"period": "30 ms", "doc": "A robot."}),
    Change("a later standard", {"language": {"name": "cpp", "standard": 20}}, languages=("cpp",)),
]  # fmt: skip
CASES = [(change, language) for change in CHANGES for language in change.languages]


def name(case: object) -> str:
    return case.name.replace(" ", "-") if isinstance(case, Change) else str(case)


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The component in C++: one folder for all changes, so that a build compiles only what has changed."""
    return tmp_path_factory.mktemp("changes") / "robot"


@pytest.mark.slow
@pytest.mark.parametrize(("change", "language"), CASES, ids=name)
def test_it_builds_and_runs_after_a_change_and_back(
    change: Change, language: str, shared: Path, rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:  # fmt: skip
    skip_if_absent(change, language)
    request.getfixturevalue("ice")
    storm: Storm | None = request.getfixturevalue("icestorm") if "topic" in change.name else None
    root = tmp_path / "robot" if language == "python" else shared
    root.mkdir(exist_ok=True)
    monkeypatch.chdir(root)
    begin(root, language, rcyaml)

    for keys, files in ((change.keys, change.files), ({}, {})):
        yours = read_tree(root / "src")
        write_tree(root, documents(language, keys, files))
        result = rcyaml("compile")
        assert result.exit_code == 0, result.stdout
        assert yours.items() <= read_tree(root / "src").items()
        assert_runs(root, language, storm)

        result = rcyaml("compile", "--merge")
        assert result.exit_code == 0, result.stdout
        merged = read_tree(root / "src")
        for path, text in yours.items():
            assert [line for line in text.splitlines() if "mine" in line] == [
                line for line in merged[path].splitlines() if "mine" in line
            ]
        told = json.loads(rcyaml("compile", "--format", "json").stdout)["diagnostics"]
        assert {d["code"] for d in told} <= {"RC6203", "RC6312"}, "nothing is lacking any more"
        if code(merged) != code(yours):
            assert_runs(root, language, storm)


def skip_if_absent(change: Change, language: str) -> None:
    if language == "cpp" and needs_cpp.args[0]:
        pytest.skip(needs_cpp.kwargs["reason"])
    if language == "cpp" and not change.is_built and "RCYAML_ALL_BUILDS" not in os.environ:
        pytest.skip("one change of each kind is built in C++: RCYAML_ALL_BUILDS=1 builds them all")
    if "window" in change.name and language == "python":
        pytest.importorskip("PySide6", reason="PySide6 is not installed (PySide6-Essentials<6.11)")
    if "window" in change.name and language == "cpp" and needs_qt.args[0]:
        pytest.skip(needs_qt.kwargs["reason"])


def begin(root: Path, language: str, rcyaml: Run) -> None:
    """The component as its user left it, whatever other changes have done since."""
    pristine = root.with_name("pristine")
    if not pristine.is_dir():
        write_tree(root, documents(language, {}, {}))
        assert rcyaml("compile").exit_code == 0
        write_as_a_user(root)
        shutil.copytree(root, pristine)
        return
    for path in own(root) - own(pristine):
        (root / path).unlink()
    for path in own(pristine):
        if not (root / path).is_file() or not filecmp.cmp(root / path, pristine / path, shallow=False):
            shutil.copyfile(pristine / path, root / path)  # its time is now: it is to be compiled


def own(root: Path) -> set[Path]:
    """The component's files, without what CMake has made."""
    paths = (path.relative_to(root) for path in root.rglob("*") if path.is_file())
    return {path for path in paths if path.parts[0] not in ("build", "bin")}


def code(files: Mapping[str, str]) -> list[str]:
    """Without comments and blank lines, for which no compiler need run."""
    lines = [line.strip() for text in files.values() for line in text.splitlines()]
    return [line for line in lines if line and not line.startswith(("//", "#   ", '"""'))]


def documents(language: str, keys: Keys, files: Mapping[str, str]) -> dict[str, str]:
    component = json.dumps({"language": language, **BASE, **keys})
    return {**INTERFACES, **files, "robot.cdsl.yaml": component}


def write_as_a_user(root: Path) -> None:
    """What a user makes of the skeleton."""
    for path in (root / "src").iterdir():
        text = path.read_text()
        text = text.replace('log.info("initializing")', 'log.info("mine: hello")')
        text = text.replace('log.info("Arm_block() is still', 'log.info("mine: Arm_block() is still')
        if path.suffix == ".py":
            text += "\n    def mine(self) -> int:\n        return 1\n"
        elif path.suffix == ".h":
            text = text.replace("\n};", "\n\n    int mine = 1;\n};")
        else:
            text += "\nstatic_assert(sizeof(SpecificWorker) > 0); // mine\n"
        path.write_text(text)


def assert_runs(root: Path, language: str, storm: Storm | None) -> None:
    """Builds it, starts all of it once, and stops it."""
    if language == "cpp":
        ninja = ["-GNinja"] if shutil.which("ninja") else []  # here; other builds are make's
        cmake(root, *ninja, *FAST)
    config = root / "test.config"
    endpoints = {f"{name}.Endpoints": "tcp -h 127.0.0.1 -p 0" for name in ("Arm", "Hand", "ArmEventsTopic")}
    proxies = {"HandProxy": "hand:tcp -h 127.0.0.1 -p 1", "TopicManager.Proxy": storm.manager if storm else ""}
    config.write_text("".join(f"{key}={value}\n" for key, value in {**endpoints, **proxies}.items()))
    program = root / "bin" / "Robot"
    command = [sys.executable, program] if language == "python" else [program]
    done = subprocess.run(
        [*command, config, "--startup-check"], capture_output=True, text=True, timeout=30,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen"},
    )  # fmt: skip
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "mine: hello" in said and "Traceback" not in said
