"""Circles of processes that wait for each other: the first one is ready only when the others run."""

from __future__ import annotations

import time

from msgspec.structs import replace

from engine_in_memory import ASKED, InMemory, network, process, running
from robocomp_yaml.deploy.carry_out import GONE, READY, STARTING
from robocomp_yaml.deploy.circles import circles_of
from robocomp_yaml.deploy.engine import RUNNING
from robocomp_yaml.deploy.plan import START, plan
from robocomp_yaml.deploy.single import moved
from robocomp_yaml.network.network import Process

# The base waits for the arm, which is after the motors, which are after the base; the camera only looks at the base.
BASE, MOTORS = process("base", awaits=("arm",)), process("motors", "base")
ARM, CAMERA = process("arm", "motors"), process("camera", "base")
ALL = (BASE, MOTORS, ARM, CAMERA)


def robot(*now: Process, silent: str = "", ending: str = "") -> InMemory:
    engine = InMemory(*map(running, now), silent=silent, ending=ending)
    engine.needing = {"base": "arm"}
    return engine


def changed(one: Process) -> Process:
    return replace(one, cwd="/tmp")


def test_which_processes_are_in_a_circle() -> None:
    after = {one.name: one.after for one in ALL}
    found = circles_of(after, {"base": ("arm",)})
    assert found.of.keys() == {"base", "motors", "arm"} and found.awaited == {"base": ("arm",)}
    assert found.need_not_be_ready("base", "motors")
    assert not found.need_not_be_ready("base", "camera"), "it is outside"
    assert not found.need_not_be_ready("motors", "arm"), "motors do not wait for anybody"
    assert circles_of({**after, "arm": ()}, {"base": ("arm",)}).of == {}, "it waits for one that starts first"


def test_a_circle_comes_up_and_others_wait_until_its_first_one_is_ready() -> None:
    engine = robot()
    assert not engine.up(network(*ALL)).diagnostics
    events = [(event.name, event.kind) for event in engine.events]
    assert events.index(("motors", STARTING)) < events.index(("base", READY)) < events.index(("camera", STARTING))
    assert set(engine.states().values()) == {RUNNING}


def test_the_time_of_the_first_one_begins_when_the_others_are_ready() -> None:
    engine, answer, began = robot(), InMemory.run, time.monotonic()
    engine.run = lambda name, *how: answer(engine, "nobody" if time.monotonic() < began + 0.6 else name, *how)  # type: ignore[method-assign]
    served = (replace(one, ready=replace(ASKED, within=0.2 if one is BASE else 5.0)) for one in ALL)
    assert not engine.up(network(*served)).diagnostics


def test_one_of_the_circle_fails() -> None:
    engine = robot(silent="motors")
    result = engine.up(network(*ALL), keep_going=True)
    assert set(result.outcome.failed) == {"motors", "base"} and set(result.outcome.skipped) == {"arm", "camera"}


def test_the_first_of_the_circle_fails() -> None:
    result = robot(ending="base").up(network(*ALL), keep_going=True)
    assert list(result.outcome.failed) == ["base"] and set(result.outcome.skipped) == {"motors", "arm", "camera"}


def test_a_circle_restarts_together() -> None:
    engine = robot(*ALL)
    assert not engine.up(network(*map(changed, ALL))).diagnostics
    gone = [event.name for event in engine.events if event.kind == GONE]
    assert set(gone[:3]) == {"base", "motors", "arm"} and gone[3:] == ["camera"]


def test_only_one_of_the_circle_restarts() -> None:
    for one in (BASE, MOTORS, ARM):
        engine = robot(*ALL)
        result = engine.up(network(*(changed(other) if other is one else other for other in ALL)))
        assert not result.diagnostics and result.outcome.began == [one.name]


def test_a_name_of_the_circle_means_the_whole_circle() -> None:
    for name in ("base", "motors", "arm"):
        assert {step.name for step in plan(network(*ALL), {}, [name]).of(START)} == {"base", "motors", "arm"}


def test_what_is_beside_the_foreground_need_not_wait_for_it() -> None:
    beside = moved(network(*ALL), "/run", ["base", "motors"], "arm").processes
    assert not beside["base"].ready.has_condition and not beside["motors"].ready.has_condition
    beside = moved(network(*ALL), "/run", ["base", "motors", "arm"], "camera").processes
    assert all(one.ready == ASKED for one in beside.values())
