"""A C++ component stops in order, within two seconds, at any time; CommonBehavior and the worker's period."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cpp_programs import Programs, needs_cpp
from processes import PATIENCE, Ports, Running, Start, until

pytestmark = [pytest.mark.slow, needs_cpp]
BOTH = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["INT", "TERM"])
Ask = Callable[[int], Any]


@pytest.fixture
def server(programs: Programs, free_port: Ports, tmp_path: Path) -> list[str | Path]:
    """The command of the component."""
    ports = {f"{name}.Endpoints": f"tcp -h 127.0.0.1 -p {free_port()}" for name in ("Arm", "Hand")}
    return programs("Server").command(tmp_path, ports)


@BOTH
def test_a_signal_stops_it(server: list[str | Path], start: Start, number: int) -> None:
    running = start(server).wait_for("Server is running")
    assert running.stop(number) == 0
    assert "the process ends anyway" not in running.output, "at once: nothing holds it up"
    assert "terminate" not in running.output


@BOTH
def test_with_a_method_that_is_stuck(
    server: list[str | Path], start: Start, ice: Any, slices: None, number: int
) -> None:
    import RoboCompArm

    running = start(server).wait_for("Server is running")
    endpoint = Path(server[1]).read_text().partition("= ")[2].splitlines()[0]
    call = RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:{endpoint}")).blockAsync(60)
    running.wait_for("blocking")
    assert running.stop(number, within=2.0) == 0
    assert "WARNING stop: a method is still running after 1.5 s: the process ends anyway" in running.output
    assert call.exception(5) is not None


def test_many_signals(server: list[str | Path], start: Start) -> None:
    for _ in range(5):
        running = start(server).wait_for("Server is running")
        for _ in range(50):
            running.process.send_signal(signal.SIGTERM)
        assert running.exit_code(2) == 0


def test_start_and_stop_again_and_again(server: list[str | Path], start: Start) -> None:
    for _ in range(10):
        running = start([*server, "--startup-check"])
        assert running.exit_code() == 0
        assert "Server: the startup check has passed" in running.output


@pytest.fixture
def port(free_port: Ports) -> int:
    return free_port()


@pytest.fixture
def turns(programs: Programs, port: int, tmp_path: Path) -> list[str | Path]:
    """The command of a component whose worker prints each turn."""
    endpoint = f"tcp -h 127.0.0.1 -p {port}"
    return programs("Turns").command(
        tmp_path, {"CommonBehavior.Endpoints": endpoint, "Ice.Warn.Connections": 0, "a": 1}
    )


def rows(running: Running) -> list[tuple[int, int]]:
    """The number and the time of each turn so far."""
    lines = [line.split() for line in running.output.splitlines() if line.startswith("turn ")]
    return [(int(line[1]), int(line[2])) for line in lines if len(line) == 4]


def test_a_turn_every_period(turns: list[str | Path], start: Start) -> None:
    """A failure is logged, and the next turn follows; after a long turn, the following ones keep the old beat."""
    running = start(turns)
    until(lambda: len(rows(running)) > 20, "twenty turns")
    assert "ERROR Turns: compute() failed: the third one fails\n" in running.output
    moments = dict(rows(running))
    assert 3 not in moments
    assert moments[1] >= 39 and moments[6] - moments[5] >= 240
    assert moments[20] >= 20 * 40 + 5 * 40, "what was missed is left out"


def test_what_it_reports(turns: list[str | Path], start: Start, behavior: Ask, port: int) -> None:
    start(turns).wait_for("Turns is running")
    asked = behavior(port)
    assert str(asked.getState()) == "Running"
    assert asked.getPeriod() == 40
    first = asked.timeAwake()
    assert 0 <= first < PATIENCE * 1000
    until(lambda: asked.timeAwake() > first, "time to pass")
    parameters = asked.getParameterList()
    assert set(parameters) == {"CommonBehavior.Endpoints", "a", "period.compute", "period.emergency"}
    assert (parameters["a"].editable, parameters["a"].value, parameters["a"].type) == (False, "1", "string")


def test_what_it_accepts(turns: list[str | Path], start: Start, behavior: Ask, port: int) -> None:
    running = start(turns).wait_for("Turns is running")
    asked = behavior(port)
    asked.setPeriod(100_000)
    running.wait_for("INFO Turns: the period is 100000 ms now")
    asked.setPeriod(20)
    assert asked.getPeriod() == 20, "at once, even in the middle of a wait"
    seen = len(rows(running))
    until(lambda: len(rows(running)) > seen + 3, "turns")
    for wrong in (0, -5):
        asked.setPeriod(wrong)
        assert asked.getPeriod() == 20
        said = f"period.compute is {wrong} ms, and must be at least 1 ms"
        running.wait_for(f"WARNING Turns: setPeriod({wrong}) rejected: {said}")
    asked.setParameterList(asked.getParameterList())
    running.wait_for("INFO Turns: parameters changed by setParameterList: none")
    changed = asked.getParameterList()
    changed["a"].value, changed["period.compute"].value = "2", "99"
    asked.setParameterList(changed)
    running.wait_for("WARNING Turns: setParameterList rejected: unknown parameter 'a'")
    assert asked.getPeriod() == 20, "all, or none"
    config = Path(turns[1])
    config.write_text(config.read_text() + "period.compute = 30\n")
    asked.reloadConfig()
    assert asked.getPeriod() == 30
    running.wait_for("INFO Turns: config reloaded, the period is 30 ms")
    config.write_text("period.compute = soon\n")
    asked.reloadConfig()
    assert asked.getPeriod() == 30
    running.wait_for("WARNING Turns: reloadConfig rejected: ")
    running.wait_for("period.compute must be a whole number (ms), and is 'soon'")
    asked.killYourSelf()
    assert running.exit_code(2) == 0
    assert "INFO Turns: stop requested through CommonBehavior" in running.output


def test_it_responds_while_it_waits(
    programs: Programs, start: Start, behavior: Ask, port: int, free_port: Ports, tmp_path: Path
) -> None:
    nobody = f"hand:tcp -h 127.0.0.1 -p {free_port()}"
    endpoints = {"Arm.Endpoints": "tcp -h 127.0.0.1", "CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {port}"}
    waiting = start(programs("Mutual").command(tmp_path, {**endpoints, "HandProxy": nobody}))
    waiting.wait_for("waiting for Hand")
    assert str(behavior(port).getState()) == "Starting"
    behavior(port).killYourSelf()
    assert waiting.exit_code(2) == 0


def test_a_call_that_came_too_early(
    programs: Programs, start: Start, ice: Any, slices: None, free_port: Ports, tmp_path: Path
) -> None:
    """It waits until initialize() returns; if it never does, the call fails and does not delay the end."""
    import Ice
    import RoboCompArm

    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    properties = {"Arm.Endpoints": endpoint, "HandProxy": f"hand:tcp -h 127.0.0.1 -p {free_port()}"}
    waiting = start(programs("Mutual").command(tmp_path, properties)).wait_for("waiting for Hand")
    arm = RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:{endpoint}"))
    calls = [arm.moveAsync([], False) for _ in range(5)]
    arm.ice_ping()
    assert not any(call.done() for call in calls)
    assert waiting.stop(within=1.5) == 0
    for call in calls:
        assert isinstance(call.exception(5), Ice.UnknownException)


def test_ices_own_process_facet(server: list[str | Path], start: Start, ice: Any, free_port: Ports) -> None:
    """As IceGrid does."""
    import Ice

    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    running = start([*server, f"--Ice.Admin.Endpoints={endpoint}", "--Ice.Admin.InstanceName=it"])
    running.wait_for("Server is running")
    Ice.ProcessPrx.uncheckedCast(ice.stringToProxy(f"it/admin -f Process:{endpoint}")).shutdown()
    assert running.exit_code(2) == 0
