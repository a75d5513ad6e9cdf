"""Whether a process is as desired: one table for exit codes, `status`, `plan` and `up`."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from engine_in_memory import network, process, running
from robocomp_yaml.deploy.operations import Status
from robocomp_yaml.deploy.plan import KEEP, START, plan, unhealthy
from robocomp_yaml.deploy.states import ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, fault, is_unstable, state_of
from robocomp_yaml.network.network import (
    ALWAYS,
    ICESTORM,
    NEVER,
    ON_FAILURE,
    PROGRAM,
    SERVER,
    TASK,
    Endpoint,
    Process,
    Readiness,
    RestartRule,
)

MOTORS = process("motors", role=SERVER)
SURVEY = process("survey", role=TASK)


@pytest.mark.parametrize(
    ("of", "state", "exit_", "is_as_desired"),
    [
        (MOTORS, RUNNING, "", True),
        (MOTORS, WAITING, "exit code 0", False),
        (MOTORS, GIVEN_UP, "exit code 0", False),
        (MOTORS, ENDED, "exit code 0", False),
        (MOTORS, STOPPED, "SIGTERM", True),
        (MOTORS, LOST, "", False),
        (SURVEY, RUNNING, "", True),
        (SURVEY, WAITING, "exit code 1", False),
        (SURVEY, GIVEN_UP, "exit code 1", False),
        (SURVEY, ENDED, "exit code 0", True),
        (SURVEY, STOPPED, "exit code 0", True),
        (SURVEY, LOST, "", False),
    ],
)
def test_status_and_plan_agree(of: Process, state: str, exit_: str, is_as_desired: bool) -> None:
    now = running(of, state, last_exit=exit_)
    assert bool(fault(now, is_server=of.is_server)) != is_as_desired
    assert Status(of.name, "", state == RUNNING, now, of.is_server).is_as_desired == is_as_desired
    step = plan(network(of), {of.name: now}).steps[of.name]
    assert step.action == (KEEP if is_as_desired and state != STOPPED else START)


def test_a_running_process_that_is_not_ready_is_not_as_desired() -> None:
    found = Status("motors", "", False, running(MOTORS), True)
    assert not found.is_as_desired and not found.is_down


@pytest.mark.parametrize(
    ("made", "is_server"),
    [
        (process("a"), True),  # a component
        (process("a", kind=ICESTORM), True),
        (process("a", kind=PROGRAM), False),
        (process("a", kind=PROGRAM, endpoints=(Endpoint("Laser", "laser", 1, "tcp -p 1"),)), True),
        (process("a", kind=PROGRAM, ready=Readiness(port=7)), True),
        (process("a", kind=PROGRAM, ready=Readiness(log="up")), False),
        (process("a", kind=PROGRAM, role=SERVER), True),
        (process("a", role=TASK), False),
    ],
)
def test_the_default_role(made: Process, is_server: bool) -> None:
    assert made.is_server == is_server


@pytest.mark.parametrize(
    ("role", "policy", "applied"),
    [
        (SERVER, ON_FAILURE, ALWAYS), (SERVER, NEVER, NEVER), (SERVER, ALWAYS, ALWAYS),
        (TASK, ON_FAILURE, ON_FAILURE), (TASK, NEVER, NEVER), (TASK, ALWAYS, ALWAYS),
    ],
)  # fmt: skip
def test_the_policy_that_engines_apply(role: str, policy: str, applied: str) -> None:
    assert process("a", role=role, restart=RestartRule(policy)).restart_policy == applied


@pytest.mark.parametrize(
    ("state", "spread", "uptime", "expected"),
    [
        (RUNNING, None, 0.1, False),
        (RUNNING, 8.0, 3.0, True),
        (RUNNING, 8.0, 9.0, False),
        (RUNNING, 0.4, 4.0, True),  # right after a crash loop
        (RUNNING, 0.4, 6.0, False),
        (RUNNING, 90.0, 1.0, False),
        (WAITING, 8.0, 9.0, True),
        (GIVEN_UP, 8.0, 1.0, False),
        (STOPPED, 8.0, 1.0, False),
    ],
)
def test_unstable(state: str, spread: float | None, uptime: float, expected: bool) -> None:
    now = replace(running(MOTORS, state, last_exit="SIGSEGV"), spread=spread, uptime=uptime)
    assert is_unstable(now) == expected == (state_of(now) == "unstable")


def test_a_plan_names_what_is_unstable_and_leaves_it() -> None:
    now = replace(running(MOTORS, last_exit="SIGSEGV"), spread=6.0, uptime=1.0)
    made = plan(network(MOTORS), {"motors": now})
    assert (made.steps["motors"].action, made.steps["motors"].reason) == (
        KEEP, "it ends again and again: SIGSEGV",
    )  # fmt: skip
    assert [one.code for one in unhealthy(made)] == ["RC7040"]
    assert not Status("motors", "", True, now, True).is_as_desired
