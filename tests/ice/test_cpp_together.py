"""`rcyaml build` with C++ components: one tree, one run, and what is known of their programs afterwards."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from cpp_programs import in_all_builds, needs_cpp

pytestmark = [pytest.mark.slow, needs_cpp]
Rcyaml = Callable[..., Result]

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {lift: {in: {by: float}}}}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: cpp\nimports: [Arm]\nimplements: [Arm]\n",
    "leg/leg.cdsl.yaml": "component: LegComp\nlanguage: cpp\nimports: [Arm]\nrequires: [Arm]\n",
    "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  arm: {component: arm}\n  leg: {component: leg}\n",
}
LIDAR = {"lidar/lidar.cdsl.yaml": "component: LidarComp\nlanguage: cpp\n"}
SMALL = {"rcyaml.yaml": ""} | {
    f"{name}/{name}.cdsl.yaml": f"component: {name.title()}Comp\nlanguage: cpp\n" for name in ("one", "two", "top")
}


def states(result: Result) -> dict[str, str]:
    return {one["name"]: one["state"] for one in json.loads(result.stdout)["components"]}


def build(rcyaml: Rcyaml, *args: str) -> dict[str, str]:
    return states(rcyaml("build", "--format", "json", *args))


def append(path: Path, text: str) -> Callable[[], object]:
    before = path.read_text()
    path.write_text(before + text)
    return lambda: path.write_text(before)


def test_a_workspace(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, DOCUMENTS)
    arm, leg = tmp_path / "arm", tmp_path / "leg"
    assert rcyaml("compile").exit_code == 0

    # Ctrl-C ends compilers too; the next build continues from there.
    command = [Path(sys.executable).with_name("rcyaml"), "build"]
    begun = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 120
    while not (tmp_path / "build" / "Release" / ".ninja_log").is_file() and time.monotonic() < until:
        time.sleep(0.05)
    begun.send_signal(signal.SIGINT)
    out, err = begun.communicate(timeout=60)
    assert begun.returncode == 130 and "Traceback" not in err, out + err
    assert "interrupted" in err
    assert not _compilers(tmp_path)
    assert build(rcyaml) == {"ArmComp": "built", "LegComp": "built"}
    assert build(rcyaml) == {"ArmComp": "up to date", "LegComp": "up to date"}
    assert rcyaml("deploy", "plan").exit_code == 0

    # Editors know how each file is compiled; the user's repository ignores these files.
    commands = json.loads((tmp_path / "compile_commands.json").read_text())
    assert {str(arm / "src" / "specificworker.cpp"), str(leg / "src" / "specificworker.cpp")} <= {
        one["file"] for one in commands
    }
    assert (tmp_path / "build" / "Release" / ".gitignore").read_text() == "*\n"

    # Shared code is compiled once; an error in one component does not prevent others from being built.
    objects = [path.name for path in (tmp_path / "build").rglob("Arm.ice.cpp.o")]
    assert objects == ["Arm.ice.cpp.o"]
    mend = append(arm / "src" / "specificworker.cpp", "int lifted()\n{\n    return opne();\n}\n")
    append(leg / "src" / "specificworker.cpp", "// more\n")
    told = rcyaml("build")
    assert told.exit_code == 1
    assert "rejects this: ‘opne’ was not declared" in told.stdout
    line = (arm / "src" / "specificworker.cpp").read_text().splitlines().index("    return opne();") + 1
    assert f"arm/src/specificworker.cpp:{line}:12" in told.stdout and "    return opne();\n" in told.stdout
    assert "built       leg/bin/LegComp" in told.stdout and "failed      ArmComp" in told.stdout
    plan = rcyaml("deploy", "plan")
    assert plan.exit_code == 1
    assert "the program of 'arm' is older than its sources: arm/src/specificworker.cpp" in plan.stderr
    mend()
    assert rcyaml("deploy", "plan").exit_code == 0, "changed back is not changed"
    assert build(rcyaml) == {"ArmComp": "up to date", "LegComp": "up to date"}

    # Undefined symbols of the linker are reported where the code uses them.
    mend = append(arm / "src" / "specificworker.cpp", "int nowhere();\nint somewhere() { return nowhere(); }\n")
    told = rcyaml("build", "arm")
    line = (arm / "src" / "specificworker.cpp").read_text().splitlines().index("int somewhere() { return nowhere(); }")
    assert "the linker rejects this: undefined reference to 'nowhere()'" in told.stdout
    assert f"arm/src/specificworker.cpp:{line + 1}:26" in told.stdout
    assert (arm / "bin" / "ArmComp").is_file(), "the earlier one"
    mend()
    assert rcyaml("deploy", "plan").exit_code == 0

    # A header beside the component, which only its own CMake file adds.
    write_tree(tmp_path, {"common/longest.h": "constexpr int limit = 3;\n"})
    append(
        leg / "CMakeLists.txt", 'target_include_directories(LegComp PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/../common")\n'
    )
    append(leg / "src" / "specificworker.cpp", '#include "longest.h"\nint most() { return limit; }\n')
    assert build(rcyaml, "leg") == {"LegComp": "built"}
    (tmp_path / "common" / "longest.h").write_text("constexpr int limit = 4;\n")
    assert "the program of 'leg' is older than its sources: common/longest.h" in rcyaml("deploy", "plan").stderr
    assert build(rcyaml, "leg") == {"LegComp": "built"}
    assert rcyaml("deploy", "plan").exit_code == 0

    # A new method: compile reports it, the deployment fails, and up builds.
    (tmp_path / "Arm.idsl.yaml").write_text(DOCUMENTS["Arm.idsl.yaml"].replace("}}}}}", "}}, drop: }}}"))
    assert rcyaml("compile", "--merge").stdout.splitlines()[-1] == "build again: ArmComp, LegComp: `rcyaml build`"
    assert rcyaml("deploy", "plan").stderr.count("RC7016") == 2
    up = rcyaml("deploy", "up", "--build")
    assert rcyaml("deploy", "down").exit_code == 0
    assert up.exit_code == 0, up.output
    assert re.search(r"^arm +ready$", up.stdout, re.MULTILINE)

    # The same program with another time, as in a copied workspace, is up to date.
    program = arm / "bin" / "ArmComp"
    program.write_bytes(program.read_bytes())
    assert build(rcyaml, "arm") == {"ArmComp": "up to date"}

    # CMake builds as before; that program is judged by its time, and the next build links it again.
    stamp = (arm / ".rcyaml" / "builds" / "stamp.json").read_text()
    program.write_bytes(program.read_bytes() + b"\0")
    assert rcyaml("deploy", "plan").exit_code == 0
    assert build(rcyaml, "arm") == {"ArmComp": "built"}
    assert (arm / ".rcyaml" / "builds" / "stamp.json").read_text() != stamp

    # A component whose CMake fails is reported; the others are built.
    write_tree(tmp_path, LIDAR)
    rcyaml("compile")
    append(tmp_path / "lidar" / "CMakeLists.txt", 'message(FATAL_ERROR "the SDK of the lidar is not there")\n')
    append(arm / "src" / "specificworker.cpp", "// yet more\n")
    told = rcyaml("build")
    assert (
        "CMake rejects this: the SDK of the lidar is not there" in told.stdout
        and "lidar/CMakeLists.txt:" in told.stdout
    )
    assert "3 components: 1 built, 1 up to date, 1 failed" in told.stdout

    # Only whole trees are deleted: a missing part of one is built again.
    assert "removed  build/Release/components/LegComp/" in rcyaml("build", "--clean", "leg").stdout
    assert build(rcyaml, "leg") == {"LegComp": "built"}
    assert "removed  build/Release/" in rcyaml("build", "--clean").stdout
    assert not (tmp_path / "build" / "Release").exists() and (arm / "bin" / "ArmComp").is_file()
    assert rcyaml("build", "--clean").stdout == "no build tree exists\n"


def _compilers(folder: Path) -> list[str]:
    """The processes that still run in a folder."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{pid}/cwd").startswith(str(folder)) and int(pid) != os.getpid():
                found.append(Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " "))
        except OSError:
            continue
    return found


@in_all_builds
def test_components_that_need_trees_of_their_own(rcyaml: Rcyaml, tmp_path: Path) -> None:
    """Two have a target of the same name, and one refers to its folder as the top: each builds alone, and so here."""
    write_tree(tmp_path, SMALL)
    rcyaml("compile")
    for name in ("one", "two"):
        append(tmp_path / name / "CMakeLists.txt", "add_custom_target(manual)\n")
    append(
        tmp_path / "top" / "CMakeLists.txt",
        'if(NOT EXISTS "${CMAKE_SOURCE_DIR}/top.cdsl.yaml")\n  message(FATAL_ERROR no)\nendif()\n',
    )
    assert set(build(rcyaml).values()) == {"built"}
    assert set(build(rcyaml).values()) == {"up to date"}
    commands = json.loads((tmp_path / "compile_commands.json").read_text())
    assert {f"{tmp_path}/{name}/src/specificworker.cpp" for name in ("one", "two", "top")} <= {
        one["file"] for one in commands
    }


@in_all_builds
def test_types_and_make_and_no_workspace(rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "bin").mkdir()
    for tool in (
        "cmake",
        "make",
        "c++",
        "g++",
        "cc",
        "gcc",
        "ar",
        "as",
        "ld",
        "ranlib",
        "slice2cpp",
        "sh",
        "uname",
        "nm",
        "strip",
    ):
        for folder in os.environ["PATH"].split(os.pathsep):
            if os.path.exists(f"{folder}/{tool}"):
                (tmp_path / "bin" / tool).symlink_to(f"{folder}/{tool}")
                break
    write_tree(tmp_path / "solo", {"solo.cdsl.yaml": "component: Solo\nlanguage: cpp\n"})
    monkeypatch.chdir(tmp_path / "solo")
    rcyaml("compile")
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    assert build(rcyaml) == {"Solo": "built"}
    assert (tmp_path / "solo" / "build" / "Makefile").is_file()
    assert build(rcyaml) == {"Solo": "up to date"}
    append(tmp_path / "solo" / "src" / "specificworker.cpp", "int f() { return opne(); }\n")
    assert "‘opne’ was not declared" in rcyaml("build").stdout
