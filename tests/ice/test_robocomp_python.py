"""Specific code for RoboComp's own tool runs on the generated generic part: with PySide6, and without any Qt."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from components import Build, Built
from processes import Ports, Start, Storm, until
from robocomp_workers import CLIENT_2025, NO_QT, SERVER_2020, SERVER_2023
from scenario import INTERFACES, cdsl


@pytest.fixture
def pair(build: Build, free_port: Ports, icestorm: Storm) -> Callable[[str], tuple[Built, Built, int]]:
    """`pair(code)`: a configured server with this specific code and its client, and the TCP port of the server's
    CommonBehavior."""

    def made(code: str) -> tuple[Built, Built, int]:
        server: dict[str, Any] = {"implements": ["Arm", "Hand"], "publishes": ["ArmEvents"]}
        client: dict[str, Any] = {"requires": ["Arm", {"Arm2": "Arm"}, "Hand"], "subscribes": ["ArmEvents"]}
        built = build(
            {
                **INTERFACES,
                "server/server.cdsl.yaml": cdsl("Server", compatibility="robocomp", **server),
                "client/client.cdsl.yaml": cdsl("Client", compatibility="robocomp", **client),
            }
        )
        (built["Server"].root / "src" / "specificworker.py").write_text(code)
        (built["Server"].root / "src" / "genericworker.py").write_text("raise SystemExit('RoboComp own, outdated')\n")
        (built["Client"].root / "src" / "specificworker.py").write_text(CLIENT_2025)
        arm, hand, behavior = free_port(), free_port(), free_port()
        common = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": f"Events{arm}", "Owner": '"Shelly"'}
        server_config = {
            **common,
            "Arm.Endpoints": f"tcp -p {arm}",
            "Hand.Endpoints": f"tcp -p {hand}",
            "CommonBehavior.Endpoints": f"tcp -p {behavior}",
            "Limits.Force": 9,
        }
        client_config = {
            **common,
            "ArmProxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
            "Arm2Proxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
            "HandProxy": f"hand:tcp -h 127.0.0.1 -p {hand}",
            "Period.Compute": 20,
            "Limits.Force": 9.5,
            "Fast": "True",
        }
        return built["Server"].configure(server_config), built["Client"].configure(client_config), behavior

    return made


@pytest.mark.parametrize("code", [SERVER_2023, SERVER_2020], ids=["2023", "2020"])
def test_interfaces_topics_and_parameters(
    pair: Callable[[str], tuple[Built, Built, int]],
    code: str,
    robocomps_qt: Mapping[str, str],
    start: Start,
    behavior: Callable[[int], Any],
) -> None:
    server, client, port = pair(code)
    calling = start(client.command, env=robocomps_qt)
    serving = start(server.command, env=robocomps_qt, cwd=Path("/"))
    said = calling.wait_for("that is all").output
    assert "configured 20 10.5 Shelly True\n" in said
    assert "move 2 1\n" in said
    assert "state right 8.0 ['home']\n" in said
    assert "grasp b'cba'\n" in said
    assert "blocked at 1.0 9.0\n" in said
    serving.wait_for("first turn in server limit 9").wait_for("of Shelly\n")
    if code is SERVER_2020:
        serving.wait_for("hurried 2 True\n")
    until(lambda: behavior(port).getPeriod() == 500, "setPeriod() by the user's code")
    assert calling.stop() == 0
    behavior(port).killYourSelf()
    assert serving.exit_code(3) == 0


def test_compute_fails_and_goes_on(
    pair: Callable[[str], tuple[Built, Built, int]],
    robocomps_qt: Mapping[str, str],
    start: Start,
    behavior: Callable[[int], Any],
) -> None:
    """An exception in a slot is logged, and the next turn follows; CommonBehavior and user's code share the period."""
    server, _, port = pair(SERVER_2023)
    serving = start(server.command, env=robocomps_qt)
    until(lambda: serving.output.count("ZeroDivisionError") > 1, lambda: serving.output)
    assert behavior(port).getPeriod() == 20
    behavior(port).setPeriod(3_600_000)
    until(lambda: behavior(port).getPeriod() == 3_600_000, "the new period")
    shown = serving.output.count("ZeroDivisionError")
    assert serving.stop() == 0
    assert serving.output.count("ZeroDivisionError") <= shown + 1, "the timer has the new period, too"


def test_startup_check_and_user_stop(
    pair: Callable[[str], tuple[Built, Built, int]],
    robocomps_qt: Mapping[str, str],
    start: Start,
    ice: Any,
    slices: None,
) -> None:
    import RoboCompArm

    server, _, _ = pair(SERVER_2023)
    checking = start([*server.command, "--startup-check"], env=robocomps_qt)
    assert checking.exit_code() == 0
    assert "checked 1 True\n" in checking.output
    serving = start(server.command, env=robocomps_qt).wait_for("first turn")
    config = (server.root / "etc" / "config").read_text()
    endpoint = next(line.partition("= ")[2] for line in config.splitlines() if line.startswith("Arm.Endpoints"))
    RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:{endpoint} -h 127.0.0.1")).betray()
    assert serving.exit_code(3) == 0


def test_more_of_qt_than_exists(build: Build, start: Start, tmp_path: Path) -> None:
    """One readable line, if the user's code needs the real Qt."""
    (tmp_path / "hidden" / "PySide6").mkdir(parents=True)
    (tmp_path / "hidden" / "PySide6" / "__init__.py").write_text(NO_QT)
    component = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", compatibility="robocomp")})["Any"].configure({})
    for line in ("from PySide2.QtCore import QDateTime\n", "from PySide6.QtGui import QImage\n"):
        (component.root / "src" / "specificworker.py").write_text(f"{line}from genericworker import *\n")
        refused = start(component.command, env={"PYTHONPATH": str(tmp_path / "hidden")})
        assert refused.exit_code() == 1
        assert "src/ needs a part of Qt that is not installed" in refused.output and "pip install" in refused.output
        assert "Traceback" not in refused.output


def test_the_skeleton_runs(build: Build, start: Start, free_port: Ports, robocomps_qt: Mapping[str, str]) -> None:
    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", compatibility="robocomp", implements=["Arm"])})["Any"]
    built.configure({"Arm.Endpoints": f"tcp -p {free_port()}"})
    running = start(built.command, env=robocomps_qt).wait_for("Any is running")
    assert running.stop() == 0
    assert "Traceback" not in running.output


EXITING = """
from genericworker import *


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super().__init__(proxy_map)
        {first}
        self.timer.timeout.connect(self.compute)
        self.timer.start(20)

    @QtCore.Slot()
    def compute(self):
        {turn}

    def Arm_betray(self):
        sys.exit(4)
"""


@pytest.mark.parametrize(
    ("first", "turn", "code"),
    [
        ("pass", "sys.exit(4)", 4),
        ("pass", "sys.exit('no camera')", 1),
        ("pass", "raise KeyboardInterrupt", 0),
        ("sys.exit(4)", "pass", 4),
        ("sys.exit('no camera')", "pass", 1),
    ],
)
def test_it_exits(
    build: Build, start: Start, free_port: Ports, robocomps_qt: Mapping[str, str], first: str, turn: str, code: int
) -> None:
    """A slot, or the constructor: in order, with the code and the text of `sys.exit`."""
    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", compatibility="robocomp", implements=["Arm"])})["Any"]
    built.configure({"Arm.Endpoints": f"tcp -p {free_port()}"})
    (built.root / "src" / "specificworker.py").write_text(EXITING.format(first=first, turn=turn))
    running = start(built.command, env=robocomps_qt)
    assert running.exit_code() == code
    assert "Traceback" not in running.output and "ends anyway" not in running.output
    assert ("no camera\n" in running.output) == (code == 1)


def test_a_served_method_exits(
    build: Build, start: Start, free_port: Ports, robocomps_qt: Mapping[str, str], ice: Any, slices: None
) -> None:
    import Ice
    import RoboCompArm

    built = build({**INTERFACES, "any.cdsl.yaml": cdsl("Any", compatibility="robocomp", implements=["Arm"])})["Any"]
    port = free_port()
    built.configure({"Arm.Endpoints": f"tcp -p {port}"})
    (built.root / "src" / "specificworker.py").write_text(EXITING.format(first="pass", turn="pass"))
    running = start(built.command, env=robocomps_qt).wait_for("Any is running")
    with pytest.raises(Ice.UnknownException, match="Arm_betray"):
        RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {port}")).betray()
    assert running.exit_code(2) == 4
