"""Bringing up, taking down and rolling back: what is done, in which order, and what is left alone where something fails."""

from __future__ import annotations

import asyncio

import pytest
from msgspec.structs import replace

from engine_in_memory import InMemory, network, process, running
from robocomp_yaml.deploy.carry_out import FAILED, GONE, READY, SKIPPED, STARTING, STOPPING, undo
from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, SHOWN_LINES, STOP_THEM, Status, end_if_idle, status
from robocomp_yaml.deploy.plan import CHANGE, START, STOP, plan
from robocomp_yaml.network.network import Readiness

MOTORS, BASE, ARM = process("motors"), process("base", "motors"), process("arm", "base")
CAMERA = process("camera")
ALL = (MOTORS, BASE, ARM, CAMERA)
STATES = (RUNNING, WAITING, GIVEN_UP, ENDED, STOPPED, LOST)


def happened(engine: InMemory) -> list[tuple[str, str]]:
    return [(event.name, event.kind) for event in engine.events]


# Bringing up


def test_each_starts_when_what_it_is_after_is_ready() -> None:
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


def test_what_runs_and_is_wanted_as_it_is_is_left_alone() -> None:
    engine = InMemory(running(MOTORS), running(BASE))
    assert not engine.up(network(MOTORS, BASE)).diagnostics
    assert engine.done == [] and engine.events == []


def test_what_changes_without_a_restart_is_taken_over_by_what_runs() -> None:
    engine = InMemory(running(MOTORS))
    engine.up(network(replace(MOTORS, aliases=("m",))))
    assert engine.done == ["prepare motors"]


def test_a_restart_stops_first_and_the_new_one_is_prepared_before_it_starts() -> None:
    engine = InMemory(running(MOTORS))
    engine.up(network(replace(MOTORS, cwd="/tmp")))
    assert engine.done == ["stop motors", "stopped motors", "prepare motors", "start motors"]
    assert happened(engine) == [("motors", kind) for kind in (STOPPING, GONE, STARTING, READY)]


@pytest.mark.parametrize(("state", "is_stopped"), [(WAITING, True), (GIVEN_UP, False), (STOPPED, False), (LOST, False)])
def test_before_a_start_only_what_may_come_back_by_itself_is_stopped(state: str, is_stopped: bool) -> None:
    engine = InMemory(running(MOTORS, state))
    engine.up(network(MOTORS))
    assert ("stop motors" in engine.done) == is_stopped and engine.done[-1] == "start motors"


def test_what_is_gone_from_the_document_is_stopped_and_forgotten() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA), running(ARM, STOPPED))
    engine.up(network(MOTORS))
    assert engine.done == ["stop camera", "stopped camera", "forget arm", "forget camera"]


def test_users_stop_before_what_they_use() -> None:
    engine = InMemory(*map(running, ALL))
    engine.up(network())
    done = [one for one in engine.done if one.startswith("stop")]
    assert done.index("stopped arm") < done.index("stop base")
    assert done.index("stopped base") < done.index("stop motors")
    assert set(happened(engine)) == {(one.name, kind) for one in ALL for kind in (STOPPING, GONE)}


# What fails


def test_where_one_fails_nothing_more_starts() -> None:
    engine = InMemory(ending="motors")
    result = engine.up(network(*ALL))
    assert list(result.outcome.failed) == ["motors"] and result.outcome.skipped == ["base", "arm"]
    (found,) = result.diagnostics
    assert (found.code, found.span.line) == (result.outcome.failed["motors"].code, len("motors"))
    assert "exit code 3" in found.message
    assert happened(engine)[-2:] == [("base", SKIPPED), ("arm", SKIPPED)]
    assert ("motors", FAILED) in happened(engine)


def test_its_last_lines_are_shown_with_it() -> None:
    engine = InMemory(ending="motors")
    engine.logs["motors"] = [f"line {number}" for number in range(SHOWN_LINES + 5)]
    (found,) = engine.up(network(MOTORS)).diagnostics
    lines = found.more.splitlines()
    assert len(lines) == SHOWN_LINES and lines[-1] == f"motors | line {SHOWN_LINES + 4}"


def test_going_on_leaves_out_only_what_needs_it() -> None:
    engine = InMemory(ending="base")
    result = engine.up(network(*ALL), keep_going=True)
    assert (list(result.outcome.failed), result.outcome.skipped) == (["base"], ["arm"])
    assert (engine.states()["camera"], "arm" in engine.states()) == (RUNNING, False)
    assert result.undone == KEEP_GOING and not any(one.startswith("ask") for one in engine.done)


def test_what_is_after_what_was_skipped_is_skipped_too() -> None:
    result = InMemory(ending="motors").up(network(*ALL), keep_going=True)
    assert (result.outcome.began, result.outcome.skipped) == (["motors", "camera"], ["base", "arm"])


def test_one_that_can_do_without_starts_all_the_same() -> None:
    easy = replace(BASE, optional=("motors",))
    for after, skipped in ((BASE, ["base"]), (easy, [])):
        assert InMemory(ending="motors").up(network(MOTORS, after), keep_going=True).outcome.skipped == skipped


def test_one_that_never_becomes_ready_has_failed() -> None:
    engine = InMemory(silent="motors")
    quick = replace(MOTORS, ready=Readiness(within=0.05, command=("ask", "it")))
    (found,) = engine.up(network(quick, BASE)).diagnostics
    assert "0.05 s" in found.message and "`ask it` did not succeed" in found.message


def test_one_that_ran_already_and_is_not_ready_is_only_reported() -> None:
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
def test_whoever_is_asked_decides_what_becomes_of_it(answer: str, left: dict[str, str]) -> None:
    engine = InMemory(running(CAMERA), ending="motors")
    result = engine.up(network(CAMERA, MOTORS, BASE), on_failure=answer)
    assert (result.undone, engine.states()) == (answer, left)
    assert engine.done.count("ask: motors") == 1


# What is in the way


def test_what_is_in_the_way_is_seen_before_anything_is_touched() -> None:
    engine = InMemory(running(CAMERA), blocked="base")
    result = engine.up(network(MOTORS, BASE))
    assert [found.span.line for found in result.diagnostics] == [len("base")]
    assert engine.done == [] and result.undone == "" and result.outcome.began == []


def test_going_on_starts_all_but_what_is_in_the_way_and_what_needs_it() -> None:
    engine = InMemory(blocked="base")
    result = engine.up(network(*ALL), keep_going=True)
    assert (list(result.outcome.failed), result.outcome.skipped) == (["base"], ["arm"])
    assert engine.states() == {"motors": RUNNING, "camera": RUNNING}
    assert engine.done[0] == "prepare motors camera arm"


def test_one_that_is_in_the_way_of_its_own_restart_goes_on_running() -> None:
    class Blocking(InMemory):
        async def obstacles(self, specs, leaving):  # type: ignore[no-untyped-def]
            assert set(leaving) == {"motors"}
            return await super().obstacles(specs, ())

    engine = Blocking(running(MOTORS), blocked="motors")
    engine.up(network(replace(MOTORS, cwd="/tmp"), CAMERA), keep_going=True)
    assert engine.states() == {"motors": RUNNING, "camera": RUNNING} and "stop motors" not in engine.done


def test_what_stops_before_is_in_nobodys_way() -> None:
    assert not InMemory(running(MOTORS), blocked="motors").up(network(replace(MOTORS, cwd="/tmp"))).diagnostics


# The time


def test_when_the_time_is_over_before_anything_is_done_nothing_is() -> None:
    engine = InMemory()
    (found,) = engine.up(network(*ALL), seconds=0.0).diagnostics
    assert engine.done == [] and "before anything was done" in found.message


def test_with_going_on_neither() -> None:
    engine = InMemory()
    assert len(engine.up(network(*ALL), seconds=0.0, keep_going=True).diagnostics) == 1 and engine.done == []


def test_when_the_time_is_over_it_says_how_far_it_came() -> None:
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


def test_a_restart_that_is_late_counts_among_what_was_wanted() -> None:
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


def test_a_rollback_leaves_alone_what_was_not_touched() -> None:
    before = {"motors": running(MOTORS)}
    done = plan(network(MOTORS, CAMERA), before)
    now = before | {"camera": running(CAMERA)}
    assert {name: step.action for name, step in undo(done, before, now).steps.items()} == {"camera": STOP}
    assert undo(done, before, before).steps == {}, "it never came to be started"


def test_a_rollback_gives_back_without_a_restart_what_was_changed_without_one() -> None:
    before = {"motors": running(MOTORS)}
    done = plan(network(replace(MOTORS, aliases=("m",))), before)
    step = undo(done, before, before).steps["motors"]
    assert (step.action, step.spec, step.running) == (CHANGE, before["motors"].spec, before["motors"])


def test_after_a_rollback_all_is_as_it_was() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA), running(ARM, STOPPED), ending="base")
    wanted = network(replace(MOTORS, cwd="/tmp"), BASE, CAMERA)
    result = engine.up(wanted, on_failure=ROLL_BACK)
    assert result.undone == ROLL_BACK
    assert engine.now["motors"].spec == running(MOTORS).spec and engine.states() == {
        "motors": RUNNING, "camera": RUNNING,
    }  # fmt: skip


def test_what_does_not_come_back_is_reported_where_it_stands_in_the_document() -> None:
    engine = InMemory(running(MOTORS), ending="motors")
    result = engine.up(network(replace(MOTORS, cwd="/tmp")), on_failure=ROLL_BACK)
    assert [found.span.line for found in result.diagnostics] == [len("motors")] * 2
    gone = InMemory(running(MOTORS), running(CAMERA), ending="motors arm")
    told = gone.up(network(ARM, CAMERA), on_failure=ROLL_BACK).diagnostics
    assert [(found.span.file, found.span.line) for found in told] == [("n.ddsl.yaml", 3), ("/n.ddsl.yaml", 1)]


# Taking down, and how it is


@pytest.mark.parametrize(
    ("names", "stopped"),
    [((), "motors base arm camera"), (("base",), "base arm"), (("arm", "camera"), "arm camera")],
)
def test_down_takes_what_is_after_along(names: tuple[str, ...], stopped: str) -> None:
    engine = InMemory(*map(running, ALL))
    assert sorted(engine.down(*names)) == sorted(stopped.split())
    assert set(engine.states()) == {one.name for one in ALL} - set(stopped.split())
    assert engine.done[-1] == ("close" if names else "end"), "the engine ends with the last of them"


def test_down_says_what_was_alive() -> None:
    engine = InMemory(running(MOTORS), running(BASE, WAITING), running(ARM, GIVEN_UP), running(CAMERA, LOST))
    assert engine.down() == ["motors", "base"]
    assert {one for one in engine.done if one.startswith("stop ")} == {"stop motors", "stop base", "stop arm"}
    assert set(happened(engine)) == {(name, kind) for name in ("motors", "base") for kind in (STOPPING, GONE)}


def test_down_with_names_of_nothing_that_runs() -> None:
    engine = InMemory(running(MOTORS))
    assert engine.down("camera") == [] and engine.states() == {"motors": RUNNING}


def test_one_that_another_version_started_is_taken_down_too() -> None:
    engine = InMemory(Running("motors", None, "", RUNNING), running(BASE))
    assert engine.down("motors") == ["motors", "base"]


@pytest.mark.parametrize(
    ("state", "ends"),
    [(RUNNING, False), (WAITING, False), (LOST, False), (STOPPED, True), (GIVEN_UP, True), (ENDED, True)],
)
def test_an_engine_with_nothing_left_to_run_ends(state: str, ends: bool) -> None:
    engine = InMemory(running(MOTORS, state), running(CAMERA, STOPPED))
    asyncio.run(end_if_idle(engine))
    assert engine.done == ["end" if ends else "close"]


def look(engine: InMemory, wanted: object, *names: str, reached: bool = True) -> list[Status]:
    return asyncio.run(status(engine, wanted, names, reached))  # type: ignore[arg-type]


def test_how_the_processes_are() -> None:
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


def test_how_some_are_and_how_all_are_where_nothing_runs() -> None:
    engine = InMemory(running(MOTORS), running(CAMERA))
    assert [one.name for one in look(engine, network(MOTORS, BASE, CAMERA), "camera", "base")] == ["base", "camera"]
    assert [(one.name, one.state) for one in look(engine, network(MOTORS), reached=False)] == [("motors", STOPPED)]


@pytest.mark.parametrize("state", STATES)
def test_what_should_run_and_does_not_is_down(state: str) -> None:
    assert Status("motors", "", False, running(MOTORS, state)).is_down == (state in (WAITING, GIVEN_UP, LOST))
    assert not Status("motors", "", False).is_down
