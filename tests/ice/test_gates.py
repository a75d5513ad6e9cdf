"""Gates of groups, over real Ice: calls pass, as many and such as the rules allow."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from deployments import deployed
from processes import Ports, Running, Start, until
from robocomp_yaml.network.network import CONFIG
from robocomp_yaml.pipeline import analyse


def encapsulated(text: str) -> bytes:
    """Parameters as Ice sends them: a gate does not look into them."""
    data = text.encode()
    return (6 + len(data)).to_bytes(4, "little") + b"\x01\x01" + data


@dataclass
class Member:
    """An object that echoes its parameters, and what it was called and when."""

    port: int
    calls: list[tuple[str, float]] = field(default_factory=list)


@dataclass
class Gate:
    """A running gate, and its object as a proxy of those outside."""

    running: Running
    proxy: Any

    def call(self, operation: str, text: str = "") -> tuple[bool, bytes]:
        import Ice

        return self.proxy.ice_invoke(operation, Ice.OperationMode.Normal, encapsulated(text))


@pytest.fixture
def member(ice: Any, free_port: Ports) -> Iterator[Member]:
    import Ice

    member = Member(free_port())

    class Echo(Ice.Blobject):
        def ice_invoke(self, data: bytes, current: Any) -> tuple[bool, bytes]:
            member.calls.append((current.operation, time.monotonic()))
            return True, data

    adapter = ice.createObjectAdapterWithEndpoints(f"Echo{member.port}", f"tcp -h 127.0.0.1 -p {member.port}")
    adapter.add(Echo(), Ice.stringToIdentity("mouth"))
    adapter.activate()
    yield member
    adapter.destroy()


@pytest.fixture
def gate(tmp_path: Path, ice: Any, start: Start, member: Member) -> Callable[[str], Gate]:
    """The gate of a group with a rule, in front of the echo."""

    def run(rule: str) -> Gate:
        import Ice

        write_tree(
            tmp_path,
            deployed(
                f"components: {{mouth: {{component: mouth, port: {member.port}}}}}\n"
                f"groups: {{face: {{components: [mouth], expose: {{Mouth: {{member: mouth, {rule}}}}}}}}}\n"
            ),
        )
        analysis = analyse([str(tmp_path / "robot.ddsl.yaml")])
        assert not analysis.diagnostics, analysis.diagnostics
        process = analysis.networks[os.path.realpath(tmp_path / "robot.ddsl.yaml")].processes["face.gate"]
        assert process.after == ("mouth",) and process.command == ("python3", CONFIG) and process.config
        program = tmp_path / "program"
        program.write_text(process.config.text, encoding="utf-8")
        running = start([sys.executable, program])
        proxy = ice.stringToProxy(f"mouth:{process.endpoints[0].text}")

        def answers() -> bool:
            try:
                proxy.ice_ping()
            except Ice.ConnectionRefusedException:
                return False
            return True

        until(answers, lambda: f"the gate:\n{running.output}")
        member.calls.clear()
        return Gate(running, proxy)

    return run


def test_calls_pass_with_all_that_they_carry(gate: Callable[[str], Gate], member: Member) -> None:
    assert gate("allow: [moveTo]").call("moveTo", "here") == (True, encapsulated("here"))
    assert [operation for operation, _ in member.calls] == ["moveTo"]


def test_what_is_not_allowed_does_not_pass(gate: Callable[[str], Gate], member: Member) -> None:
    import Ice

    running = gate("allow: []")
    with pytest.raises(Ice.UnknownException) as refused:
        running.call("moveTo")
    assert refused.value.unknown == "the group that serves Mouth allows nothing, not 'moveTo'"
    running.proxy.ice_ping()
    assert [operation for operation, _ in member.calls] == ["ice_ping"]


def test_a_rate_keeps_calls_apart(gate: Callable[[str], Gate], member: Member) -> None:
    running = gate("rate: 20")
    callers = [threading.Thread(target=running.call, args=("moveTo",)) for _ in range(6)]
    begin = time.monotonic()
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    times = [when for _, when in member.calls]
    assert len(times) == 6
    # a turn that came late does not let the next one come early
    assert max(times) - begin >= 5 / 20


def test_it_serves_nothing_else_and_ends_in_order(gate: Callable[[str], Gate]) -> None:
    import Ice

    running = gate("rate: 100")
    with pytest.raises(Ice.ObjectNotExistException):
        running.proxy.ice_identity(Ice.stringToIdentity("nobody")).ice_ping()
    assert running.running.stop() == 0
