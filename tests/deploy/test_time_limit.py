"""A time limit for the start of a whole network."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.carry_out import SKIPPED
from robocomp_yaml.deploy.engine import RUNNING
from robocomp_yaml.network.network import NEVER, EnvironmentVariable, Process, Readiness, RestartRule
from small_networks import Place, shell, sleeper

IN_VAIN = Readiness(log="never", within=600)
ENOUGH = 3  # seconds for all that does become ready, on a busy machine
SLOW = "trap 'sleep 3.5; exit 0' TERM; echo at work; while :; do sleep 0.05; done"


def codes(result: operations.Result) -> list[str]:
    return [found.code for found in result.diagnostics]


def waiting(name: str, *after: str) -> Process:
    return shell(name, "echo where is my motor; exec sleep 600", *after, ready=IN_VAIN)


def test_ready_and_pending_processes(place: Place) -> None:
    result = place.up(sleeper("a"), waiting("b"), waiting("c", "a"), sleeper("d", "b"), limit=ENOUGH)
    assert codes(result) == ["RC7011"]
    (late,) = result.diagnostics
    assert late.message == "the time limit of 3 s expired when 1 of 4 processes was ready"
    why = "was not ready within 3 s: no line of its log matches 'never'"
    assert [one.message for one in late.related] == [f"'b' {why}", f"'c' {why}"]
    lines = late.more.splitlines()
    assert lines[:3] == ["ready: a", "pending: b, c", "not started: d"]
    assert "b | where is my motor" in lines and "c | where is my motor" in lines
    assert place.order(SKIPPED) == ["d"]
    assert set(place.pids().values()) == {0}


def test_earlier_failures_are_reported_separately(place: Place) -> None:
    fails = shell("b", "echo no power; exit 3", restart=RestartRule(policy=NEVER))
    result = place.up(sleeper("a"), fails, waiting("c"), limit=ENOUGH, on_failure=operations.KEEP_GOING)
    assert codes(result) == ["RC7011", "RC7004"]
    late, failed = result.diagnostics
    assert late.more.splitlines()[:3] == ["ready: a", "pending: c", "failed: b"]
    assert "b | no power" in failed.more.splitlines() and "no power" not in late.more


def test_time_enough(place: Place) -> None:
    assert not place.up(sleeper("a"), sleeper("b", "a"), limit=600).diagnostics


def test_a_limit_that_expires_before_any_change(place: Place) -> None:
    result = place.up(sleeper("a"), limit=0)
    (found,) = result.diagnostics
    assert found.message == "the time limit of 0 s expired before anything was done"
    assert place.pids() == {}


def test_rollback_at_the_limit(place: Place) -> None:
    place.up(sleeper("a"), sleeper("b", "a"))
    before = place.pids()
    changed = sleeper("b", "a", env=(EnvironmentVariable("X", "1"),))
    result = place.up(sleeper("a"), changed, waiting("c", "b"), limit=ENOUGH, on_failure=operations.ROLL_BACK)
    assert codes(result) == ["RC7011"]
    after = place.observe()
    assert after["a"].pid == before["a"] and after["b"].state == RUNNING
    assert after["b"].spec and not after["b"].spec.process.env and "c" not in after


def test_keep_at_the_limit(place: Place) -> None:
    result = place.up(sleeper("a"), waiting("b", "a"), limit=ENOUGH, on_failure=operations.KEEP_GOING)
    assert codes(result) == ["RC7011"]
    assert {name: one.state for name, one in place.observe().items()} == {"a": RUNNING, "b": RUNNING}


@pytest.mark.parametrize("on_failure", [operations.STOP_THEM, operations.ROLL_BACK])
def test_the_limit_expires_while_processes_stop(place: Place, on_failure: str) -> None:
    """Nothing more is started. With rollback, what was stopped is started again."""
    slow = shell("a", SLOW, ready=Readiness(log="at work"))
    place.up(slow)
    result = place.up(shell("a", SLOW + " # new", ready=Readiness(log="at work")), limit=ENOUGH, on_failure=on_failure)
    assert codes(result) == ["RC7011"] and result.outcome.skipped == ["a"]
    assert result.undone == on_failure
    assert (place.observe()["a"].state == RUNNING) == (on_failure == operations.ROLL_BACK)


ROBOT = """\
deployment: Robot
components:
  base: {program: sleep, args: ["600"]}
"""
MORE = """\
  arm: {program: sh, args: [-c, "echo no motor; exec sleep 600"], after: [base], ready: {log: moves, within: 10 min}}
  hand: {program: sleep, args: ["600"], after: [arm]}
"""


@pytest.mark.parametrize("engine", ["local", "icegrid"])
def test_the_command(engine: str, place: Place, tmp_path: Path, rcyaml: Callable[..., Result]) -> None:
    if engine == "icegrid":
        pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
        if shutil.which("icegridnode") is None:
            pytest.skip("IceGrid is not installed (Debian: zeroc-icegrid)")

    def deploy(what: str, *args: str) -> Result:
        return rcyaml("deploy", what, "robot.ddsl.yaml", "--engine", engine, *args)

    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT})
    assert deploy("up", "--timeout", "2 min").exit_code == 0
    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT + MORE})
    result = deploy("up", "--timeout", "6s")
    assert result.exit_code == 1
    assert result.stdout.endswith("Robot: failed; the started processes were stopped\n")
    assert "error[RC7011]: the time limit of 6 s expired when 1 of 3 processes was ready" in result.stderr
    assert "    ready: base\n    pending: arm\n    not started: hand\n" in result.stderr
    assert "robot.ddsl.yaml:4:3" in result.stderr and "arm | no motor" in result.stderr
    states = [line.split()[1] for line in deploy("status").stdout.splitlines()[1:]]
    assert states[0] == "ready" and "running" not in states
    assert deploy("down").exit_code == 0
    place.wait_gone()


@pytest.mark.parametrize("time", ["60", "soon", "0s", "-1s"])
def test_a_time_has_a_unit(time: str, tmp_path: Path, rcyaml: Callable[..., Result]) -> None:
    write_tree(tmp_path, {"robot.ddsl.yaml": ROBOT})
    result = rcyaml("deploy", "up", "robot.ddsl.yaml", f"--timeout={time}")
    assert result.exit_code == 2 and f"'{time}' is not a duration, such as 30s or 2min" in result.stderr
