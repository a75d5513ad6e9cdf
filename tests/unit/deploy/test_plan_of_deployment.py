"""Plans of deployments, without real processes: what happens in which state, and in which order."""

from __future__ import annotations

import json

import pytest
from msgspec.structs import replace

from robocomp_yaml.deploy.carry_out import undo
from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, plan, with_dependents
from robocomp_yaml.deploy.spec import ProcessSpec, spec_of
from robocomp_yaml.network.network import (
    ALWAYS,
    ConfigFile,
    Endpoint,
    EnvironmentVariable,
    Network,
    NetworkHost,
    Process,
    Readiness,
    RestartRule,
)

A = Process(
    "a", "here", ("run", "{config}", "x"), "/", config=ConfigFile("config/a", "x=1\n"), env=(EnvironmentVariable("V", "1"),),
    endpoints=(Endpoint("Laser", "laser", 10003, "tcp -p 10003"),), ready=Readiness(pings=("laser:tcp -p 10003",)),
)  # fmt: skip
B = replace(A, name="b", after=("a",))


def network(*processes: Process) -> Network:
    found = Network("N", "/n.ddsl.yaml", "/folder", {"here": NetworkHost("here", "10.0.0.1")})
    enabled = tuple(process.name for process in processes if process.enabled)
    return replace(found, processes={process.name: process for process in processes}, order=(enabled,))


def spec(process: Process) -> ProcessSpec:
    return spec_of(network(process), process, {})


def running(process: Process, state: str = RUNNING) -> Running:
    return Running(process.name, spec(process), "here", state)


@pytest.mark.parametrize(
    ("state", "action"),
    [(RUNNING, KEEP), (ENDED, START), (WAITING, START), (GIVEN_UP, START), (STOPPED, START), (LOST, START)],
)
def test_an_unchanged_process(state: str, action: str) -> None:
    assert plan(network(A), {"a": running(A, state)}).steps["a"].action == action


def test_a_process_of_another_version_restarts() -> None:
    step = plan(network(A), {"a": Running("a", None, "here", RUNNING)}).steps["a"]
    assert (step.action, step.reason) == (RESTART, "another version of rcyaml started it")


@pytest.mark.parametrize(
    ("changed", "action", "said"),
    [
        (replace(A, command=("run", "fast")), RESTART, "command: run /folder/config/a x → run fast"),
        (replace(A, cwd="/tmp"), RESTART, "cwd: / → /tmp"),
        (replace(A, env=()), RESTART, "env V: 1 (gone)"),
        (replace(A, env=(EnvironmentVariable("V", ""),)), RESTART, "env V: 1 → ''"),
        (replace(A, env=(EnvironmentVariable("V", source="W"),)), RESTART, "env V: 1 → {env: W}"),
        (replace(A, config=None), RESTART, "command: run /folder/config/a x → run  x; config x: 1 (gone)"),
        (replace(A, config=ConfigFile("config/a", "# said\nx=1\n")), RESTART, "config changed"),
        (replace(A, ready=Readiness()), CHANGE, "ready.pings: laser:tcp -p 10003 (gone)"),
        (replace(A, ready=replace(A.ready, within=20)), CHANGE, "ready.within: 10 s → 20 s"),
        (replace(A, ready=replace(A.ready, log="up")), CHANGE, "ready.log: up (new)"),
        (
            replace(A, restart=RestartRule(ALWAYS, delay=1)),
            CHANGE,
            "restart.policy: on-failure → always; restart.delay: 0.1 s → 1 s",
        ),
        (replace(A, aliases=("c",)), CHANGE, "aliases: c (new)"),
        (replace(A, after=("c", "d"), groups=("g",)), CHANGE, "after: c, d (new); groups: g (new)"),
        (
            replace(
                A, endpoints=(replace(A.endpoints[0], text="tcp -p 10004"),), ready=Readiness(pings=("m:tcp -p 4",))
            ),
            CHANGE,
            "serves Laser: tcp -p 10003 → tcp -p 10004",
        ),
        (replace(A, endpoints=(replace(A.endpoints[0], module="M"),)), CHANGE, "endpoints changed"),
    ],
)
def test_a_changed_process(changed: Process, action: str, said: str) -> None:
    step = plan(network(changed), {"a": running(A)}).steps["a"]
    assert (step.action, "; ".join(map(str, step.changes))) == (action, said)


def test_a_moved_host_restarts() -> None:
    moved = network(A)
    moved.hosts["here"] = NetworkHost("here", "10.0.0.2")
    step = plan(moved, {"a": running(A)}).steps["a"]
    assert (step.action, step.reason) == (RESTART, "host: 10.0.0.1 → 10.0.0.2")


def test_a_named_process_includes_its_dependences_and_followers() -> None:
    plain = replace(B, name="c", is_ice=False)
    changed = replace(A, cwd="/tmp")
    now = {process.name: running(process) for process in (A, B, plain)}
    assert {step.name: step.action for step in plan(network(changed, B, plain), now, ["a"]).steps.values()} == {
        "a": RESTART, "c": RESTART,
    }  # fmt: skip
    assert set(plan(network(A, B), {}, ["b"]).steps) == {"a", "b"}
    assert with_dependents({"a": (), "b": ("a",), "c": ("b",), "d": ()}, ["a"]) == {"a", "b", "c"}


def test_undo_of_a_plan() -> None:
    changed, gone, new = replace(A, cwd="/tmp"), replace(A, name="gone"), replace(A, name="new")
    before = {process.name: running(process) for process in (A, B, gone)}
    done = plan(network(changed, B, new), before)
    now = {process.name: running(process) for process in (changed, B, new)}
    back = undo(done, before, now).steps
    assert {name: step.action for name, step in back.items()} == {"a": START, "gone": START, "new": STOP}
    assert back["a"].spec == before["a"].spec and back["gone"].spec == before["gone"].spec


def test_a_spec_survives_as_data() -> None:
    one = spec(replace(B, watched=("/etc/passwd", "/no/such"), groups=("g",), folders=("/f",)))
    assert ProcessSpec.of_data(json.loads(json.dumps(one.as_data()))) == one
    assert one.digests[0][1] and one.digests[1] == ("/no/such", "")


def test_data_of_another_version_is_rejected() -> None:
    data = spec(A).as_data()
    data["process"]["colour"] = "red"
    assert ProcessSpec.of_data(data) is None


def test_a_process_of_an_earlier_version_goes_on() -> None:
    """That version kept a field on which nothing depends that runs."""
    one = spec(B)
    data = json.loads(json.dumps(one.as_data()))
    data["process"]["explicit"] = ["base"]
    assert ProcessSpec.of_data(data) == one
