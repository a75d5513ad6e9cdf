"""The order of restarts: one level at a time, unless a process is in the way of another."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from engine_in_memory import InMemory, network, process, running
from robocomp_yaml.deploy.carry_out import GONE, READY, UNCHANGED
from robocomp_yaml.deploy.engine import RUNNING, Running
from robocomp_yaml.deploy.levels import in_the_way, levels
from robocomp_yaml.deploy.operations import ROLL_BACK, STOP_THEM
from robocomp_yaml.deploy.plan import plan
from robocomp_yaml.network.network import Endpoint, Process

BASE, LASER = process("base"), process("laser")
ARM, HAND = process("arm", "base", "laser"), process("hand", "arm")
ALL = (BASE, LASER, ARM, HAND)


def changed(one: Process) -> Process:
    return replace(one, cwd="/tmp")


def at(one: Process, port: int) -> Process:
    return replace(one, cwd=f"/{port}", endpoints=(Endpoint("X", "x", port, f"tcp -p {port}"),))


def test_one_level_is_down_at_a_time() -> None:
    engine = InMemory(*map(running, ALL))
    assert not engine.up(network(*map(changed, ALL))).diagnostics
    kept = [(event.name, event.kind) for event in engine.events if event.kind in (GONE, READY)]
    assert sorted(kept[:4]) == sorted((name, kind) for name in ("base", "laser") for kind in (GONE, READY))
    assert kept[4:] == [("arm", GONE), ("arm", READY), ("hand", GONE), ("hand", READY)]
    assert [one for one in engine.done if one.startswith("prepare")] == [
        "prepare base laser",
        "prepare arm",
        "prepare hand",
    ]


def test_unrelated_processes_wait_for_the_earlier_level_too() -> None:
    engine = InMemory(*map(running, (BASE, ARM, LASER, HAND)))
    engine.up(network(changed(BASE), LASER, ARM, changed(HAND)))
    kept = [(event.name, event.kind) for event in engine.events if event.kind in (GONE, READY)]
    assert kept == [("base", GONE), ("base", READY), ("hand", GONE), ("hand", READY)]


@pytest.mark.parametrize("undone", [STOP_THEM, ROLL_BACK])
def test_after_a_failed_level_the_next_ones_go_on_as_they_were(undone: str) -> None:
    engine = InMemory(*map(running, ALL), ending="base")
    result = engine.up(network(*map(changed, ALL)), on_failure=undone)
    assert list(result.outcome.failed) == ["base"] and result.outcome.skipped == ["arm", "hand"]
    assert {event.name for event in engine.events if event.kind == UNCHANGED} == {"arm", "hand"}
    assert not any("arm" in one or "hand" in one for one in engine.done if one.startswith(("stop", "start")))
    assert engine.states()["hand"] == RUNNING and engine.now["hand"].spec == running(HAND).spec


def test_with_keep_only_what_needs_the_failed_one_is_left() -> None:
    camera = process("camera", "laser")
    engine = InMemory(*map(running, (*ALL, camera)), ending="base")
    result = engine.up(network(*map(changed, (*ALL, camera))), keep_going=True)
    assert result.outcome.skipped == ["arm", "hand"] and "start camera" in engine.done
    assert engine.now["arm"].spec == running(ARM).spec


def test_processes_in_a_circle_restart() -> None:
    one, two = process("one", "two"), process("two", "one")
    engine = InMemory(running(one), running(two))
    result = engine.up(network(changed(one), changed(two)))
    assert not result.diagnostics and set(result.outcome.began) == {"one", "two"}


def test_a_process_stops_first_if_another_one_gets_its_port() -> None:
    before = [running(at(BASE, 1)), running(at(ARM, 2))]
    engine = InMemory(*before)
    wanted = network(at(BASE, 2), at(replace(ARM, after=("base",)), 1))
    assert in_the_way(plan(wanted, {one.name: one for one in before})) == {"base", "arm"}
    engine.up(wanted)
    assert engine.done.index("stopped arm") < engine.done.index("start base")
    # A new process needs the port of one that restarts.
    made = plan(network(at(LASER, 1), at(BASE, 3)), {"base": before[0]})
    assert in_the_way(made) == {"base"} and levels(made, {"base"}) == []


def test_a_process_of_another_version_stops_first() -> None:
    made = plan(network(BASE), {"base": Running("base", None, "", RUNNING)})
    assert in_the_way(made) == {"base"}


def test_all_configurations_are_staged_before_anything_stops() -> None:
    engine = InMemory(*map(running, ALL))

    async def stage(specs: object) -> None:
        assert engine.done == []
        raise OSError(28, "full")

    engine.stage = stage  # type: ignore[method-assign, assignment]
    with pytest.raises(OSError, match="full"):
        engine.up(network(*map(changed, ALL)))
    assert engine.done == [] and engine.events == []
