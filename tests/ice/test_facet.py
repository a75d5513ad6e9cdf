"""What components say of themselves, in every language alike: while they wait, start, run, hang, and stop."""

from __future__ import annotations

import asyncio
import os
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from components import build
from cpp_programs import FAST, cmake, locked, needs_cpp
from facet_sources import DOCUMENTS, FILES, PERIOD
from java_programs import java_build, needs_java
from processes import Ports, Running, Start, Storm, until
from robocomp_yaml.deploy import ice_call, introspection
from robocomp_yaml.deploy.ice_call import IceCall
from robocomp_yaml.wire import introspection as wire
from robocomp_yaml.wire.introspection import Facts, Sections
from robocomp_yaml.wire.protocol import OK

LANGUAGES = [
    pytest.param("python", id="python"),
    pytest.param("cpp", id="cpp", marks=[pytest.mark.slow, needs_cpp]),
    pytest.param("java", id="java", marks=[pytest.mark.slow, needs_java]),
]
Root = Callable[[str], Path]


@pytest.fixture(scope="session")
def root(tmp_path_factory: pytest.TempPathFactory) -> Root:
    """The folder of the component in a language, built by the first test that needs it."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "facet"

    def built(language: str) -> Path:
        component = folder / language / language
        folder.mkdir(exist_ok=True)
        with locked(folder / f"{language}.lock"):
            if not component.is_dir():
                others = {f"{other}/{other}.cdsl.yaml" for other in FILES if other != language}
                build({path: text for path, text in DOCUMENTS.items() if path not in others}, folder / language)
                path, text = FILES[language]
                (component / path).write_text(text)
                if language == "cpp":
                    cmake(component, *FAST)
                elif language == "java":
                    java_build(component)
        return component

    return built


class Vital:
    """The component in one language, its ports, and what it says."""

    def __init__(self, root: Path, folder: Path, free_port: Ports, storm: Storm) -> None:
        self.arm, self.hand, self.own = free_port(), free_port(), free_port()
        self.config = folder / "vital.config"
        self.proxy = f"commonbehavior:tcp -h 127.0.0.1 -p {self.own}"
        self.command = [root / "bin" / "Vital", self.config]
        properties = {
            "Arm.Endpoints": f"tcp -h 127.0.0.1 -p {self.arm}",
            "CommonBehavior.Endpoints": f"tcp -h 127.0.0.1 -p {self.own}",
            "HandProxy": f"hand:tcp -h 127.0.0.1 -p {self.hand}",
            "TopicManager.Proxy": storm.manager,
            "ArmEvents": f"vital/{folder.name}",
        }
        self.config.write_text("".join(f"{key} = {value}\n" for key, value in properties.items()))

    def report(self, *sections: str) -> Sections | None:
        return asyncio.run(introspection.report(self.proxy, sections, 2.0))

    def section(self, name: str) -> list[Facts]:
        found = self.report(name)
        assert found is not None and list(found) == [name]
        return found[name]

    @property
    def state(self) -> str:
        own = asyncio.run(introspection.state(self.proxy, 2.0))
        return own.words if own else ""

    @property
    def age(self) -> float:
        reply = asyncio.run(ice_call.answer(self.proxy, IceCall(wire.HEARTBEAT, wire.FACET), 2.0))
        assert reply is not None and reply.status == OK
        age, period = struct.unpack("<ii", reply.result)  # milliseconds
        assert period == PERIOD
        return float(age / 1000)

    def is_running(self) -> bool:
        return self.state == "running"


@pytest.fixture(params=LANGUAGES)
def vital(
    request: pytest.FixtureRequest, root: Root, tmp_path: Path, free_port: Ports, icestorm: Storm
) -> Vital:  # fmt: skip
    return Vital(root(request.param), tmp_path, free_port, icestorm)


@contextmanager
def hand(ice: Any, port: int) -> Iterator[None]:
    """Something that answers pings."""
    import Ice

    adapter = ice.createObjectAdapterWithEndpoints(f"Hand{port}", f"tcp -h 127.0.0.1 -p {port}")
    adapter.add(type("Hand", (Ice.Object,), {})(), ice.stringToIdentity("hand"))
    adapter.activate()
    try:
        yield
    finally:
        adapter.destroy()


def arm(ice: Any, port: int) -> Any:
    import RoboCompArm

    return RoboCompArm.ArmPrx.uncheckedCast(ice.stringToProxy(f"arm:tcp -h 127.0.0.1 -p {port}"))


def running(vital: Vital, start: Start, ice: Any) -> Running:
    with hand(ice, vital.hand):
        process = start(vital.command)
        until(vital.is_running, lambda: f"it to run:\n{process.output}")
    return process


def test_its_life(vital: Vital, start: Start, ice: Any, slices: None) -> None:
    process = start(vital.command)
    waiting = f"waiting for Hand at 127.0.0.1:{vital.hand}"
    until(lambda: vital.state == waiting, lambda: f"it to wait:\n{process.output}")
    until(lambda: vital.section("state")[0].texts.get("why") == "connection refused", "the reason")
    state = vital.section("state")[0]
    assert (state.name, state.texts["for"]) == ("Vital", "Hand")
    assert 0 <= state.numbers["since"] <= state.numbers["uptime"]
    assert vital.age == 0, "only a running worker has a heartbeat that can be old"
    with hand(ice, vital.hand):
        until(lambda: "in initialize()" in vital.state, lambda: f"it to start, not {vital.state}")
        assert vital.age == 0
        until(vital.is_running, "the end of initialize()")
    assert process.stop() == 0


def test_its_calls(vital: Vital, start: Start, ice: Any, slices: None) -> None:
    import Ice
    import RoboCompArm

    running(vital, start, ice)
    assert vital.section("calls") == []
    proxy = arm(ice, vital.arm)
    for _ in range(3):
        proxy.move([], False)
    with pytest.raises(RoboCompArm.Blocked):
        proxy.move([], True)
    with pytest.raises(Ice.UnknownException):
        proxy.breakDown()
    with pytest.raises(Ice.OperationNotExistException):
        RoboCompArm.HandPrx.uncheckedCast(proxy).grasp(b"")
    proxy.ice_ping()
    calls = {facts.name: facts.numbers for facts in vital.section("calls")}
    assert calls.keys() == {"Arm.move", "Arm.breakDown"}, "pings and unknown operations do not count"
    move, broken = calls["Arm.move"], calls["Arm.breakDown"]
    assert (move["calls"], move["exceptions"], move["failures"]) == (4, 1, 0)
    assert (broken["calls"], broken["exceptions"], broken["failures"]) == (1, 0, 1)
    assert 0.015 <= move["mean"] <= move["longest"]
    assert 0 <= move["last"] < 60


def test_its_worker_and_topics(vital: Vital, start: Start, ice: Any, slices: None) -> None:
    running(vital, start, ice)
    until(lambda: vital.section("worker")[0].numbers.get("turns", 0) >= 20, "20 turns")
    worker = vital.section("worker")[0].numbers
    assert worker["period"] == PERIOD / 1000
    assert 0.8 * worker["period"] <= worker["achieved"] <= 3 * worker["period"]
    assert worker["failures"] == 0 and worker["heartbeat"] < 1
    before = worker["missed"]
    arm(ice, vital.arm).block(0.5)
    until(lambda: vital.section("worker")[0].numbers["missed"] >= before + 8, "missed turns")
    until(lambda: vital.section("topics")[0].numbers["events"] > 5, "events")
    topics = {facts.texts["direction"]: facts for facts in vital.section("topics")}
    assert topics.keys() == {"in", "out"}
    for facts in topics.values():
        assert facts.name == "ArmEvents" and facts.texts["topic"].startswith("vital/")
        assert facts.numbers["events"] > 5 and facts.numbers["last"] < 10
    assert topics["in"].numbers["failures"] == 0 and "mean" not in topics["out"].numbers


def test_its_heartbeat(vital: Vital, start: Start, ice: Any, slices: None) -> None:
    running(vital, start, ice)
    proxy = arm(ice, vital.arm)
    assert vital.age < 1
    proxy.block(2.0)
    until(lambda: vital.age > 1.2, "a heartbeat that gets old")
    assert vital.is_running(), "it answers all the same"
    until(lambda: vital.age < 0.5, "the next turn")
    proxy.block(-2.6)
    ages = []
    until(lambda: ages.append(vital.age) or vital.section("worker")[0].numbers["longest"] > 2.5, "the long turn")
    assert max(ages) < 1.2, "it has said that it takes long"


def test_its_build(vital: Vital, start: Start, ice: Any, slices: None, request: pytest.FixtureRequest) -> None:
    running(vital, start, ice)
    every = vital.report()
    assert every is not None and every.keys() == {"state", "worker", "calls", "topics", "build", "interfaces"}
    assert vital.report("build", "weather") == {"build": every["build"]}, "an unknown section is ignored"
    build = every["build"][0]
    assert build.name == "Vital" and build.texts["language"] in FILES and len(build.texts["runtime"]) == 12
    ports = [(facts.texts["role"], facts.name, facts.texts["interface"]) for facts in every["interfaces"]]
    events = ("ArmEvents", "RoboCompArm.ArmEvents")
    assert ports == [
        ("implements", "Arm", "RoboCompArm.Arm"),
        ("requires", "Hand", "RoboCompArm.Hand"),
        ("publishes", *events),
        ("subscribes", *events),
    ]
    assert len({facts.texts["hash"] for facts in every["interfaces"]}) == 3


def test_it_answers_a_silent_server(vital: Vital, start: Start, ice: Any, free_port: Ports) -> None:
    """The other end accepts connections, and says nothing."""
    import socket

    with socket.create_server(("127.0.0.1", vital.hand)):
        start(vital.command)
        until(lambda: vital.state == f"waiting for Hand at 127.0.0.1:{vital.hand}", "it to wait")


def test_a_program_without_the_facet(ice: Any, free_port: Ports) -> None:
    port = free_port()
    with hand(ice, port), pytest.raises(introspection.NoFacet):
        asyncio.run(introspection.state(f"hand:tcp -h 127.0.0.1 -p {port}", 2.0))
    assert asyncio.run(introspection.state(f"hand:tcp -h 127.0.0.1 -p {port}", 0.5)) is None
