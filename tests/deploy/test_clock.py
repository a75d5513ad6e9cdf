"""The clock is set by hours while a network runs or comes up: only the times in its logs change."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from conftest import in_long, write_tree
from processes import Running, until
from seen import NEEDS_ICEGRID, agreed, states
from shifted_clock import Clock, make_clock
from small_networks import Place

COUNT = "i=0; while :; do i=$((i+1)); echo {} $i; sleep 0.05; done"
ROBOT = f"""\
deployment: Robot
components:
  one: {{program: sh, args: [-c, "{COUNT.format("tick")}"]}}
  two: {{program: sh, args: [-c, "{COUNT.format("tock")}"], after: [one]}}
"""
pytestmark = pytest.mark.slow
ENGINES = [
    "local",
    pytest.param("icegrid", marks=NEEDS_ICEGRID),
]  # fmt: skip


@dataclass
class Robot:
    """A deployment whose commands, engine and processes use the clock of the test."""

    folder: Path
    place: Place
    clock: Clock
    engine: str
    begun: list[Running] = field(default_factory=list)

    def deploy(self, what: str, *words: str, code: int | None = 0) -> str:
        """The output of a command, which must have this exit code, if it is not None."""
        done = subprocess.run(self._words(what, *words), capture_output=True, text=True, check=False, timeout=60,
                              cwd=self.folder, env={**os.environ, **self.clock.environment})  # fmt: skip
        assert code in (None, done.returncode), done.stdout + done.stderr
        return done.stdout + done.stderr

    def begin(self, what: str, *words: str) -> Running:
        """A command that runs in parallel with the test."""
        command = subprocess.Popen(
            self._words(what, *words), cwd=self.folder, env={**os.environ, **self.clock.environment},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
        self.begun.append(Running(command))
        return self.begun[-1]

    def _words(self, what: str, *words: str) -> list[str]:
        engine = ["--engine", self.engine]
        return [sys.executable, "-m", "robocomp_yaml", "deploy", what, "robot.ddsl.yaml", *engine, *words]

    def status(self) -> dict[str, Any]:
        """What rcyaml says, which /proc confirms."""

        def ask() -> dict[str, Any]:
            said = json.loads(self.deploy("status", "--format", "json", code=None))
            return {one["name"]: one for one in said["processes"]}

        return agreed(self.place.folder, ask, states)


@pytest.fixture(params=ENGINES)
def robot(request: pytest.FixtureRequest, place: Place, tmp_path: Path) -> Iterator[Robot]:
    if request.param == "icegrid":
        pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT})
    robot = Robot(tmp_path, place, make_clock(tmp_path), request.param)
    yield robot
    for command in robot.begun:
        command.end()


def numbers(text: str, word: str) -> list[int]:
    return [int(number) for number in re.findall(rf"{word} (\d+)$", text, re.MULTILINE)]


def test_the_clock_is_shifted(tmp_path: Path) -> None:
    """Otherwise the other tests would prove nothing."""
    clock = make_clock(tmp_path)
    clock.set(-7)
    script = 'printf "%(%s)T\n" -1; echo $EPOCHREALTIME; date +%s; "$0" -c "import time; print(time.time())"'
    environment = {**os.environ, **clock.environment, "LC_ALL": "C"}
    command = ["bash", "-c", script, sys.executable]
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    now = datetime.now(UTC).timestamp()
    assert [round((now - float(line)) / 3600, 1) for line in said.stdout.split()] == [7.0] * 4


@pytest.mark.parametrize("hours", [pytest.param(5, id="forward", marks=in_long), pytest.param(-7, id="back")])
def test_running_processes_go_on(robot: Robot, hours: int) -> None:
    robot.deploy("up")
    before = robot.status()
    followed = robot.begin("logs", "-f", "-t", "-n", "0")
    until(lambda: numbers(followed.output, "tick"), lambda: followed.output)
    robot.clock.set(hours)
    then = datetime.now(UTC) + timedelta(hours=hours)
    minutes = "|".join(f"{then + timedelta(minutes=minute):%Y-%m-%dT%H:%M}" for minute in range(3))
    until(lambda: re.search(f"^(?:{minutes}):.* tick", followed.output, re.MULTILINE), lambda: followed.output)

    after = robot.status()
    for name, one in after.items():
        assert one["ready"] and one["restarts"] == 0 and one["pid"] == before[name]["pid"]
        assert before[name]["uptime"] <= one["uptime"] < before[name]["uptime"] + 600
    assert "nothing to do" in robot.deploy("up")
    assert robot.deploy("logs", "-n", "3").count("tock") == 3

    os.kill(after["one"]["pid"], signal.SIGKILL)
    until(lambda: robot.status()["one"]["pid"] not in (0, after["one"]["pid"]), lambda: robot.deploy("logs"))
    assert robot.status()["one"]["uptime"] < 600
    robot.deploy("restart", "two")
    until(lambda: 1 in numbers(followed.output, "tock")[1:], lambda: followed.output)
    followed.stop(signal.SIGINT, within=20)
    seen = numbers(followed.output, "tock")
    first_run = seen[: seen.index(1, 1)]
    assert first_run == list(range(first_run[0], first_run[0] + len(first_run))), "no line is lost, doubled or moved"
    robot.deploy("down")
    robot.place.wait_gone()


CRASHES = """\
deployment: Robot
components:
  one:
    program: sh
    args: [-c, "echo here; while [ ! -e fail ]; do sleep 0.02; done; rm fail; exit 3"]
    ready: {log: here}
    restart: {policy: on-failure, tries: 2, delay: 0.1 s, within: 10 min}
"""


def test_a_crash_loop_ends(robot: Robot) -> None:
    """The clock is set between crashes: all crashes are counted, and the delays stay short."""
    write_tree(robot.folder, {"robot.ddsl.yaml": CRASHES})
    robot.deploy("up")
    for count in (1, 2, 3):
        (robot.folder / "fail").touch()
        until(lambda count=count: robot.deploy("logs").count("ended") == count, lambda: robot.deploy("logs"))
        robot.clock.set((5, -7)[count % 2])
        if count < 3:
            until(lambda count=count: robot.status()["one"]["restarts"] == count, lambda: robot.deploy("logs"))
    assert "given up: it ended 3 times within 600 s" in robot.deploy("logs")
    assert robot.status()["one"]["state"] == "given up"
    robot.deploy("down")


WAITS = """\
deployment: Robot
components:
  one:
    program: sh
    args: [-c, "echo here; while [ ! -e go ]; do sleep 0.02; done; echo ready; exec sleep 600"]
    ready: {log: ready, within: WITHIN}
  two: {program: sleep, args: ["600"], after: [one]}
"""


def test_a_starting_process_has_its_time(robot: Robot) -> None:
    write_tree(robot.folder, {"robot.ddsl.yaml": WAITS.replace("WITHIN", "2 min")})
    up = robot.begin("up", "--timeout", "3min")
    until(lambda: "here" in robot.deploy("logs", code=None), lambda: up.output)
    robot.clock.set(5)
    robot.deploy("logs")
    (robot.folder / "go").touch()
    assert up.exit_code() == 0, up.output
    robot.deploy("down")


def test_a_starting_process_has_no_more_than_its_time(robot: Robot) -> None:
    write_tree(robot.folder, {"robot.ddsl.yaml": WAITS.replace("WITHIN", "2 s")})
    up = robot.begin("up")
    until(lambda: "here" in robot.deploy("logs", code=None), lambda: up.output)
    robot.clock.set(-7)
    assert up.exit_code() == 1
    assert "error[RC7003]: 'one' was not ready within 2 s" in up.output


@pytest.mark.parametrize("robot", ENGINES[1:], indirect=True)
def test_a_newer_restart_rule_does_not_depend_on_the_clock(robot: Robot) -> None:
    """A change of `restart:` applies immediately, although the clock was set back before."""
    robot.deploy("up")
    pids = {name: one["pid"] for name, one in robot.status().items()}
    robot.clock.set(-7)
    write_tree(robot.folder, {"robot.ddsl.yaml": ROBOT.replace("after: [one]", 'after: [one], restart: "no"')})
    assert "two  restart" not in robot.deploy("up")
    assert {name: one["pid"] for name, one in robot.status().items()} == pids
    os.kill(pids["two"], signal.SIGKILL)
    until(lambda: robot.status()["two"]["state"] == "given up", lambda: robot.deploy("logs", "two", "-n", "4"))
    robot.deploy("down")


@pytest.mark.parametrize("year", [1970, pytest.param(2100, marks=in_long)])
def test_a_clock_that_is_wrong_from_the_start(robot: Robot, year: int) -> None:
    """As on a machine without a battery for its clock."""
    wrong = datetime(year, 1, 2, 12, tzinfo=UTC) - datetime.now(UTC)
    robot.clock.set(wrong.total_seconds() / 3600)
    robot.deploy("up")
    assert robot.deploy("logs", "-t", "-n", "1").startswith(f"{year}-01-02T")
    robot.clock.set(0)
    assert all(one["ready"] for one in robot.status().values())
    robot.deploy("down")
