"""C++ components with Qt, offscreen: windows, and specific code for RoboComp's own tool, in three generations."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path
from typing import Any

import pytest

from components import build
from cpp_programs import Programs, in_all_builds, needs_cpp, needs_qt, shared_programs
from cpp_qt_sources import DOCUMENTS, SOURCES
from processes import Ports, Start, Storm, until
from scenario import INTERFACES, cdsl

pytestmark = [needs_cpp]

OFFSCREEN = {"QT_QPA_PLATFORM": "offscreen"}
NO_SCREEN = {"QT_QPA_PLATFORM": "", "DISPLAY": "", "WAYLAND_DISPLAY": ""}


@pytest.fixture(scope="session")
def qt_programs(tmp_path_factory: pytest.TempPathFactory) -> Programs:
    return shared_programs(tmp_path_factory.getbasetemp(), "c++ with qt", DOCUMENTS, SOURCES)


@needs_qt
def test_a_window_and_its_worker_have_threads(
    qt_programs: Programs, start: Start, tmp_path: Path, free_port: Ports, ice: Any, slices: None
) -> None:
    """The window answers while the worker is busy; they pass jobs to each other; closing it stops the component."""
    import RoboCompArm

    port = free_port()
    command = qt_programs("Window").command(tmp_path, {"Arm.Endpoints": f"tcp -p {port}"})
    running = start(command, env=OFFSCREEN, cwd=tmp_path).wait_for("at last 1999\n")
    said = running.output
    assert "window with none\n" in said
    assert "initialize elsewhere 1\n" in said
    assert "clicked in main 1\n" in said
    assert "work 7 in worker 1\n" in said
    assert "label says worked 7\n" in said
    assert "failed: in the window" in said and "failed: in between" in said, "logged, and all goes on"
    ticks = int(said.split("ticks while it worked: ")[1].split()[0])
    assert ticks > 10, "about 50 in half a second, however busy the worker and this machine are"
    RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {port}")).move([], False)
    assert running.exit_code(3) == 0
    assert "the process ends anyway" not in running.output


@needs_qt
def test_signals_stop_a_window(qt_programs: Programs, start: Start, tmp_path: Path, free_port: Ports) -> None:
    command = qt_programs("Window").command(tmp_path, {"Arm.Endpoints": f"tcp -p {free_port()}"})
    for number in (signal.SIGINT, signal.SIGTERM):
        running = start(command, env=OFFSCREEN).wait_for("Window is running")
        assert running.stop(number) == 0
        assert "the process ends anyway" not in running.output
    assert start([*command, "--startup-check"], env=OFFSCREEN).exit_code() == 0
    refused = start(command, env=NO_SCREEN)
    assert refused.exit_code() == 1
    assert "the window has no screen" in refused.output and refused.output.count("\n") == 1


@needs_qt
@in_all_builds
def test_a_dialog_as_it_was_written(qt_programs: Programs, start: Start, tmp_path: Path) -> None:
    """The generated form is used; rejecting a dialog closes it."""
    running = start(qt_programs("Dialog").command(tmp_path, {}), env=OFFSCREEN)
    assert running.exit_code() == 0


def _configs(arm: int, hand: int, behavior: int, icestorm: Storm) -> tuple[dict[str, object], dict[str, object]]:
    """The commands of a server and of its client."""
    common: dict[str, object] = {
        "TopicManager.Proxy": icestorm.manager,
        "ArmEvents": f"Events{arm}",
        "Owner": '"Shelly"',
        "Period.Compute": 20,
    }
    server = {
        "Arm.Endpoints": f"tcp -p {arm}",
        "Hand.Endpoints": f"tcp -p {hand}",
        "CommonBehavior.Endpoints": f"tcp -p {behavior}",
        "Limits.Force": 9,
    }
    client = {
        "ArmProxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
        "Arm2Proxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
        "HandProxy": f"hand:tcp -h 127.0.0.1 -p {hand}",
        "Limits.Force": 9.5,
        "Fast": "True",
        "Gains": "[0.5, -2,]",
        "Labels": '"a, b", c',
    }
    return {**common, **server}, {**common, **client}


@needs_qt
@in_all_builds
@pytest.mark.parametrize("name", ["Old", "New"])
def test_robocomps_generations(
    qt_programs: Programs, start: Start, tmp_path: Path, free_port: Ports, icestorm: Storm, behavior: Any, name: str
) -> None:
    """Interfaces, a topic, parameters; either side sets the period; it stops in order."""
    port = free_port()
    server, client = _configs(free_port(), free_port(), port, icestorm)
    calling = start(qt_programs("Latest").command(tmp_path, client))
    serving = start(qt_programs(name).command(tmp_path, server))
    said = calling.wait_for("that is all").output
    assert "configured 20 10.5 Shelly 1\n0.5 -2 a, b;c;20\n" in said
    assert "Gains is '0.5' in the config, which is not a number of this type\nthe config has no Nothing\n" in said
    assert "move 2 1\n" in said
    assert "state 1 8 home\n" in said
    assert "grasp cba\n" in said
    assert "blocked at 1 9\n" in said
    serving.wait_for("first turn, period 20 limit 9 of Shelly\n")
    serving.wait_for("failed: seven")
    if name == "Old":
        assert "an audience of 2\n" in serving.output and "as RoboComp's log\n" in serving.output
    if name == "New":
        assert "emergency after turn 3\nrestored\n" in serving.wait_for("rested\n").output
    until(lambda: behavior(port).getPeriod() == 500, "setPeriod() by the user's code")
    behavior(port).setPeriod(40)
    turns = serving.output.count("seven")
    until(lambda: serving.output.count("seven") > turns + 1, "the timer has CommonBehavior's period")
    assert behavior(port).getPeriod() == 40
    assert calling.stop() == 0
    behavior(port).killYourSelf()
    assert serving.exit_code(3) == 0
    assert "Destroying SpecificWorker\n" in serving.output and "the process ends anyway" not in serving.output


@needs_qt
@in_all_builds
@pytest.mark.parametrize("name", ["Old", "New"])
def test_robocomps_own_stop_and_check(
    qt_programs: Programs, start: Start, tmp_path: Path, free_port: Ports, icestorm: Storm, ice: Any, slices: None,
    name: str,
) -> None:  # fmt: skip
    import RoboCompArm

    arm = free_port()
    server, _ = _configs(arm, free_port(), free_port(), icestorm)
    command = qt_programs(name).command(tmp_path, server)
    checking = start([*command, "--startup-check"])
    assert checking.exit_code() == 0
    assert "Startup check\n" in checking.output and "first turn" not in checking.output
    serving = start(command).wait_for("first turn")
    RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {arm}")).betray()
    assert serving.exit_code(3) == 0


@needs_qt
@in_all_builds
def test_robocomps_window(qt_programs: Programs, start: Start, tmp_path: Path) -> None:
    """The worker is the window."""
    running = start(qt_programs("Face").command(tmp_path, {"Period.Compute": 20}), env=OFFSCREEN)
    assert running.exit_code() == 0
    assert "clicked 1\n" in running.output


@needs_qt
@in_all_builds
def test_robocomps_skeleton(
    qt_programs: Programs, start: Start, tmp_path: Path, free_port: Ports, icestorm: Storm
) -> None:
    properties = {
        "Arm.Endpoints": f"tcp -p {free_port()}",
        "HandProxy": f"hand:tcp -h 127.0.0.1 -p {free_port()}",
        "TopicManager.Proxy": icestorm.manager,
    }
    running = start(qt_programs("Bare").command(tmp_path, properties)).wait_for("waiting for Hand")
    assert running.stop() == 0


def test_without_qt(tmp_path: Path) -> None:
    """One readable line says what to install; a component without a window does not need it."""
    keys: dict[str, Any] = {"gui": {"toolkit": "qt", "base": "QWidget"}}
    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", "cpp", **keys)}, tmp_path / "with")["Any"]
    hidden = [*(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("QT", "Qt6", "Qt5"))]
    command = ["cmake", "-S", str(built.root), "-B", str(tmp_path / "build"), *hidden]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode != 0
    assert "Any needs Qt 6 or 5 (Core Widgets)" in done.stderr and "apt install qt6-base-dev" in done.stderr
    plain = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", "cpp")}, tmp_path / "without")["Any"]
    texts = [file.read_text() for file in plain.root.rglob("*") if file.is_file()]
    assert not any("<Q" in text or "Qt6" in text for text in texts)
