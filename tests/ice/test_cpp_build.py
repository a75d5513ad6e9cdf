"""Building C++ components: on the command line, repeatedly, and with missing tools."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from components import build
from conftest import ROOT, write_tree
from cpp_programs import cmake, in_all_builds, needs_cpp
from mouth import MOUTH
from processes import Start
from scenario import INTERFACES, cdsl

pytestmark = [pytest.mark.slow, needs_cpp]
SYNTAX = ["g++", "-DICE_CPP11_MAPPING", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-Igenerated", "-Isrc"]
SLICE = ["slice2cpp", "--header-ext", "ice.h", "--source-ext", "ice.cpp"]


def slices(root: Path) -> list[str]:
    """Compiles the component's Slice; returns the option for its headers."""
    (root / "build").mkdir(exist_ok=True)
    names = sorted(str(file) for folder in ("slice", "generated/slice") for file in (root / folder).glob("*.ice"))
    subprocess.run([*SLICE, f"-I{root / 'slice'}", "--output-dir", "build", *names], cwd=root, check=True)
    return ["-isystem", "build"]


def test_from_the_command_line_on(rcyaml: Callable[..., Result], tmp_path: Path, start: Start) -> None:
    """Compiles, builds and runs a component; a second build does nothing; a new source is built."""
    root = tmp_path / "a component"
    documents = {**INTERFACES, "a component/x.cdsl.yaml": cdsl("Fresh", "cpp", implements=["Hand"], requires=["Arm"])}
    write_tree(tmp_path, documents)
    assert rcyaml("compile", "a component", "-I", ".").exit_code == 0
    cmake(root, "-DCMAKE_BUILD_TYPE=Plain")
    running = start([root / "bin" / "Fresh"]).wait_for("waiting for Arm at arm:")
    assert running.stop() == 0

    again = subprocess.run(["cmake", "--build", "build"], cwd=root, capture_output=True, text=True, check=True)
    assert "Building" not in again.stdout and "Compiling" not in again.stdout
    (root / "src" / "more.cpp").write_text("int more = 1;\n")
    more = subprocess.run(["cmake", "--build", "build"], cwd=root, capture_output=True, text=True, check=True)
    assert more.stdout.count("Building CXX") == 1 and "more.cpp" in more.stdout

    assert rcyaml("compile", "a component", "-I", ".", "--check").exit_code == 0, (
        "what is built is no concern of rcyaml"
    )


def test_ice_is_missing(tmp_path: Path) -> None:
    root = build({"x.cdsl.yaml": "component: Lonely\nlanguage: cpp\n"}, tmp_path)["Lonely"].root
    command = ["cmake", "-S", str(root), "-B", str(root / "build"), "-DCMAKE_DISABLE_FIND_PACKAGE_Ice=ON"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode != 0
    assert "Lonely needs Ice 3.7 for C++, which is not installed." in done.stderr
    assert "sudo apt install libzeroc-ice-dev zeroc-ice-compilers" in done.stderr


def test_a_missing_method_of_the_user(tmp_path: Path) -> None:
    """The interface has gained or lost a method: the user's class compiles all the same."""
    root = build({**INTERFACES, "x/x.cdsl.yaml": cdsl("X", "cpp", implements=["Hand"])}, tmp_path)["X"].root
    header = root / "src" / "specificworker.h"
    header.write_text(header.read_text().replace("Hand_grasp(", "Hand_gripped("))
    (root / "all.cpp").write_text('#include "generated/main.cpp"\n#include "generated/genericworker.cpp"\n')
    done = subprocess.run([*SYNTAX, *slices(root), "all.cpp"], cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_code_for_another_run_time(tmp_path: Path) -> None:
    """The compiler refuses it, whatever builds it."""
    root = build({"x.cdsl.yaml": "component: X\nlanguage: cpp\n"}, tmp_path)["X"].root
    main = root / "generated" / "main.cpp"
    command = [*SYNTAX, *slices(root), "generated/main.cpp"]
    assert subprocess.run(command, cwd=root, capture_output=True, text=True).stderr == ""
    main.write_text(re.sub('isVersion\\("[^"]*"', 'isVersion("another"', main.read_text()))
    done = subprocess.run(command, cwd=root, capture_output=True, text=True)
    assert done.returncode != 0
    assert "this was generated for another run time than the one that it is built with: rcyaml compile" in done.stderr


def test_a_method_that_no_longer_fits(tmp_path: Path) -> None:
    """The compiler names the hidden one."""
    root = build({**INTERFACES, "x/x.cdsl.yaml": cdsl("X", "cpp", implements=["Hand"])}, tmp_path)["X"].root
    header = root / "src" / "specificworker.h"
    header.write_text(header.read_text().replace("Hand_grasp(", "Hand_grasp(int, "))
    command = [*SYNTAX, "-Woverloaded-virtual", *slices(root), "generated/main.cpp"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True)
    assert "Hand_grasp(const RoboCompTypes::Image&)" in done.stderr and "was hidden" in done.stderr


# The components of all other tests are built with C++17.
@pytest.mark.parametrize("standard", [pytest.param(17, marks=in_all_builds), 20])
def test_the_golden_component(tmp_path: Path, standard: int) -> None:
    """The run time is built with the standard of the component too."""
    golden = ROOT / "tests" / "golden" / "cpp" / "mouth"
    root = build(MOUTH, tmp_path)["MouthComp"].root
    for name in ("generated/genericworker.cpp", "src/specificworker.cpp"):
        assert (root / name).read_text() == (golden / name).read_text()
    sources = [*sorted((root / "generated").rglob("*.cpp")), root / "src" / "specificworker.cpp"]
    (root / "all.cpp").write_text("".join(f'#include "{source.relative_to(root)}"\n' for source in sources))
    command = [*SYNTAX, f"-std=c++{standard}", *slices(root), "all.cpp"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:3000]
