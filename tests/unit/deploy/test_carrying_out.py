"""Up, down and rollback: what happens, in which order, and what is unchanged after a failure."""

from __future__ import annotations

import asyncio

import pytest
from msgspec.structs import replace

from engine_in_memory import InMemory, network, process, running
from robocomp_yaml.deploy.carry_out import FAILED, GONE, READY, SKIPPED, STARTING, STOPPING, undo
from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, SHOWN_LINES, STOP_THEM, Status, end_if_idle, status
from robocomp_yaml.deploy.plan import CHANGE, START, STOP, plan, unhealthy
from robocomp_yaml.network.network import Readiness

MOTORS, BASE, ARM = process("motors"), process("base", "motors"), process("arm", "base")
CAMERA = process("camera")
ALL = (MOTORS, BASE, ARM, CAMERA)
STATES = (RUNNING, WAITING, GIVEN_UP, ENDED, STOPPED, LOST)


def happened(engine: InMemory) -> list[tuple[str, str]]:
    return [(event.name, event.kind) for event in engine.events]


# Bringing up


def test_each_process_starts_when_those_before_are_ready() -> None:
    engine = InMemory()
    result = engine.up(network(*ALL))
    assert not result.diagnostics and result.undone == ""
    assert engine.done[0] == "prepare motors camera base arm", "all at once, before anything starts"
    events = happened(engine)
    for name, before in (("base", "motors"), ("arm", "base")):
        assert events.index((before, READY)) < events.index((name, STARTING))
    assert result.outcome.began == ["motors", "camera", "base", "arm"]
    assert set(engine.states().values()) == {RUNNING}
    assert all(0 <= event.seconds < 60 for event in engine.events), "each says how long it took"


@pytest.mark.parametrize(("state", "how"), [(GIVEN_UP, "exit code 3"), (None, "it was stopped in the meantime")])
def test_a_process_that_ends_right_after_it_was_ready_has_failed(state: str | None, how: str) -> None:
    engine = InMemory()
    engine.brief["motors"] = state
    result = engine.up(network(replace(MOTORS, ready=Readiness(within=0.05, command=("ask",))), CAMERA))
    assert list(result.outcome.failed) == ["motors"]
    assert [(one.code, one.message) for one in result.diagnostics] == [
        ("RC7004", f"'motors' ended before it was ready: {how}")
    ]


@pytest.mark.parametrize("is_late", [False, True])
def test_an_end_before_this_up_is_not_why_a_process_is_not_ready(is_late: bool) -> None:
    """It was restarted, and has been ready since; what fails now is something else."""
    crashed = running(MOTORS, restarts=1, last_exit="exit code 3")
    asked = replace(MOTORS, ready=replace(MOTORS.ready, within=9 if is_late else 0.2))
    engine = InMemory(crashed, silent="motors")
    result = engine.up(network(asked), seconds=0.2 if is_late else None)
    assert result.outcome.failed["motors"].message == "'motors' was not ready within 0.2 s: `ask` did not succeed"
    engine = InMemory(crashed, silent="motors")
    engine.crashes = {"motors"}
    result = engine.up(network(asked), seconds=0.2 if is_late else None)
    assert "it ended in the meantime: exit code 4, after 1 restart" in result.outcome.failed["motors"].message


@pytest.mark.parametrize("is_late", [False, True])
@pytest.mark.parametrize(
    ("facts", "code"), [({"not_alive": "it is halted"}, "RC7042"), ({"spread": 20.0, "restarts": 3}, "RC7040")]
)
def test_what_no_step_helps_is_named_as_by_plan(facts: dict[str, object], code: str, is_late: bool) -> None:
    """Also if its condition does not hold either, which follows from that."""
    asked = replace(MOTORS, ready=replace(MOTORS.ready, within=9 if is_late else 0.2))
    engine = InMemory(running(asked, **facts), silent="motors")
    (planned,) = unhealthy(plan(network(asked), engine.now))
    failed = engine.up(network(asked), seconds=0.2 if is_late else None).outcome.failed["motors"]
    assert failed == planned and failed.code == code


def test_an_unchanged_process_goes_on() -> None:
    engine = InMemory(running(MOTORS), running(BASE))
    assert not engine.up(network(MOTORS, BASE)).diagnostics
    assert engine.done == [] and engine.events == []


def test_a_change_without_restart_is_applied_to_the_running_process() -> None:
    engine = InMemory(running(MOTORS))
    engine.up(network(replace(MOTORS, aliases=("m",))))
    assert engine.done == ["prepare motors"]


def test_a_restart_stops_prepares_and_starts() -> None:
    engine = InMemory(running(MOTORS))
    engine.up(network(replace(MOTORS, cwd="/tmp")))
    assert engine.done == ["stop motors", "stopped motors", "prepare motors", "start motors"]
    assert happened(engine) == [("motors", kind) for kind in (STOPPING, GONE, STARTING, READY)]


@pytest.mark.parametrize(("state", "is_stopped"), [(WAITING, True), (GIVEN_UP, False), (STOPPED, False), (LOST, False)])
def test_before_a_start_only_a_process_that_can_restart_by_itself_is_stopped(state: str, is_stopped: bool) -> None:
    engine = InMemory(running(MOTORS, state))
    engine.up(network(MOTORS))
    assert ("stop motors" in engine.done) == is_stopped and engine.done[-1] == "start motors"


def test_a_removed_process_is_stopped_and_forgotten() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA), running(ARM, STOPPED))
    engine.up(network(MOTORS))
    assert engine.done == ["stop camera", "stopped camera", "forget arm", "forget camera"]


def test_a_process_stops_before_those_that_it_is_after() -> None:
    engine = InMemory(*map(running, ALL))
    engine.up(network())
    done = [one for one in engine.done if one.startswith("stop")]
    assert done.index("stopped arm") < done.index("stop base")
    assert done.index("stopped base") < done.index("stop motors")
    assert set(happened(engine)) == {(one.name, kind) for one in ALL for kind in (STOPPING, GONE)}


# What fails


def test_after_a_failure_nothing_more_starts() -> None:
    engine = InMemory(ending="motors")
    result = engine.up(network(*ALL))
    assert list(result.outcome.failed) == ["motors"] and result.outcome.skipped == ["base", "arm"]
    (found,) = result.diagnostics
    assert (found.code, found.span.line) == (result.outcome.failed["motors"].code, len("motors"))
    assert "exit code 3" in found.message
    assert happened(engine)[-2:] == [("base", SKIPPED), ("arm", SKIPPED)]
    assert ("motors", FAILED) in happened(engine)


def test_the_last_lines_of_a_failed_process_are_shown() -> None:
    engine = InMemory(ending="motors")
    engine.logs["motors"] = [f"line {number}" for number in range(SHOWN_LINES + 5)]
    (found,) = engine.up(network(MOTORS)).diagnostics
    lines = found.more.splitlines()
    assert len(lines) == SHOWN_LINES and lines[-1] == f"motors | line {SHOWN_LINES + 4}"


def test_keep_going_skips_only_dependent_processes() -> None:
    engine = InMemory(ending="base")
    result = engine.up(network(*ALL), keep_going=True)
    assert (list(result.outcome.failed), result.outcome.skipped) == (["base"], ["arm"])
    assert (engine.states()["camera"], "arm" in engine.states()) == (RUNNING, False)
    assert result.undone == KEEP_GOING and not any(one.startswith("ask") for one in engine.done)


def test_a_process_after_a_skipped_one_is_skipped() -> None:
    result = InMemory(ending="motors").up(network(*ALL), keep_going=True)
    assert (result.outcome.began, result.outcome.skipped) == (["motors", "camera"], ["base", "arm"])


def test_a_process_starts_although_an_optional_one_failed() -> None:
    easy = replace(BASE, optional=("motors",))
    for after, skipped in ((BASE, ["base"]), (easy, [])):
        assert InMemory(ending="motors").up(network(MOTORS, after), keep_going=True).outcome.skipped == skipped


def test_a_process_that_never_becomes_ready_has_failed() -> None:
    engine = InMemory(silent="motors")
    quick = replace(MOTORS, ready=Readiness(within=0.05, command=("ask", "it")))
    (found,) = engine.up(network(quick, BASE)).diagnostics
    assert "0.05 s" in found.message and "`ask it` did not succeed" in found.message


def test_a_process_that_ran_before_and_is_not_ready_is_only_reported() -> None:
    engine = InMemory(running(replace(MOTORS, ready=Readiness(within=0.05, command=("ask",)))), silent="motors")
    result = engine.up(network(replace(MOTORS, ready=Readiness(within=0.05, command=("ask",))), CAMERA))
    assert list(result.outcome.failed) == ["motors"] and len(result.diagnostics) == 1
    assert engine.states() == {"motors": RUNNING, "camera": RUNNING}
    assert not any(one.startswith(("ask", "stop")) for one in engine.done)


@pytest.mark.parametrize(
    ("answer", "left"),
    [
        (STOP_THEM, {"motors": STOPPED, "camera": RUNNING}),
        (ROLL_BACK, {"camera": RUNNING}),
        (KEEP_GOING, {"motors": GIVEN_UP, "camera": RUNNING}),
    ],
)
def test_the_choice_decides_what_happens_after_a_failure(answer: str, left: dict[str, str]) -> None:
    engine = InMemory(running(CAMERA), ending="motors")
    result = engine.up(network(CAMERA, MOTORS, BASE), on_failure=answer)
    assert (result.undone, engine.states()) == (answer, left)
    assert engine.done.count("ask: motors") == 1


# What is in the way


def test_obstacles_are_reported_before_any_change() -> None:
    engine = InMemory(running(CAMERA), blocked="base")
    result = engine.up(network(MOTORS, BASE))
    assert [found.span.line for found in result.diagnostics] == [len("base")]
    assert engine.done == [] and result.undone == "" and result.outcome.began == []


def test_keep_going_skips_processes_with_obstacles_and_dependent_ones() -> None:
    engine = InMemory(blocked="base")
    result = engine.up(network(*ALL), keep_going=True)
    assert (list(result.outcome.failed), result.outcome.skipped) == (["base"], ["arm"])
    assert engine.states() == {"motors": RUNNING, "camera": RUNNING}
    assert engine.done[0] == "prepare motors camera arm"


def test_a_process_with_an_obstacle_to_its_restart_goes_on() -> None:
    class Blocking(InMemory):
        async def obstacles(self, specs, leaving):  # type: ignore[no-untyped-def]
            assert set(leaving) == {"motors"}
            return await super().obstacles(specs, ())

    engine = Blocking(running(MOTORS), blocked="motors")
    engine.up(network(replace(MOTORS, cwd="/tmp"), CAMERA), keep_going=True)
    assert engine.states() == {"motors": RUNNING, "camera": RUNNING} and "stop motors" not in engine.done


def test_a_process_that_stops_is_no_obstacle() -> None:
    assert not InMemory(running(MOTORS), blocked="motors").up(network(replace(MOTORS, cwd="/tmp"))).diagnostics


# The time


def test_a_limit_that_expires_before_any_change_changes_nothing() -> None:
    engine = InMemory()
    (found,) = engine.up(network(*ALL), seconds=0.0).diagnostics
    assert engine.done == [] and "before anything was done" in found.message


def test_neither_with_keep_going() -> None:
    engine = InMemory()
    assert len(engine.up(network(*ALL), seconds=0.0, keep_going=True).diagnostics) == 1 and engine.done == []


def test_an_expired_limit_reports_the_progress() -> None:
    engine = InMemory(running(CAMERA), silent="base")
    slow = replace(BASE, ready=Readiness(within=9.0, command=("ask",)))
    result = engine.up(network(MOTORS, slow, ARM, CAMERA), seconds=0.5, on_failure=STOP_THEM)
    outcome = result.outcome
    assert (outcome.is_late, outcome.late, outcome.skipped) == (True, ["base"], ["arm"])
    late, *others = result.diagnostics
    assert not others and "when 2 of 4 processes were ready" in late.message
    assert late.more.splitlines() == ["ready: motors, camera", "pending: base", "not started: arm"]
    assert [one.span.line for one in late.related] == [len("base")] and "within 0.5 s" in late.related[0].message
    assert result.undone == STOP_THEM and engine.states() == {"motors": STOPPED, "base": STOPPED, "camera": RUNNING}


def test_a_late_restart_counts_among_the_desired_processes() -> None:
    slow = replace(MOTORS, cwd="/tmp", ready=Readiness(within=9.0, command=("ask",)))
    engine = InMemory(running(MOTORS), running(CAMERA), running(ARM), silent="motors")
    (late,) = engine.up(network(slow, CAMERA, replace(ARM, after=(), aliases=("a",))), seconds=0.5).diagnostics
    assert "when 2 of 3 processes were ready" in late.message


# Rolling back


@pytest.mark.parametrize("state", STATES)
def test_a_rollback_starts_only_what_ran_before(state: str) -> None:
    before = {"motors": running(MOTORS, state)}
    done = plan(network(replace(MOTORS, cwd="/tmp")), before)
    back = undo(done, before, {"motors": running(replace(MOTORS, cwd="/tmp"))})
    if done.steps["motors"].action == "keep":
        assert back.steps == {}
    elif state in (RUNNING, WAITING):
        step = back.steps["motors"]
        assert (step.action, step.reason, step.spec) == (START, "it ran before", before["motors"].spec)
    else:
        step = back.steps["motors"]
        assert (step.action, step.reason, step.spec) == (STOP, "it did not run before", None)


def test_a_rollback_ignores_unchanged_processes() -> None:
    before = {"motors": running(MOTORS)}
    done = plan(network(MOTORS, CAMERA), before)
    now = before | {"camera": running(CAMERA)}
    (step,) = undo(done, before, now).steps.values()
    assert (step.name, step.action, step.running) == ("camera", STOP, now["camera"])
    assert undo(done, before, before).steps == {}, "it never came to be started"


def test_a_rollback_reverts_a_change_without_restart_without_restart() -> None:
    before = {"motors": running(MOTORS)}
    done = plan(network(replace(MOTORS, aliases=("m",))), before)
    step = undo(done, before, before).steps["motors"]
    assert (step.action, step.spec, step.running) == (CHANGE, before["motors"].spec, before["motors"])


def test_a_rollback_restores_the_state_before() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA), running(ARM, STOPPED), ending="base")
    wanted = network(replace(MOTORS, cwd="/tmp"), BASE, CAMERA)
    result = engine.up(wanted, on_failure=ROLL_BACK)
    assert result.undone == ROLL_BACK
    assert engine.now["motors"].spec == running(MOTORS).spec and engine.states() == {
        "motors": RUNNING, "camera": RUNNING,
    }  # fmt: skip


def test_a_failed_rollback_is_reported_at_the_location_in_the_document() -> None:
    engine = InMemory(running(MOTORS), ending="motors")
    result = engine.up(network(replace(MOTORS, cwd="/tmp")), on_failure=ROLL_BACK)
    assert [found.span.line for found in result.diagnostics] == [len("motors")] * 2
    assert result.not_restored == ["motors"]
    gone = InMemory(running(MOTORS), running(CAMERA), ending="motors arm")
    told = gone.up(network(ARM, CAMERA), on_failure=ROLL_BACK).diagnostics
    assert [(found.span.file, found.span.line) for found in told] == [("n.ddsl.yaml", 3), ("/n.ddsl.yaml", 1)]


# Taking down, and how it is


@pytest.mark.parametrize(
    ("names", "stopped"),
    [((), "motors base arm camera"), (("base",), "base arm"), (("arm", "camera"), "arm camera")],
)
def test_down_includes_dependent_processes(names: tuple[str, ...], stopped: str) -> None:
    engine = InMemory(*map(running, ALL))
    assert sorted(engine.down(*names)) == sorted(stopped.split())
    assert set(engine.states()) == {one.name for one in ALL} - set(stopped.split())
    assert engine.done[-1] == ("close" if names else "end"), "the engine ends with the last of them"


def test_down_returns_what_ran() -> None:
    engine = InMemory(running(MOTORS), running(BASE, WAITING), running(ARM, GIVEN_UP), running(CAMERA, LOST))
    assert engine.down() == ["base", "motors"], "in the order in which they stop"
    assert {one for one in engine.done if one.startswith("stop ")} == {"stop motors", "stop base", "stop arm"}
    assert set(happened(engine)) == {(name, kind) for name in ("motors", "base") for kind in (STOPPING, GONE)}


def test_down_with_names_of_processes_that_do_not_run() -> None:
    engine = InMemory(running(MOTORS))
    assert engine.down("camera") == [] and engine.states() == {"motors": RUNNING}


def test_down_includes_a_process_of_another_version() -> None:
    engine = InMemory(Running("motors", None, "", RUNNING), running(BASE))
    assert engine.down("motors") == ["base", "motors"]


@pytest.mark.parametrize(
    ("state", "ends"),
    [(RUNNING, False), (WAITING, False), (LOST, False), (STOPPED, True), (GIVEN_UP, True), (ENDED, True)],
)
def test_an_engine_without_processes_ends(state: str, ends: bool) -> None:
    engine = InMemory(running(MOTORS, state), running(CAMERA, STOPPED))
    asyncio.run(end_if_idle(engine, "/no/folder"))
    assert engine.done == ["end" if ends else "close"]


def look(engine: InMemory, wanted: object, *names: str, reached: bool = True) -> list[Status]:
    return asyncio.run(status(engine, wanted, names, reached))  # type: ignore[arg-type]


def test_status() -> None:
    spare, gone = process("spare", enabled=False), process("gone")
    engine = InMemory(running(gone), running(MOTORS), running(BASE, GIVEN_UP), running(spare), silent="gone")
    found = look(engine, network(MOTORS, BASE, CAMERA, spare))
    assert [(one.name, one.state, one.is_ready, one.is_down) for one in found] == [
        ("motors", RUNNING, True, False),
        ("base", GIVEN_UP, False, True),
        ("camera", STOPPED, False, False),
        ("gone", RUNNING, False, False),
        ("spare", RUNNING, True, False),
    ]
    assert {one.host for one in found} == {MOTORS.host}


def test_status_of_some_and_without_an_engine() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA))
    assert [one.name for one in look(engine, network(MOTORS, BASE, CAMERA), "camera", "base")] == ["base", "camera"]
    assert [(one.name, one.state) for one in look(engine, network(MOTORS), reached=False)] == [("motors", STOPPED)]


@pytest.mark.parametrize("state", STATES)
def test_a_process_that_should_run_and_does_not_is_down(state: str) -> None:
    assert Status("motors", "", False, running(MOTORS, state)).is_down == (state in (WAITING, GIVEN_UP, LOST))
    assert not Status("motors", "", False).is_down
