"""Code for RoboComp's own tool with a state machine: its slots and signals, in the main thread, in both languages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from components import Build, Built
from cpp_programs import FAST, cmake, in_all_builds, needs_cpp, needs_qt
from processes import Ports, Running, Start, until
from robocomp_machines import EXPECTED, HEADER, MACHINE, PYTHON, SOURCE
from scenario import INTERFACES, cdsl

Behavior = Callable[[int], Any]
OFFSCREEN = {"QT_QPA_PLATFORM": "offscreen"}


def documents(language: str, **keys: object) -> dict[str, str]:
    document = cdsl("Robot", language, compatibility="robocomp", statemachine="patrol.scxml", **keys)
    return {**INTERFACES, "robot/robot.cdsl.yaml": document, "robot/patrol.scxml": MACHINE}


def assert_patrols(running: Running, behavior: Behavior, port: int) -> None:
    running.wait_for("> finalize")
    asked = behavior(port)
    until(lambda: asked.getParameterList()["statemachine.state"].value == "ended", lambda: running.output)
    said = [line[2:] for line in running.output.splitlines() if line.startswith("> ")]
    assert said == EXPECTED, running.output
    assert running.stop() == 0
    assert "the process ends anyway" not in running.output and "Traceback" not in running.output


def configured(built: Built, port: int) -> Built:
    return built.configure({"CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {port}", "Period.Compute": 20})


def test_python(
    build: Build, start: Start, free_port: Ports, behavior: Behavior, robocomps_qt: Mapping[str, str]
) -> None:
    port = free_port()
    robot = configured(build(documents("python"))["Robot"], port)
    (robot.root / "src" / "specificworker.py").write_text(PYTHON)
    assert_patrols(start(robot.command, env=robocomps_qt), behavior, port)
    checking = start([*robot.command, "--startup-check"], env=robocomps_qt)
    assert checking.exit_code() == 0
    assert "Startup check\n" in checking.output and "> " not in checking.output


def test_python_exits(build: Build, start: Start, free_port: Ports, robocomps_qt: Mapping[str, str]) -> None:
    """In order: the active state is left."""
    robot = configured(build(documents("python"))["Robot"], free_port())
    code = PYTHON.replace("        if self.turns < 3:\n            self.compute()\n", "        sys.exit(4)\n")
    assert code != PYTHON
    code += "\n    def sm_compute_exit(self):\n        self.say('left compute')\n"
    (robot.root / "src" / "specificworker.py").write_text(code)
    running = start(robot.command, env=robocomps_qt)
    assert running.exit_code() == 4
    assert running.output.count("> left compute\n") == 1 and "Traceback" not in running.output
    assert "ends anyway" not in running.output


@pytest.mark.parametrize("keys", [{}, {"gui": {"toolkit": "qt", "base": "QDialog"}}], ids=["alone", "window"])
def test_the_skeleton_in_python(
    build: Build, start: Start, free_port: Ports, behavior: Behavior, robocomps_qt: Mapping[str, str],
    keys: dict[str, Any],
) -> None:  # fmt: skip
    """The machine starts by itself, and `events` fires its events too."""
    if keys and "PYTHONPATH" in robocomps_qt:
        pytest.skip("windows need PySide6")
    port = free_port()
    robot = configured(build(documents("python", **keys))["Robot"], port)
    worker = robot.root / "src" / "specificworker.py"
    worker.write_text(worker.read_text().replace("        pass\n", "        self.events.t_initialize_to_compute()\n"))
    running = start(robot.command, env=robocomps_qt).wait_for("sm_compute() is still to be written")
    assert behavior(port).getParameterList()["statemachine.state"].value == "compute"
    assert running.stop() == 0
    assert "Traceback" not in running.output


@needs_cpp
@needs_qt
@in_all_builds
@pytest.mark.slow
def test_cpp(build: Build, start: Start, free_port: Ports, behavior: Behavior, tmp_path: Path) -> None:
    port = free_port()
    robot = configured(build(documents("cpp"))["Robot"], port)
    (robot.root / "src" / "specificworker.h").write_text(HEADER)
    (robot.root / "src" / "specificworker.cpp").write_text(SOURCE)
    cmake(robot.root, *FAST)
    running = start(robot.command, cwd=robot.root)
    assert_patrols(running, behavior, port)
    assert "Destroying SpecificWorker\n" in running.output
    checking = start([*robot.command, "--startup-check"], cwd=robot.root)
    assert checking.exit_code() == 0
    assert "Startup check\n" in checking.output


@needs_cpp
@needs_qt
@in_all_builds
@pytest.mark.slow
def test_the_skeleton_in_cpp(build: Build, start: Start, free_port: Ports, behavior: Behavior) -> None:
    """With every feature of a machine, and with a window; the machine starts by itself."""
    port = free_port()
    guarded = '<transition event="t_initialize_to_compute" cond="ready" target="compute"><script>greet</script>'
    files = documents("cpp", gui={"toolkit": "qt", "base": "QDialog"})
    files["robot/patrol.scxml"] = MACHINE.replace('<transition event="t_initialize_to_compute" target="compute"/>',
                                                  f"{guarded}</transition>")  # fmt: skip
    robot = configured(build(files)["Robot"], port)
    worker = robot.root / "src" / "specificworker.cpp"
    worker.write_text(
        worker.read_text().replace(
            "SpecificWorker::compute()\n{",
            """SpecificWorker::compute()
{
    events.t_initialize_to_compute();""",
        )
    )
    cmake(robot.root, *FAST)
    running = start(robot.command, cwd=robot.root, env=OFFSCREEN)
    running.wait_for("sm_initialize() is still to be written").wait_for("ready() is still to be written")
    assert behavior(port).getParameterList()["statemachine.state"].value == "initialize", "ready() says no"
    assert running.stop() == 0
