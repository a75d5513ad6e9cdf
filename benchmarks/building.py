"""Builds: nothing to do for many components, and the time for each further C++ component, compared with a bare Ice
server.

    python benchmarks/building.py [RUNS]

CPU seconds, user and system, of all processes. The bare server is the output of slice2cpp for the same Slice, with a
main program of a few lines, built with CMake and Ninja. It is built after each step, and the result is the ratio of
both. The run time's libraries are cached in a separate folder, so that the first component compiles them; ccache is not
used.
"""

from __future__ import annotations

import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from run import RCYAML, measure

MANY = 40
INTERFACE = "module: RoboComp{0}\ninterfaces: {{{0}: {{methods: {{move: {{in: {{by: float}}, returns: bool}}{1}}}}}}}\n"
MORE = ", stop: {in: {hard: bool}}"
BARE = """\
#include <{0}.h>
#include <Ice/Ice.h>

struct Served : RoboComp{0}::{0}
{{
    bool move(float, const Ice::Current&) override {{ return true; }}
    {1}
}};

int main(int argc, char* argv[])
{{
    Ice::CommunicatorHolder ice(argc, argv);
    auto adapter = ice->createObjectAdapterWithEndpoints("{0}", "tcp");
    adapter->add(std::make_shared<Served>(), Ice::stringToIdentity("{0}"));
    adapter->activate();
    ice->waitForShutdown();
}}
"""
LISTS = """\
cmake_minimum_required(VERSION 3.20)
project(bare LANGUAGES CXX)
set(CMAKE_BUILD_TYPE Release)
set(CMAKE_CXX_STANDARD 17)
find_package(Ice 3.7 REQUIRED COMPONENTS Ice++11)
add_custom_command(OUTPUT {0}.cpp COMMAND ${{Ice_SLICE2CPP_EXECUTABLE}} ${{CMAKE_CURRENT_SOURCE_DIR}}/{0}.ice
                   DEPENDS {0}.ice)
add_executable(bare main.cpp ${{CMAKE_CURRENT_BINARY_DIR}}/{0}.cpp)
target_include_directories(bare PRIVATE ${{CMAKE_CURRENT_BINARY_DIR}})
target_compile_definitions(bare PRIVATE ICE_CPP11_MAPPING)
target_link_libraries(bare PRIVATE Ice::Ice++11)
"""


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def rcyaml(folder: Path, *args: str) -> None:
    subprocess.run([*RCYAML, *args], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def cpu(work: Callable[[], object]) -> float:
    def used() -> float:
        found = resource.getrusage(resource.RUSAGE_CHILDREN)
        return found.ru_utime + found.ru_stime

    before = used()
    work()
    return used() - before


def bare(folder: Path, name: str, slice_: Path, more: str = "") -> Callable[[], None]:
    write(folder / f"{name}.ice", slice_.read_text(encoding="utf-8"))
    write(folder / "main.cpp", BARE.format(name, more))
    write(folder / "CMakeLists.txt", LISTS.format(name))

    def build() -> None:
        for command in (["cmake", "-G", "Ninja", "-S", ".", "-B", "build"], ["ninja", "-C", "build"]):
            subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)

    return build


def component(folder: Path, name: str, requires: str = "") -> None:
    write(folder / f"{name}.idsl.yaml", INTERFACE.format(name, ""))
    needs = f"requires: [{requires}]\n" if requires else ""
    imports = f"{name}, {requires}" if requires else name
    write(
        folder / name.lower() / f"{name.lower()}.cdsl.yaml",
        f"component: {name}Comp\nlanguage: cpp\nimports: [{imports}]\nimplements: [{name}]\n{needs}",
    )


def pair(what: str, work: Callable[[], object], beside: Callable[[], object], goal: str) -> None:
    taken, floor = cpu(work), cpu(beside)
    print(f"{what:<52} {taken:6.1f} s  bare {floor:5.1f} s  {taken / floor:5.2f} times, goal {goal}", flush=True)


def steps(work: Path) -> None:
    robot, previous = work / "robot", ""
    write(robot / "rcyaml.yaml", "interfaces: [.]\n")
    for name, what, goal in (
        ("Base", "the first component ever on a machine", "3.5"), ("Mouth", "a second one, with an interface", "1.3"),
        ("Arm", "a third one, with an interface and a proxy", "1.3"),
    ):  # fmt: skip
        component(robot, name, previous)
        rcyaml(robot, "compile")
        beside = bare(work / "bare" / name, name, robot / "slice" / f"{name}.ice")
        pair(what, lambda: rcyaml(robot, "build"), beside, goal)
        previous = name
    write(robot / "Base.idsl.yaml", INTERFACE.format("Base", MORE))
    subprocess.run([*RCYAML, "compile", "--merge"], cwd=robot, check=True, stdout=subprocess.DEVNULL)
    stop = "void stop(bool, const Ice::Current&) override {}"
    again = bare(work / "bare" / "Base", "Base", robot / "slice" / "Base.ice", stop)
    pair("after a new method: the component that serves it", lambda: rcyaml(robot, "build", "BaseComp"), again, "1.3")
    rcyaml(robot, "build")
    code, main = robot / "arm/src/specificworker.cpp", work / "bare/Arm/main.cpp"
    write(code, f"{code.read_text()}// more\n")
    write(main, f"{main.read_text()}// more\n")
    change = bare(work / "bare" / "Arm", "Arm", robot / "slice" / "Arm.ice")
    pair("after a change in src/", lambda: rcyaml(robot, "build"), change, "the file and the link")
    shutil.copytree(robot, work / "other", ignore=shutil.ignore_patterns("build", "bin", "builds"))
    first = work / "bare" / "other"
    pair(
        "the first one of a further workspace", lambda: rcyaml(work / "other", "build", "BaseComp"),
        bare(first, "Base", robot / "slice" / "Base.ice", stop), "1.5",
    )  # fmt: skip


def nothing_to_do(work: Path, runs: int) -> None:
    """The programs are not built: a stamp holds for any file at the program's path."""
    from robocomp_yaml import api
    from robocomp_yaml.api.building import units
    from robocomp_yaml.building import stamps
    from robocomp_yaml.building.inputs import Inputs

    write(work / "rcyaml.yaml", "interfaces: [.]\n")
    for number in range(MANY):
        component(work, f"C{number}", f"C{number - 1}" if number else "")
    rcyaml(work, "compile")
    os.chdir(work)
    inputs = Inputs()
    for unit in units(api.load(".").analysis):
        write(Path(unit.program), "program")
        stamps.keep(unit, stamps.take(unit, inputs, "Release"))
    taken = [measure([*RCYAML, "build"]).cpu for _ in range(runs)]
    middle = statistics.median(taken)
    print(f"{f'nothing to do, {MANY} components':<52} {middle:6.2f} s ({min(taken):.2f}–{max(taken):.2f}), goal 0.5 s")


def main(runs: int) -> None:
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["CCACHE_DISABLE"] = "1"
    with tempfile.TemporaryDirectory() as name:
        work = Path(name).resolve()
        os.environ["RCYAML_CACHE"] = str(work / "cache")
        nothing_to_do(work / "many", runs)
        if all(map(shutil.which, ("cmake", "ninja", "g++", "slice2cpp"))):
            steps(work)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
