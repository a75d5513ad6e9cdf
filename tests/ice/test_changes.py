"""A component with code of its user, and each change that its documents can see: it builds and runs afterwards with
`src/` as it was, and with what `--merge` makes of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from click.testing import Result
from cpp_programs import cmake, needs_cpp
from processes import Storm
from scenario import INTERFACES

from conftest import read_tree, write_tree

Run = Callable[..., Result]
Keys = Mapping[str, object]

BASE: Keys = {"component": "Robot", "imports": ["Types", "Arm"], "implements": ["Arm"]}
ARM = INTERFACES["Arm.idsl.yaml"]
PDSL = "component: robot.cdsl.yaml\nparameters:\n  speed: {type: int, default: 3, range: [1, 9]}\n"
MACHINE = {
    "initial": "idle", "final": "end", "states": {"work": {}}, "transitions": {"idle": "work", "work": ["end"]}
}  # fmt: skip
HAND = {"Hand": {"interface": "Hand", "absent": "ignore"}}


@dataclass(frozen=True)
class Change:
    """`less` is the component without it, and `more` with it: each way is a change of its own. `files` are documents
    that are then otherwise. `cpp` and `python` name the languages that have it."""

    name: str
    more: Keys = field(default_factory=dict)
    less: Keys = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    languages: tuple[str, ...] = ("python", "cpp")


# A change of the language that comes later is a row more.
CHANGES = [
    Change("a proxy", {"requires": [HAND]}),
    Change("an implemented interface", {"implements": ["Arm", "Hand"]}),
    Change("all of a module", less={"implements": [], "imports": ["Types"]}),
    Change("a published topic", {"publishes": ["ArmEvents"]}),
    Change("a subscribed topic", {"subscribes": ["ArmEvents"]}),
    Change("a method", files={"Arm.idsl.yaml": ARM.replace("      betray:", "      wave: {in: {n: int}}\n      betray:")}),
    Change("another name of a method", files={"Arm.idsl.yaml": ARM.replace("      betray:", "      deceive:")}),
    Change("a parameter", {"parameters": "robot.pdsl.yaml"}, files={"robot.pdsl.yaml": PDSL}),
    Change("a state machine", {"statemachine": MACHINE}),
    Change("a library", {"uses": {"libraries": [{"link": "m"}, {"pip": "click"}]}}, languages=("cpp",)),
    Change("a package", {"uses": {"libraries": [{"pip": "click"}]}}, languages=("python",)),
    Change("a period and words", {"period": "30 ms", "doc": "A robot."}),
    Change("a later standard", {"language": {"name": "cpp", "standard": 20}}, languages=("cpp",)),
]
BUILT_ALWAYS = ("an implemented interface", "a method", "a parameter")
CASES = [(change, language, way) for change in CHANGES for language in change.languages for way in ("more", "less")]


def name(case: object) -> str:
    return case.name.replace(" ", "-") if isinstance(case, Change) else str(case)


@pytest.mark.slow
@pytest.mark.parametrize(("change", "language", "way"), CASES, ids=name)
def test_it_builds_and_runs_after_a_change(
    change: Change, language: str, way: str, rcyaml: Run, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    if language == "cpp" and change.name not in BUILT_ALWAYS and "RCYAML_ALL_BUILDS" not in os.environ:
        pytest.skip("each case is a build of half a minute: RCYAML_ALL_BUILDS=1 runs them all")
    if language == "cpp":
        needed = needs_cpp.args[0]
        if needed:
            pytest.skip(needs_cpp.kwargs["reason"])
    has_topics = "topic" in change.name
    storm: Storm | None = request.getfixturevalue("icestorm") if has_topics else request.getfixturevalue("ice") and None
    stages = [(change.less, {}), (change.more, change.files)]
    (keys, files), (later_keys, later_files) = stages if way == "more" else reversed(stages)
    write_tree(tmp_path, documents(language, keys, files))
    assert rcyaml("compile").exit_code == 0
    yours = written(tmp_path)

    write_tree(tmp_path, documents(language, later_keys, later_files))
    result = rcyaml("compile")
    assert result.exit_code == 0, result.stdout
    assert read_tree(tmp_path / "src") == yours
    assert_runs(tmp_path, language, storm)

    result = rcyaml("compile", "--merge")
    assert result.exit_code == 0, result.stdout
    merged = read_tree(tmp_path / "src")
    for path, text in yours.items():
        assert [line for line in text.splitlines() if "mine" in line] == [
            line for line in merged[path].splitlines() if "mine" in line
        ]
    told = json.loads(rcyaml("compile", "--format", "json").stdout)["diagnostics"]
    assert {d["code"] for d in told} <= {"RC6203"}, "nothing is lacking any more"
    if code(merged) != code(yours):
        assert_runs(tmp_path, language, storm)


def code(files: Mapping[str, str]) -> list[str]:
    """Without comments and blank lines, for which no compiler need run."""
    lines = [line.strip() for text in files.values() for line in text.splitlines()]
    return [line for line in lines if line and not line.startswith(("//", "#   ", '"""'))]


def documents(language: str, keys: Keys, files: Mapping[str, str]) -> dict[str, str]:
    component = json.dumps({"language": language, **BASE, **keys})
    return {**INTERFACES, **files, "robot.cdsl.yaml": component}


def written(root: Path) -> dict[str, str]:
    """What a user made of the skeleton."""
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
    return read_tree(root / "src")


def assert_runs(root: Path, language: str, storm: Storm | None) -> None:
    """Builds it, starts all of it once, and stops it."""
    if language == "cpp":
        cmake(root, "-DCMAKE_BUILD_TYPE=Plain", jobs=1)
    config = root / "test.config"
    endpoints = {f"{name}.Endpoints": "tcp -h 127.0.0.1 -p 0" for name in ("Arm", "Hand", "ArmEventsTopic")}
    proxies = {"HandProxy": "hand:tcp -h 127.0.0.1 -p 1", "TopicManager.Proxy": storm.manager if storm else ""}
    config.write_text("".join(f"{key}={value}\n" for key, value in {**endpoints, **proxies}.items()))
    program = root / "bin" / "Robot"
    command = [sys.executable, program] if language == "python" else [program]
    done = subprocess.run([*command, config, "--startup-check"], capture_output=True, text=True, timeout=30)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "mine: hello" in said and "Traceback" not in said
