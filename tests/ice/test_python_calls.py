"""Python components that serve and call each other over real Ice."""

from __future__ import annotations

from typing import Any

import pytest

from components import Build, Built
from processes import Ports, Start
from scenario import INTERFACES, cdsl

SERVER = """
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompArm, RoboCompTypes
import time

class SpecificWorker(GenericWorker):
    def Arm_move(self, path, fast):
        if fast:
            raise RoboCompArm.Blocked(path[0], 9.5)
        return len(path)

    def Arm_state(self):
        return RoboCompTypes.Side.right, RoboCompTypes.Pose(1, 2), {"home": RoboCompTypes.Pose(3, 4)}

    def Arm_breakDown(self):
        return 1 / 0

    def Arm_betray(self):
        raise RoboCompArm.Broken()

    def Arm_block(self, seconds):
        time.sleep(seconds)

    def Hand_grasp(self, image):
        return image[::-1]
"""

CLIENT = """
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompArm, RoboCompTypes
import Ice

class SpecificWorker(GenericWorker):
    def initialize(self):
        path = [RoboCompTypes.Pose(1, 2), RoboCompTypes.Pose(x=7)]
        print("move", self.arm_proxy.move(path, False), self.arm2_proxy.move([], False))
        side, pose, named = self.arm_proxy.state()
        print("state", side, pose.y, {key: at.x for key, at in named.items()})
        print("grasp", self.hand_proxy.grasp(b"abc"))
        try:
            self.arm_proxy.move(path, True)
        except RoboCompArm.Blocked as blocked:
            print("blocked at", blocked.where.x, blocked.force)
        for call in self.arm_proxy.breakDown, self.arm_proxy.betray:
            try:
                call()
            except Ice.UnknownException as error:
                print("unknown:", error.unknown.splitlines()[-1])
        print("that is all")
"""


@pytest.fixture
def pair(build: Build, free_port: Ports) -> tuple[Built, Built]:
    """A server, and a client with its address."""
    built = build(
        {
            **INTERFACES,
            "server/server.cdsl.yaml": cdsl("Server", implements=["Arm", "Hand"]),
            "client/client.cdsl.yaml": cdsl("Client", requires=["Arm", {"Arm2": "Arm"}, "Hand"]),
        }
    )
    arm, hand = free_port(), free_port()
    (built["Server"].root / "src" / "specificworker.py").write_text(SERVER)
    (built["Client"].root / "src" / "specificworker.py").write_text(CLIENT)
    server = built["Server"].configure({"Arm.Endpoints": f"tcp -p {arm}", "Hand.Endpoints": f"tcp -p {hand}"})
    client = built["Client"].configure(
        {
            "ArmProxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
            "Arm2Proxy": f"arm:tcp -h 127.0.0.1 -p {arm}",
            "HandProxy": f"hand:tcp -h 127.0.0.1 -p {hand}",
        }
    )
    return server, client


def test_one_calls_the_other(pair: tuple[Built, Built], start: Start) -> None:
    """Several interfaces, two proxies to one of them, results with `out`, declared and undeclared exceptions."""
    server, client = pair
    serving = start(server.command).wait_for("Server is running")
    said = start(client.command).wait_for("Client is running").output
    assert "move 2 0\n" in said
    assert "state right 2.0 {'home': 3.0}\n" in said
    assert "grasp b'cba'\n" in said
    assert "blocked at 1.0 9.5\n" in said
    assert "Arm_breakDown: ZeroDivisionError: division by zero" in said
    assert "Arm_betray: Broken" in said
    assert "Traceback" in serving.output and "1 / 0" in serving.output
    assert serving.output.count("ZeroDivisionError") == 1, "logged once, not again by Ice"
    assert "dispatch exception" not in serving.output


def test_it_runs_as_it_was_compiled(pair: tuple[Built, Built], build: Build, start: Start) -> None:
    """The skeleton returns a value of the right type from every method."""
    server, client = pair
    build({})
    (client.root / "src" / "specificworker.py").write_text(CLIENT)
    serving = start(server.command).wait_for("Server is running")
    said = start(client.command).wait_for("that is all").output
    assert "move 0 0\nstate left 2.5 {}\n" in said, "a struct has its defaults, an enum its first value"
    assert "grasp b''" in said
    assert "Arm_move() is still to be written" in serving.output


MUTUAL = """
from generated.genericworker import GenericWorker
import os

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.value = {value}
        if {value} == 2:
            print("the other one said", self.{proxy}({arguments}))

    def {method}(self, *arguments):
        return {answer}
"""


def test_two_that_require_each_other(build: Build, start: Start, free_port: Ports) -> None:
    """Both answer pings from the start; a call waits until the other side has initialized."""
    built = build(
        {
            **INTERFACES,
            "a/a.cdsl.yaml": cdsl("A", implements=["Arm"], requires=["Hand"]),
            "b/b.cdsl.yaml": cdsl("B", implements=["Hand"], requires=["Arm"]),
        }
    )
    arm, hand = free_port(), free_port()
    worker = MUTUAL.format(value=1, proxy="x", arguments="", method="Arm_move", answer="self.value")
    (built["A"].root / "src" / "specificworker.py").write_text(worker)
    worker = MUTUAL.format(value=2, proxy="arm_proxy.move", arguments="[], True", method="Hand_grasp", answer="b''")
    (built["B"].root / "src" / "specificworker.py").write_text(worker)
    built["A"].configure({"Arm.Endpoints": f"tcp -p {arm}", "HandProxy": f"hand:tcp -h 127.0.0.1 -p {hand}"})
    built["B"].configure({"Hand.Endpoints": f"tcp -p {hand}", "ArmProxy": f"arm:tcp -h 127.0.0.1 -p {arm}"})
    first, second = start(built["A"].command), start(built["B"].command)
    first.wait_for("A is running")
    assert "the other one said 1\n" in second.wait_for("B is running").output


def test_the_current_folder_does_not_matter(pair: tuple[Built, Built], start: Start, tmp_path: Any) -> None:
    """Also through a link; a config on the command line is relative to the caller's folder."""
    server, _ = pair
    (tmp_path / "link").symlink_to(server.root / "bin" / "Server")
    command = [server.command[0], tmp_path / "link"]
    start(command, cwd="/").wait_for("Server is running").stop()
    (server.root / "etc" / "config").rename(tmp_path / "mine")
    start([*command, "mine"], cwd=tmp_path).wait_for("Server is running")


def test_paths_with_blanks_and_accents(build: Build, start: Start, free_port: Ports) -> None:
    built = build({**INTERFACES, "mi brazo ñ/arm.cdsl.yaml": cdsl("Brazo", implements=["Arm"])})
    arm = built["Brazo"].configure({"Arm.Endpoints": f"tcp -p {free_port()}"})
    start(arm.command).wait_for("Brazo is running")


THREADS = """
from generated.genericworker import GenericWorker
import threading

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.mine = threading.local()

    def Arm_move(self, path, fast):
        self.mine.calls = getattr(self.mine, "calls", 0) + 1
        return self.mine.calls
"""
CALLS_IN_TURN = """
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        print("called", *(self.arm_proxy.move([], False) for _ in range(3)))
"""


@pytest.mark.parametrize("pool", [{}, {"Arm.ThreadPool.Size": 1}, {"Ice.ThreadPool.Server.SizeMax": 4}])
def test_threads_keep_their_python_state(build: Build, start: Start, free_port: Ports, pool: dict[str, object]) -> None:
    """So calls are as fast as Ice's own, and thread-local values stay. Threads that may end early do not keep it."""
    documents = {"a/a.cdsl.yaml": cdsl("A", implements=["Arm"]), "b/b.cdsl.yaml": cdsl("B", requires=["Arm"])}
    built = build({**INTERFACES, **documents})
    port = free_port()
    (built["A"].root / "src" / "specificworker.py").write_text(THREADS)
    (built["B"].root / "src" / "specificworker.py").write_text(CALLS_IN_TURN)
    built["A"].configure({"Arm.Endpoints": f"tcp -p {port}", **pool})
    built["B"].configure({"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {port}"})
    serving = start(built["A"].command).wait_for("A is running")
    said = start(built["B"].command).wait_for("B is running").output
    assert f"called {'1 1 1' if 4 in pool.values() else '1 2 3'}\n" in said
    assert serving.stop() == 0
