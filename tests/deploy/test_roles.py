"""Servers and tasks: what their ends mean, for `status`, `plan` and `up`, with real processes and both engines."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from conftest import write_tree
from processes import Ports, kill_left, until
from seen import status

Rcyaml = Callable[..., Result]

LISTEN = "import signal,socket,sys,time; s = socket.create_server(('127.0.0.1', int(sys.argv[1])))"
ORDERLY = f"{LISTEN}; signal.signal(signal.SIGTERM, lambda *_: sys.exit(0)); signal.pause()"


class Robot:
    def __init__(self, root: Path, rcyaml: Rcyaml, *options: str) -> None:
        self.root, self._rcyaml, self._options = root, rcyaml, options

    def write(self, *entries: str) -> None:
        text = "".join(f"  {entry}\n" for entry in entries)
        write_tree(self.root, {"robot.ddsl.yaml": f"deployment: Robot\ncomponents:\n{text}"})

    def deploy(self, what: str, *args: str, code: int = 0) -> str:
        result = self._rcyaml("deploy", what, "robot.ddsl.yaml", *self._options, *args)
        assert result.exit_code == code, result.output
        return result.output

    def of(self, name: str = "laser") -> dict[str, Any]:
        folder = f"{self.root}/.rcyaml/deployments/Robot"
        return status(self._rcyaml, folder, "robot.ddsl.yaml", *self._options)[name]

    def until(self, condition: Callable[[dict[str, Any]], bool], what: str) -> dict[str, Any]:
        def seen() -> dict[str, Any] | None:
            now = self.of()
            return now if condition(now) else None

        found: dict[str, Any] = until(seen, lambda: f"{what}: {self.of()}")
        return found


@pytest.fixture(params=["local", "icegrid"])
def robot(request: pytest.FixtureRequest, tmp_path: Path, rcyaml: Rcyaml) -> Iterator[Robot]:
    if request.param == "icegrid":
        pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    robot = Robot(tmp_path, rcyaml, "--engine", request.param)
    try:
        yield robot
        if Path(tmp_path, ".rcyaml").exists():
            robot.deploy("down")
    finally:
        kill_left(f"{tmp_path}/.rcyaml/deployments/Robot")


def laser(port: int, more: str = "") -> str:
    return f"laser: {{program: python3, args: [-c, {json.dumps(ORDERLY)}, '{port}'], endpoints: {{Laser: tcp -h 127.0.0.1 -p {port}}}{more}}}"


def test_a_server_that_exits_with_0_is_restarted(robot: Robot, free_port: Ports) -> None:
    robot.write(laser(free_port()))
    robot.deploy("up")
    before = robot.of()["pid"]
    os.kill(before, signal.SIGTERM)
    now = robot.until(lambda now: now["ready"] and now["pid"] != before, "it is back")
    assert (now["restarts"], now["last_exit"]) == (1, "exit code 0")
    robot.deploy("status")
    assert "nothing to do" in robot.deploy("plan")


def test_without_restarts_its_end_is_a_fault_that_the_next_up_repairs(robot: Robot, free_port: Ports) -> None:
    robot.write(laser(free_port(), ', restart: "no"'))
    robot.deploy("up")
    os.kill(robot.of()["pid"], signal.SIGTERM)
    robot.until(lambda now: now["state"] == "ended", "it has ended")
    assert "ended: exit code 0" in robot.deploy("status", code=1)
    assert "+ laser  start: it ended by itself: exit code 0\n" in robot.deploy("plan")
    assert "laser  ready" in robot.deploy("up")
    robot.deploy("status")


def test_a_task_is_done_with_exit_code_0_and_stays_so(robot: Robot, free_port: Ports) -> None:
    robot.write(laser(free_port(), ", role: task").replace("signal.pause()", "time.sleep(0.7)"))
    robot.deploy("up")
    robot.until(lambda now: now["state"] == "ended", "it is done")
    robot.deploy("status")
    assert "nothing to do" in robot.deploy("plan")
    assert "nothing to do, 1 process as desired" in robot.deploy("up")
    robot.write(laser(free_port(), ", role: server").replace("signal.pause()", "time.sleep(0.7)"))
    assert "it ended by itself: exit code 0" in robot.deploy("plan")


def test_a_program_can_be_a_server(robot: Robot) -> None:
    robot.write('laser: {program: sh, args: [-c, "sleep 1"], role: server, restart: "no"}')
    robot.deploy("up")
    robot.until(lambda now: now["state"] == "ended", "it has ended")
    robot.deploy("status", code=1)


def test_what_dies_again_and_again_is_unstable(robot: Robot) -> None:
    robot.write('laser: {program: sh, args: [-c, "sleep 2; exit 4"], restart: {tries: 100, delay: 1 ms}}')
    robot.deploy("up")
    robot.until(lambda now: now["state"] == "unstable", "after three ends")
    assert "unstable: exit code 4" in robot.deploy("status", code=1)
    robot.until(lambda now: now["state"] == "unstable" and now["pid"] > 0, "it runs for a moment")
    assert "error[RC7040]: 'laser' is unstable: it ends again and again" in robot.deploy("plan", code=1)


@pytest.mark.parametrize("lives", [0.3, 1.5])
def test_ready_within_3_seconds_is_not_fulfilled_by_what_dies_before(robot: Robot, lives: float) -> None:
    robot.write(f'laser: {{program: sh, args: [-c, "sleep {lives}; exit 4"], ready: 3 s, restart: {{delay: 3 s}}}}')
    assert "exit code 4" in robot.deploy("up", code=1)


def test_an_end_right_after_it_was_ready(robot: Robot) -> None:
    """The condition was fulfilled; but when `up` returns, nothing runs."""
    robot.write(
        'laser: {program: sh, args: [-c, "echo streams; sleep 0.3; exit 4"], ready: {log: streams}, restart: "no"}'
    )
    assert "error[RC7004]: 'laser' ended before" in robot.deploy("up", code=1)


def test_an_unstable_start_that_recovers_is_ready(robot: Robot) -> None:
    tried = robot.root / "tried"
    script = f"echo x >>{tried}; [ $(wc -l <{tried}) -gt 2 ] || exit 1; exec sleep 600"
    robot.write(f"laser: {{program: sh, args: [-c, {json.dumps(script)}], restart: {{delay: 10 ms}}}}")
    robot.deploy("up")
    assert robot.of()["restarts"] == 2
    robot.deploy("status")


def test_an_earlier_crash_is_not_why_a_process_is_not_ready_now(robot: Robot) -> None:
    write_tree(robot.root, {"ok": ""})
    script = json.dumps("test -e crashed || { touch crashed; sleep 1; exit 3; }; exec sleep 600")
    robot.write(
        f"laser: {{program: sh, args: [-c, {script}], role: server, ready: {{command: [test, -e, ok], within: 2 s}}}}"
    )
    robot.deploy("up")
    robot.until(lambda now: now["restarts"] == 1 and now["ready"], "it was restarted")
    (robot.root / "ok").unlink()
    why = "`test -e ok` did not succeed"
    assert f"running, not ready: {why}" in robot.deploy("status", code=1)
    assert f"'laser' was not ready within 2 s: {why}" in robot.deploy("up", code=1)
