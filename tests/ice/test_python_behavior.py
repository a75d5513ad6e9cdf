"""CommonBehavior of a Python component, called from another process; and its worker's period."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from components import Build, Built
from processes import PATIENCE, Ports, Running, Start, until
from scenario import INTERFACES, cdsl

WORKER = """
from generated.genericworker import GenericWorker
import time

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.begin = time.monotonic()
        self.turns = 0

    def compute(self):
        self.turns += 1
        if self.turns == 3:
            raise ValueError("the third one fails")
        print("turn", self.turns, round(1000 * (time.monotonic() - self.begin)), self.getPeriod(), flush=True)
        if self.turns == 5:
            time.sleep(0.25)
"""
Ask = Callable[[int], Any]


@pytest.fixture
def port(free_port: Ports) -> int:
    return free_port()


@pytest.fixture
def component(build: Build, port: int) -> Built:
    built = build({**INTERFACES, "w/w.cdsl.yaml": cdsl("Worker", requires=["Arm"], period="40 ms")})["Worker"]
    (built.root / "src" / "specificworker.py").write_text(WORKER)
    return built.configure(
        {
            "CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {port}",
            "ArmProxy": f"commonbehavior:tcp -h 127.0.0.1 -p {port}",
            "Ice.Warn.Connections": "0",
            "Arm.Speed": "1.5",
        }
    )


def turns(running: Running) -> list[tuple[int, int]]:
    """The number and the time of each turn so far."""
    rows = [line.split() for line in running.output.splitlines() if line.startswith("turn ")]
    return [(int(row[1]), int(row[2])) for row in rows if len(row) == 4]


def test_what_it_reports(component: Built, start: Start, behavior: Ask, port: int) -> None:
    start(component.command).wait_for("Worker is running")
    asked = behavior(port)
    assert str(asked.getState()) == "Running"
    assert asked.getPeriod() == 40
    first = asked.timeAwake()
    assert 0 <= first < PATIENCE * 1000
    until(lambda: asked.timeAwake() > first, "time to pass")
    parameters = asked.getParameterList()
    properties = {"CommonBehavior.Endpoints", "ArmProxy", "Arm.Speed"}
    assert set(parameters) == {*properties, "period.compute", "period.emergency"}
    speed = parameters["Arm.Speed"]
    assert (speed.editable, speed.value, speed.type) == (False, "1.5", "string")


def test_what_it_accepts(component: Built, start: Start, behavior: Ask, port: int) -> None:
    running = start(component.command).wait_for("Worker is running")
    asked = behavior(port)
    asked.setPeriod(20)
    assert asked.getPeriod() == 20
    for wrong in (0, -5):
        asked.setPeriod(wrong)
        assert asked.getPeriod() == 20
        running.wait_for(f"WARNING Worker: setPeriod({wrong}) rejected")
    asked.setParameterList(asked.getParameterList())
    running.wait_for("parameters changed by setParameterList: none")
    changed = asked.getParameterList()
    changed["Arm.Speed"].value, changed["period.compute"].value = "2", "99"
    asked.setParameterList(changed)
    running.wait_for("setParameterList rejected: unknown parameter 'Arm.Speed'")
    assert asked.getPeriod() == 20, "all, or none"
    config = component.root / "etc" / "config"
    config.write_text(config.read_text() + "period.compute = 30\n")
    asked.reloadConfig()
    assert asked.getPeriod() == 30
    config.write_text("period.compute = soon\n")
    asked.reloadConfig()
    assert asked.getPeriod() == 30
    running.wait_for("etc/config: period.compute must be a whole number (ms), and is 'soon'")
    asked.killYourSelf()
    assert running.exit_code(2) == 0


def test_it_responds_while_it_starts(component: Built, start: Start, behavior: Ask, port: int, ice: Any) -> None:
    """Waiting for another component is a state, and so is a long initialize()."""
    (component.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\nimport time\n\nclass SpecificWorker(GenericWorker):\n"
        "    def initialize(self):\n        print('in initialize()')\n        time.sleep(0.5)\n"
    )
    start(component.command).wait_for("in initialize()")
    asked = behavior(port)
    assert str(asked.getState()) == "Starting"
    until(lambda: str(asked.getState()) == "Running", "the end of initialize()")


def test_the_period(component: Built, start: Start) -> None:
    """No drift; an exception costs one turn; turns missed in a long one are skipped; the others keep the beat."""
    running = start(component.command)
    until(lambda: len(turns(running)) >= 15, "15 turns")
    seen = dict(turns(running))
    assert 3 not in seen and "ValueError: the third one fails" in running.output
    assert "Traceback" in running.output
    assert seen[2] >= 79
    assert seen[6] >= seen[5] + 250
    assert seen[7] - seen[6] <= 3 * 40, "it does not make up for those it missed"
    off = [at % 40 for at in seen.values()]
    late = sorted(min(o, 40 - o) for o in off)[len(off) // 2]
    assert late <= 15, f"the beat drifts: {off}"


def test_the_period_of_the_config_and_of_the_command_line(component: Built, start: Start) -> None:
    for option, expected in (("--Period.Compute=25", " 25\n"), ("--period.compute=70", " 70\n")):
        running = start([*component.command, option])
        until(lambda running=running: turns(running), "a turn")
        assert running.output.split("turn 1", 1)[1].splitlines(keepends=True)[0].endswith(expected)
        running.stop()


def test_a_new_period_applies_at_once(component: Built, start: Start, behavior: Ask, port: int) -> None:
    running = start([*component.command, "--period.compute=3600000"]).wait_for("Worker is running")
    assert turns(running) == []
    behavior(port).setPeriod(10)
    until(lambda: len(turns(running)) > 3, "turns")


def test_it_responds_while_a_method_runs(
    build: Build, start: Start, behavior: Ask, port: int, ice: Any, free_port: Ports
) -> None:
    built = build({**INTERFACES, "w/w.cdsl.yaml": cdsl("Busy", implements=["Arm"])})["Busy"]
    arm = free_port()
    built.configure({"CommonBehavior.Endpoints": f"tcp -p {port}", "Arm.Endpoints": f"tcp -p {arm}"})
    (built.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\nimport time\n\nclass SpecificWorker(GenericWorker):\n"
        "    def Arm_block(self, seconds):\n        print('blocking')\n        time.sleep(seconds)\n"
    )
    running = start(built.command).wait_for("Busy is running")
    asked = behavior(port)
    import RoboCompArm

    call = RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {arm}")).blockAsync(30)
    running.wait_for("blocking")
    assert str(asked.getState()) == "Running"
    asked.killYourSelf()
    assert running.exit_code(2.5) == 0
    assert call.exception(5) is not None
