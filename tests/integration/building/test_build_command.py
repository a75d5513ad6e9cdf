"""`rcyaml build` with components in Python, and in languages whose build is a command."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

pytestmark = pytest.mark.processes
pytest.importorskip("Ice", reason="Ice's Python module is not installed")
Rcyaml = Callable[..., Result]

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {lift: {in: {by: float}}}}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "leg/leg.cdsl.yaml": "component: LegComp\nlanguage: python\nimports: [Arm]\nrequires: [Arm]\n",
}
# A component in Java, as a build sees it: a command, code and a program.
JAVA = {
    "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: java\n", "eye/src/SpecificWorker.java": "class SpecificWorker {}\n",
    "eye/generated/Main.java": "class Main {}\n",
}  # fmt: skip


@pytest.fixture(autouse=True)
def _ice_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RCYAML_PYTHON", sys.executable)


@pytest.fixture
def workspace(rcyaml: Rcyaml, tmp_path: Path) -> Path:
    write_tree(tmp_path, DOCUMENTS)
    assert rcyaml("compile").exit_code == 0
    return tmp_path


def command(folder: Path, text: str) -> None:
    script = folder / "eye" / "generated" / "build"
    script.write_text(f"#!/bin/sh\ncd {folder}/eye\n{text}\n")
    script.chmod(0o755)


def states(rcyaml: Rcyaml, *args: str) -> dict[str, str]:
    result = rcyaml("build", "--format", "json", *args)
    return {one["name"]: one["state"] for one in json.loads(result.stdout)["components"]}


def test_all_components_then_none_then_those_that_changed(workspace: Path, rcyaml: Rcyaml) -> None:
    assert states(rcyaml) == {"ArmComp": "built", "LegComp": "built"}
    assert states(rcyaml) == {"ArmComp": "up to date", "LegComp": "up to date"}
    code = workspace / "leg" / "src" / "specificworker.py"
    code.touch()
    assert states(rcyaml)["LegComp"] == "up to date"
    code.write_text(f"{code.read_text()}\n# more\n")
    assert states(rcyaml) == {"ArmComp": "up to date", "LegComp": "built"}
    assert list((workspace / "leg" / "src" / "__pycache__").glob("specificworker.*.pyc"))


def test_a_changed_interface_makes_all_its_users_stale(workspace: Path, rcyaml: Rcyaml) -> None:
    states(rcyaml)
    (workspace / "Arm.idsl.yaml").write_text(DOCUMENTS["Arm.idsl.yaml"].replace("float", "int"))
    rcyaml("compile")
    assert states(rcyaml) == {"ArmComp": "built", "LegComp": "built"}


@pytest.mark.parametrize("name", ["LegComp", "leg", "leg/leg.cdsl.yaml", "legcomp"])
def test_named_components(workspace: Path, rcyaml: Rcyaml, name: str) -> None:
    assert states(rcyaml, name) == {"LegComp": "built"}


def test_a_deployment_stands_for_the_components_that_it_starts(workspace: Path, rcyaml: Rcyaml) -> None:
    (workspace / "robot.ddsl.yaml").write_text(
        "deployment: Robot\ncomponents:\n  leg: {component: leg}\n  sh: {program: sh}\n"
    )
    assert states(rcyaml, "robot.ddsl.yaml") == {"LegComp": "built"}
    assert states(rcyaml, "robot.ddsl.yaml", "arm") == {"ArmComp": "built", "LegComp": "up to date"}
    (workspace / "robot.ddsl.yaml").write_text("deployment: Robot\ncomponents: {leg: {component: log}}\n")
    result = rcyaml("build", "robot.ddsl.yaml")
    assert result.exit_code == 1 and "RC4101" in result.output


def test_named_components_from_a_folder(workspace: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(workspace / "leg")
    assert states(rcyaml) == {"LegComp": "built"}
    assert states(rcyaml, "..") == {"ArmComp": "built", "LegComp": "up to date"}


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("LegCmop", "unknown component 'LegCmop'; did you mean 'LegComp'?"),
        ("toe/toe.cdsl.yaml", "does not exist"),
    ],
)
def test_unknown_components(workspace: Path, rcyaml: Rcyaml, name: str, message: str) -> None:
    result = rcyaml("build", name)
    assert result.exit_code == 2 and message in result.stderr


def test_an_error_of_python_has_its_line_and_others_are_built(workspace: Path, rcyaml: Rcyaml) -> None:
    (workspace / "arm" / "src" / "specificworker.py").write_text("import os\n\n\ndef lift(:\n    pass\n")
    (workspace / "leg" / "src" / "specificworker.py").write_text("import os\n\nnowhere = os.no_such_name\n")
    result = rcyaml("build")
    assert result.exit_code == 1
    assert "arm/src/specificworker.py:4:10" in result.stdout and "SyntaxError" in result.stdout
    assert "leg/src/specificworker.py:3:1" in result.stdout
    assert "AttributeError: module 'os' has no attribute 'no_such_name'" in result.stdout
    assert "2 components: 2 failed" in result.stdout
    (workspace / "leg" / "src" / "helper.py").write_text("import sys\nsys.exit('no')\n")
    (workspace / "leg" / "src" / "specificworker.py").write_text("import helper\n")
    assert "leg/src/helper.py:2:1" in rcyaml("build", "leg").stdout


def test_output_of_user_code_is_no_diagnostic(workspace: Path, rcyaml: Rcyaml) -> None:
    code = workspace / "leg" / "src" / "specificworker.py"
    code.write_text(f"{code.read_text()}\nprint('src/x.py:1:1: error: not one')\n")
    result = rcyaml("build", "leg")
    assert result.exit_code == 0 and "not one" not in result.stdout


def test_a_component_that_is_not_compiled(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, DOCUMENTS)
    result = rcyaml("build", "arm")
    assert result.exit_code == 1
    assert "error[RC8004]: ArmComp is not compiled yet" in result.stdout
    assert "`rcyaml compile arm/arm.cdsl.yaml`" in result.stdout


def test_a_component_of_another_run_time_is_told_with_its_command(workspace: Path, rcyaml: Rcyaml) -> None:
    """Another component was compiled with another rcyaml, which replaced the run time."""
    code = workspace / "leg" / "generated" / "component.py"
    before = re.search(r"runtime=[\"'](\w+)", code.read_text())
    assert before is not None
    code.write_text(code.read_text().replace(before[1], "0" * len(before[1])))
    result = rcyaml("build")
    assert "LegComp cannot be built: it was generated for another run time than the one in" in result.stdout
    assert "`rcyaml compile leg/leg.cdsl.yaml`" in result.stdout and "Traceback" not in result.stdout
    assert "built       arm/bin/ArmComp" in result.stdout


def test_a_change_since_the_compile_is_reported(workspace: Path, rcyaml: Rcyaml) -> None:
    (workspace / "Arm.idsl.yaml").write_text(DOCUMENTS["Arm.idsl.yaml"].replace("float", "int"))
    result = rcyaml("build", "leg")
    assert result.exit_code == 0
    assert "warning[RC7012]: 'LegComp' was compiled before Arm.idsl.yaml changed" in result.stdout
    rcyaml("compile")
    assert "RC7012" not in rcyaml("build").stdout


def test_others_are_built_if_a_document_cannot_be_read(workspace: Path, rcyaml: Rcyaml) -> None:
    (workspace / "arm" / "arm.cdsl.yaml").write_text("component: [\n")
    result = rcyaml("build")
    assert result.exit_code == 1
    assert "arm/arm.cdsl.yaml" in result.stdout and "built       leg/bin/LegComp" in result.stdout
    result = rcyaml("build", "arm/arm.cdsl.yaml")
    assert result.exit_code == 1 and "arm/arm.cdsl.yaml" in result.output


def test_no_components(rcyaml: Rcyaml, tmp_path: Path) -> None:
    result = rcyaml("build")
    assert (
        result.exit_code == 0
        and result.stdout == "this folder has no component; `rcyaml new component NAME` writes one\n"
    )


def test_a_command_whose_output_has_a_location(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, JAVA)
    command(tmp_path, "echo 'src/SpecificWorker.java:1: error: cannot find symbol'; exit 3")
    result = rcyaml("build")
    assert "error[RC8001]: the Java compiler rejects this: cannot find symbol" in result.stdout
    assert "eye/src/SpecificWorker.java:1:1" in result.stdout and "RC8003" not in result.stdout
    command(tmp_path, "echo no luck; exit 3")
    result = rcyaml("build")
    assert "error[RC8003]: EyeComp cannot be built: its build failed with exit code 3" in result.stdout
    assert "    no luck" in result.stdout


def test_a_stale_program_is_not_deployed(rcyaml: Rcyaml, tmp_path: Path) -> None:
    """Whatever built it; the command in the hint works."""
    write_tree(tmp_path, JAVA | {
        "rcyaml.yaml": "", "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  eye: {component: eye, ready: {log: up}}\n  left: {component: eye, enabled: false}\n",
    })  # fmt: skip
    command(tmp_path, "mkdir -p bin; printf '#!/bin/sh\\necho up; sleep 60\\n' > bin/EyeComp; chmod +x bin/EyeComp")
    plan = rcyaml("deploy", "plan")
    assert plan.exit_code == 1 and "then `rcyaml build EyeComp`" in plan.stderr and "RC7016" not in plan.stderr
    assert rcyaml("build", "EyeComp").exit_code == 0
    assert rcyaml("deploy", "plan").exit_code == 0
    code = tmp_path / "eye" / "src" / "SpecificWorker.java"
    code.write_text("class SpecificWorker { int more; }\n")
    for command_ in ("plan", "up"):
        result = rcyaml("deploy", command_)
        assert result.exit_code == 1
        assert (
            "error[RC7016]: the program of 'eye' is older than its sources: eye/src/SpecificWorker.java"
            in result.stderr
        )
        assert "`rcyaml build EyeComp`" in result.stderr
    assert "warning[RC7016]" in rcyaml("deploy", "status").stderr
    up = rcyaml("deploy", "up", "--build")
    assert up.exit_code == 0, up.output
    assert "built       eye/bin/EyeComp" in up.stdout and "eye  ready" in up.stdout
    code.write_text("class SpecificWorker { int yetMore; }\n")
    assert rcyaml("deploy", "restart").exit_code == 1
    assert rcyaml("deploy", "down").exit_code == 0
    command(tmp_path, "echo 'src/SpecificWorker.java:1: error: no'; exit 1")
    up = rcyaml("deploy", "up", "--build")
    assert up.exit_code == 1 and "Robot: nothing was changed" in up.stdout


def test_programs_on_other_hosts_and_other_programs_are_not_checked(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, JAVA | {
        "rcyaml.yaml": "", "eye/bin/EyeComp": "-> /bin/true", "eye/bin/other": "-> /bin/true",
        "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  eye: {component: eye, executable: bin/other}\n",
        "far.ddsl.yaml": "deployment: Far\nhosts: {there: 192.0.2.7}\ncomponents:\n  eye: {component: eye, host: there}\n",
    })  # fmt: skip
    for document in ("robot.ddsl.yaml", "far.ddsl.yaml"):
        assert "RC7016" not in rcyaml("deploy", "plan", document).output


def test_compile_lists_what_to_build_again(rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        DOCUMENTS | {"eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: java\nimports: [Arm]\nrequires: [Arm]\n"},
    )
    assert "build again" not in rcyaml("compile").stdout, "there is no program yet"
    (tmp_path / "eye" / "bin" / "EyeComp").symlink_to("/bin/true")
    (tmp_path / "Arm.idsl.yaml").write_text(DOCUMENTS["Arm.idsl.yaml"].replace("float", "int"))
    assert rcyaml("compile").stdout.splitlines()[-1] == "build again: EyeComp: `rcyaml build EyeComp`"
    assert "build again" not in rcyaml("compile").stdout, "nothing was written"


def test_ctrl_c_ends_a_build(tmp_path: Path) -> None:
    write_tree(tmp_path, JAVA)
    command(tmp_path, "echo $$ > pid; sleep 60; echo gone on > after")
    build = subprocess.Popen(
        [Path(sys.executable).with_name("rcyaml"), "build"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )  # fmt: skip
    pid = tmp_path / "eye" / "pid"
    until = time.monotonic() + 30
    while not (pid.is_file() and pid.read_text().strip()) and time.monotonic() < until:
        time.sleep(0.05)
    build.send_signal(signal.SIGINT)
    out, err = build.communicate(timeout=30)
    assert build.returncode == 130, out + err
    assert "interrupted" in err and "Traceback" not in err
    assert not os.path.exists(f"/proc/{int(pid.read_text())}") and not (tmp_path / "eye" / "after").exists()


@pytest.mark.skipif(not shutil.which("cmake"), reason="CMake is not installed")
def test_without_cmake_the_package_to_install_is_named(
    rcyaml: Rcyaml, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "", "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: cpp\n"})
    rcyaml("compile")
    monkeypatch.setenv("PATH", str(tmp_path))
    result = rcyaml("build")
    assert result.exit_code == 1
    assert "error[RC8003]: ArmComp cannot be built: the program 'cmake' is missing" in result.stdout
    assert "sudo apt install cmake" in result.stdout
