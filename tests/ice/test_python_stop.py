"""A Python component stops in order, within two seconds, at any time."""

from __future__ import annotations

import signal
import time
from typing import Any

import pytest

from components import Build, Built
from processes import Ports, Start
from scenario import INTERFACES, cdsl

BOTH = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["INT", "TERM"])
WORKER = "from generated.genericworker import GenericWorker\nimport sys, threading, time\n\nclass SpecificWorker(GenericWorker):\n"


@pytest.fixture
def arm(build: Build, free_port: Ports) -> Built:
    built = build({**INTERFACES, "a/a.cdsl.yaml": cdsl("ArmComp", implements=["Arm"])})["ArmComp"]
    return built.configure({"Arm.Endpoints": f"tcp -h 127.0.0.1 -p {free_port()}"})


def proxy(ice: Any, arm: Built) -> Any:
    import RoboCompArm

    endpoint = (arm.root / "etc" / "config").read_text().partition("= ")[2].strip()
    return RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:{endpoint}"))


def write(arm: Built, methods: str) -> None:
    (arm.root / "src" / "specificworker.py").write_text(WORKER + methods)


@BOTH
def test_a_signal_stops_it(arm: Built, start: Start, number: int) -> None:
    running = start(arm.command).wait_for("ArmComp is running")
    assert running.stop(number) == 0
    assert "the process ends anyway" not in running.output, "at once: nothing holds it up"
    assert "Traceback" not in running.output and "terminate" not in running.output


@BOTH
def test_with_a_method_that_is_stuck(arm: Built, start: Start, ice: Any, slices: None, number: int) -> None:
    write(arm, "    def Arm_block(self, seconds):\n        print('blocking')\n        time.sleep(seconds)\n")
    running = start(arm.command).wait_for("ArmComp is running")
    call = proxy(ice, arm).blockAsync(60)
    running.wait_for("blocking")
    assert running.stop(number, within=2.0) == 0
    assert "the process ends anyway" in running.output
    assert call.exception(5) is not None


@BOTH
def test_with_a_compute_that_is_stuck(arm: Built, start: Start, number: int) -> None:
    write(arm, "    def compute(self):\n        print('computing')\n        time.sleep(60)\n")
    running = start(arm.command).wait_for("computing")
    assert running.stop(number, within=2.0) == 0


def test_while_it_initializes(arm: Built, start: Start, ice: Any, slices: None) -> None:
    """A call that waits for initialize() fails, and does not delay the end."""
    write(arm, "    def initialize(self):\n        print('busy')\n        while not self._stopping.wait(0.1): pass\n")
    running = start(arm.command).wait_for("busy")
    call = proxy(ice, arm).moveAsync([], False)
    time.sleep(0.2)
    assert not call.done()
    assert running.stop(within=1.5) == 0
    assert call.exception(5) is not None


def test_while_python_is_still_importing(arm: Built, start: Start) -> None:
    path = arm.root / "src" / "specificworker.py"
    path.write_text(f"import time\nprint('importing')\ntime.sleep(60)\n{WORKER}    pass\n")
    assert start(arm.command).wait_for("importing").stop(within=2.0) == 0


def test_a_thread_of_the_user_does_not_hold_it_up(arm: Built, start: Start) -> None:
    write(arm, "    def initialize(self):\n        threading.Thread(target=time.sleep, args=(60,)).start()\n")
    assert start(arm.command).wait_for("ArmComp is running").stop(within=2.0) == 0


def test_the_worker_asks_for_it(arm: Built, start: Start) -> None:
    write(arm, "    def compute(self):\n        self.killYourSelf()\n")
    assert start(arm.command).exit_code() == 0


def test_the_worker_exits(arm: Built, start: Start) -> None:
    """`sys.exit()` in the worker's thread ends the process, not only the thread."""
    write(arm, "    def compute(self):\n        sys.exit()\n")
    assert start(arm.command).exit_code() == 0


def test_initialize_fails(arm: Built, start: Start) -> None:
    write(arm, "    def initialize(self):\n        raise OSError('no camera')\n")
    running = start(arm.command)
    assert running.exit_code() == 1
    assert "cannot start" in running.output and "OSError: no camera" in running.output


def test_many_signals(arm: Built, start: Start) -> None:
    running = start(arm.command).wait_for("ArmComp is running")
    for _ in range(20):
        running.process.send_signal(signal.SIGTERM)
    assert running.exit_code(2) == 0


def test_start_and_stop_again_and_again(arm: Built, start: Start) -> None:
    """The process ends cleanly: threads that are still in Ice would sometimes abort it."""
    for _ in range(5):
        running = start([*arm.command, "--startup-check"])
        assert running.exit_code() == 0
        assert "ArmComp: the startup check has passed" in running.output


def test_ice_admin_stops_it(arm: Built, start: Start, ice: Any, free_port: Ports) -> None:
    """As IceGrid does."""
    import Ice

    port = free_port()
    admin = [f"--Ice.Admin.Endpoints=tcp -h 127.0.0.1 -p {port}", "--Ice.Admin.InstanceName=arm"]
    running = start([*arm.command, *admin]).wait_for("ArmComp is running")
    process = ice.stringToProxy(f"arm/admin -f Process:tcp -h 127.0.0.1 -p {port}")
    Ice.ProcessPrx.uncheckedCast(process).shutdown()
    assert running.exit_code(2) == 0


def test_before_it_has_started(arm: Built, start: Start) -> None:
    """At any moment of its start, without a traceback."""
    for delay in (0.15, 0.2, 0.25, 0.3, 0.35):
        running = start(arm.command)
        time.sleep(delay)
        assert running.stop() in (0, -signal.SIGTERM), "the latter before Python has begun with our code"
        assert "Traceback" not in running.output and "ERROR" not in running.output
