"""Samples of a network: rates are differences, and what is unknown is None."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import aclosing
from typing import Any

import pytest
from msgspec.structs import replace

from robocomp_yaml.deploy import sampling
from robocomp_yaml.deploy.engine import DeployFailed, Running
from robocomp_yaml.deploy.sampling import NetworkSample
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, Process
from robocomp_yaml.wire.introspection import Facts, Sections

ARM = Process("arm", "here", ("arm",), "/", introspection="commonbehavior:tcp -h here -p 1")
NETWORK = Network("Robot", "robot.ddsl.yaml", "", processes={"arm": ARM})
RUNNING = Running("arm", None, "here", "running", 7, 10.0, 0, "", 1000, 1.0)


class Engine:
    """Returns these states one after the other; a text is a failure, None that nothing runs."""

    name = "local"
    notes: tuple[Any, ...] = ()

    def __init__(self, states: list[Running | str | None]) -> None:
        self._states = states

    async def open(self, network: Network, *, create: bool) -> bool:
        return self._states[0] is not None or bool(self._states.pop(0))

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        state = self._states.pop(0)
        if isinstance(state, str):
            raise DeployFailed(deploying.FOLDER.at(Span("robot.ddsl.yaml"), path="folder", reason=state))
        return {"arm": state} if state else {}

    async def close(self, *, end: bool = False) -> None:
        pass


def says(uptime: float, turns: float = 0, heartbeat: float = 0, **counts: float) -> Sections:
    topics = [Facts("Joints", {"direction": "out", "topic": "robot/Joints"}, {"events": counts.get("events", 0)})]
    calls = [Facts("Arm.move", {}, {"calls": number, "exceptions": 1, "failures": 1, "mean": 0.5, "longest": 2})
             for name, number in counts.items() if name == "calls"]  # fmt: skip
    worker = {"period": 0.1, "achieved": 0.2, "turns": turns, "missed": 3, "heartbeat": heartbeat}
    return {
        "state": [Facts("Arm", {"state": "running"}, {"uptime": uptime})], "worker": [Facts("compute", {}, worker)],
        "calls": calls, "topics": topics,
    }  # fmt: skip


def sampled(
    monkeypatch: pytest.MonkeyPatch, states: list[Running | str | None], answers: list[Sections | None]
) -> list[NetworkSample]:
    async def sections(self: object, proxies: Mapping[str, str], within: float) -> dict[str, Sections]:
        answer = answers.pop(0) if proxies else None
        return dict.fromkeys(proxies, answer) if answer else {}

    async def main() -> list[NetworkSample]:
        found = []
        engine: Any = Engine(states)
        async with aclosing(sampling.samples(lambda: engine, NETWORK, (), 0.001)) as every:
            async for one in every:
                found.append(one)
                if not states:
                    break
        return found

    monkeypatch.setattr(sampling, "_MOMENT", 0)
    monkeypatch.setattr(sampling._Asked, "sections", sections)
    return asyncio.run(main())


def test_rates_are_differences(monkeypatch: pytest.MonkeyPatch) -> None:
    later = replace(RUNNING, cpu=1.0, uptime=12.0)
    first, second = sampled(
        monkeypatch, [RUNNING, later], [says(10, calls=4, events=100), says(12, calls=5, events=140)]
    )
    (before,), (now,) = first.processes, second.processes
    assert before.cpu is before.calls is before.messages is None, "nothing to compare with"
    assert (now.calls, now.messages, now.cpu) == (0.5, 20.0, 0.0)
    assert now.slowest and (now.slowest.method, now.slowest.failed, now.slowest.longest) == ("Arm.move", 2, 2)
    assert now.worker and (now.worker.period, now.worker.missed) == (0.1, 3)
    assert now.topics and now.topics[0].topic == "robot/Joints"


def test_a_method_that_was_never_called_before(monkeypatch: pytest.MonkeyPatch) -> None:
    _, second = sampled(monkeypatch, [RUNNING, RUNNING], [says(10), says(12, calls=3)])
    assert second.processes[0].calls == 1.5


def test_another_run_has_no_rates_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    again = replace(RUNNING, pid=8, cpu=0.1, restarts=1)
    _, second = sampled(monkeypatch, [RUNNING, again], [says(10, calls=4, events=9), says(1, calls=5, events=19)])
    (now,) = second.processes
    assert now.cpu is now.calls is now.messages is None and now.restarts == 1


def test_a_descendant_that_ended_takes_its_time_along(monkeypatch: pytest.MonkeyPatch) -> None:
    _, second = sampled(monkeypatch, [RUNNING, replace(RUNNING, cpu=0.4)], [None, None])
    assert second.processes[0].cpu is None


def test_what_is_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    far = replace(RUNNING, cpu=None, memory=None)
    _, second = sampled(monkeypatch, [far, far], [says(10), None])
    (now,) = second.processes
    assert now.is_component and now.worker is now.methods is now.topics is now.memory is now.cpu is None


def test_a_turn_that_does_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    (now,) = sampled(monkeypatch, [RUNNING], [says(10, heartbeat=5.0)])[0].processes
    assert now.worker and now.worker.achieved == 5.0


def test_an_engine_that_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is opened again; components are asked all the same, and nothing runs after it was taken down."""
    states: list[Running | str | None] = [RUNNING, "broken pipe", "it is locked", RUNNING, "gone", None]
    first, second, third, fourth = sampled(monkeypatch, states, [says(1), says(2), says(3)])
    assert not first.problem and "it is locked" in second.problem and not third.problem and not fourth.problem
    assert second.processes[0].state == "running" and second.processes[0].pid is None
    assert second.processes[0].worker and third.processes[0].pid == 7
    assert fourth.processes[0].state == "not started" and fourth.processes[0].worker is None


@pytest.mark.parametrize(
    ("running", "state", "is_fault"),
    [
        (replace(RUNNING, state="given up", pid=0, last_exit="exit code 3"), "given up: exit code 3", True),
        (replace(RUNNING, not_alive="it does not answer"), "not alive: it does not answer", True),
        (replace(RUNNING, state="lost", pid=0), "lost", True), (RUNNING, "running", False),
        (replace(RUNNING, state="stopped", pid=0, last_exit="SIGTERM"), "stopped: SIGTERM", False),
    ],
)  # fmt: skip
def test_states(monkeypatch: pytest.MonkeyPatch, running: Running, state: str, is_fault: bool) -> None:
    (now,) = sampled(monkeypatch, [running], [None])[0].processes
    assert (now.state, now.is_fault) == (state, is_fault)
