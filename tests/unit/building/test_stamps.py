"""Whether a program is up to date."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.building import stamps
from robocomp_yaml.building.inputs import Inputs
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.languages import language

FILES = {
    "arm/CMakeLists.txt": "", "arm/generated/main.cpp": "int main() {}", "arm/generated/parameters.md": "# about",
    "arm/src/worker.cpp": "void f() {}", "arm/src/worker.h": "void f();", "arm/src/notes.txt": "do more",
    "slice/Arm.ice": "module Arm {};", "runtime/cpp/core.cpp": "", "lib/a.cpp": "", "bin/old": "", "arm/bin/ArmComp": "program",
}  # fmt: skip


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Unit:
    """A component whose program is younger than its inputs."""
    monkeypatch.chdir(write_tree(tmp_path, FILES))
    for path in FILES:
        os.utime(path, (1000, 1000))
    os.utime("arm/bin/ArmComp", (2000, 2000))
    return Unit("ArmComp", language("cpp"), "arm/arm.cdsl.yaml", "arm", ".", runtime="runtime/cpp",
                slices=("slice/Arm.ice",), sources=("lib/a.cpp",))  # fmt: skip


def changed(unit: Unit) -> tuple[str, ...]:
    return stamps.inspect(unit, Inputs()).changed


def built(unit: Unit, *more: str) -> None:
    inputs = Inputs()
    stamps.keep(unit, stamps.with_more(unit, stamps.take(unit, inputs, "Debug"), inputs, more))


def write(path: str, text: str = "other") -> None:
    Path(path).write_text(text, encoding="utf-8")


COUNTS = [
    "arm/CMakeLists.txt",
    "arm/generated/main.cpp",
    "arm/src/worker.cpp",
    "slice/Arm.ice",
    "runtime/cpp/core.cpp",
    "lib/a.cpp",
]


@pytest.mark.parametrize("path", COUNTS)
def test_what_changed_since_the_build(arm: Unit, path: str) -> None:
    built(arm)
    assert changed(arm) == ()
    write(path)
    assert changed(arm) == (path,)


@pytest.mark.parametrize("path", COUNTS)
def test_inputs_younger_than_a_program_without_a_stamp(arm: Unit, path: str) -> None:
    assert changed(arm) == ()
    os.utime(path, (3000, 3000))
    assert changed(arm) == (path,)


@pytest.mark.parametrize("path", ["arm/generated/parameters.md", "arm/src/notes.txt"])
def test_other_files_do_not_count(arm: Unit, path: str) -> None:
    built(arm)
    write(path)
    assert changed(arm) == ()


@pytest.mark.parametrize("touch", [lambda path: os.utime(path), lambda path: write(path, FILES[path])])
def test_a_touched_file(arm: Unit, touch: Callable[[str], object]) -> None:
    built(arm)
    touch("arm/src/worker.cpp")
    assert changed(arm) == ()


def test_added_and_removed_files(arm: Unit) -> None:
    built(arm)
    os.unlink("arm/src/worker.h")
    write("arm/src/more.cpp")
    write("arm/src/.more.cpp.swp")
    assert changed(arm) == ("arm/src/more.cpp", "arm/src/worker.h")


def test_inputs_that_only_the_build_knows(arm: Unit) -> None:
    """Such as a header beside the component, which its own CMake file names."""
    built(arm, "bin/old")
    assert changed(arm) == ()
    write("bin/old")
    assert changed(arm) == ("bin/old",)
    os.unlink("bin/old")
    assert changed(arm) == ("bin/old",)


def test_another_program_is_compared_by_time(arm: Unit) -> None:
    """It is not the program of the stamp, which only has the last build type."""
    built(arm)
    write("arm/bin/ArmComp")
    found = stamps.inspect(arm, Inputs())
    assert (found.is_known, found.type, found.changed) == (False, "Debug", ())
    os.utime("arm/bin/ArmComp", (500, 500))
    assert "arm/src/worker.cpp" in changed(arm)


def test_no_program(arm: Unit) -> None:
    built(arm)
    os.unlink("arm/bin/ArmComp")
    assert not stamps.inspect(arm, Inputs()).is_there


@pytest.mark.parametrize("text", ["", "{", "[]", '{"type": 1}'])
def test_a_broken_stamp_is_ignored(arm: Unit, text: str) -> None:
    built(arm)
    write("arm/.rcyaml/builds/stamp.json", text)
    assert stamps.load(arm) is None and changed(arm) == ()


def test_the_stamp_is_not_under_version_control(arm: Unit) -> None:
    built(arm)
    assert Path("arm/.rcyaml/builds/.gitignore").read_text() == "*\n"


def test_a_link_to_another_folder_is_not_followed(arm: Unit, tmp_path: Path) -> None:
    (tmp_path / "away").mkdir()
    Path("arm/.rcyaml").symlink_to(tmp_path / "away")
    inside = Unit("ArmComp", arm.language, arm.document, "arm", ".")
    built(inside)
    assert os.listdir(tmp_path / "away") == []


def test_the_stamp_holds_from_any_folder(arm: Unit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built(arm)
    monkeypatch.chdir("arm")
    here = Unit("ArmComp", arm.language, "arm.cdsl.yaml", ".", "..", runtime="../runtime/cpp", slices=("../slice/Arm.ice",),
                sources=("../lib/a.cpp",))  # fmt: skip
    assert changed(here) == ()
    write("src/worker.cpp")
    assert changed(here) == ("src/worker.cpp",)


def test_a_copy_of_a_workspace_is_as_current_as_the_workspace(arm: Unit, tmp_path: Path) -> None:
    """As `cp -r` makes it: with other times and other inodes, the program first."""
    built(arm)
    for path in FILES:
        os.utime(path, (4000, 4000))
    program = Path(arm.program).read_bytes()
    Path(arm.program).unlink()
    Path(arm.program).write_bytes(program)
    os.utime(arm.program, (3000, 3000))
    assert changed(arm) == ()
    write("arm/src/worker.cpp")
    assert "arm/src/worker.cpp" in changed(arm)


def test_the_same_program_again_from_other_inputs(arm: Unit) -> None:
    """CMake itself built it after a change of a comment."""
    built(arm)
    write("arm/src/worker.cpp", "void f() {} // later")
    os.utime("arm/src/worker.cpp", (1500, 1500))
    os.utime(arm.program, (3000, 3000))
    assert changed(arm) == ()
