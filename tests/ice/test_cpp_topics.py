"""C++ components that publish and subscribe over a real IceStorm, with Python ones at the other end."""

from __future__ import annotations

from pathlib import Path

import pytest

from components import Build
from cpp_programs import Program, Programs, needs_cpp
from processes import Ports, Start, Storm
from scenario import INTERFACES, cdsl
from test_python_topics import PUBLISHER, SUBSCRIBER

pytestmark = [pytest.mark.slow, needs_cpp]


@pytest.fixture
def radio(programs: Programs) -> Program:
    """Publishes ArmEvents at start, and then subscribes to them."""
    return programs("Radio")


# The worker's own events come late, so they must not matter.
DEAF_TO_ITSELF = {"Proxies.ArmEventsPubPrefix": "elsewhere"}


@pytest.mark.parametrize(
    ("for_both", "for_first", "for_second"),
    [
        ({"ArmEvents": "CppPlain"}, {}, {}),
        ({"ArmEvents": "CppTwice"}, {"ArmEventsTopic.Endpoints": "tcp -h 127.0.0.1 -p 0"}, {}),
        ({}, {"Proxies.ArmEventsPrefix": '"cppleft"'}, {"Proxies.ArmEventsPubPrefix": "cppleft"}),
    ],
    ids=["renamed", "endpoint", "prefixed"],
)
def test_events_arrive_in_order(
    radio: Program,
    start: Start,
    icestorm: Storm,
    tmp_path: Path,
    for_both: dict[str, str],
    for_first: dict[str, str],
    for_second: dict[str, str],
) -> None:
    manager = {"TopicManager.Proxy": icestorm.manager, **for_both}
    first = start(radio.command(tmp_path, {**manager, **DEAF_TO_ITSELF, **for_first})).wait_for("Radio is running")
    second = start(radio.command(tmp_path, {**manager, **for_second})).wait_for("published")
    first.wait_for("all in order\n")
    assert "moved to 4 right\n" in first.output and "expected" not in first.output
    assert first.stop() == 0 and second.stop() == 0


def test_python_hears_cpp(radio: Program, build: Build, start: Start, icestorm: Storm, tmp_path: Path) -> None:
    built = build({**INTERFACES, "s/s.cdsl.yaml": cdsl("Subscriber", subscribes=["ArmEvents"])})["Subscriber"]
    (built.root / "src" / "specificworker.py").write_text(SUBSCRIBER)
    properties = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": "CppToPython"}
    hearing = start(built.configure(properties).command).wait_for("Subscriber is running")
    start(radio.command(tmp_path, properties))
    hearing.wait_for("in order: True\n")
    assert "moved to 4.0 right\n" in hearing.output


def test_cpp_hears_python(radio: Program, build: Build, start: Start, icestorm: Storm, tmp_path: Path) -> None:
    built = build({**INTERFACES, "p/p.cdsl.yaml": cdsl("Publisher", publishes=["ArmEvents"])})["Publisher"]
    (built.root / "src" / "specificworker.py").write_text(PUBLISHER)
    properties = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": "PythonToCpp"}
    hearing = start(radio.command(tmp_path, {**properties, **DEAF_TO_ITSELF})).wait_for("Radio is running")
    start(built.configure(properties).command)
    hearing.wait_for("all in order\n")
    assert "moved to 4 right\n" in hearing.output


def test_an_interface_as_a_topic(radio: Program, build: Build, start: Start, icestorm: Storm, tmp_path: Path) -> None:
    """Only the methods that a topic can carry call the worker."""
    assert "Arm_betray" in (text := (radio.root / "generated" / "genericworker.h").read_text())
    assert "Arm_move" not in text
    built = build({**INTERFACES, "p/p.cdsl.yaml": cdsl("Shouter", publishes=["Arm"])})["Shouter"]
    (built.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
        "    def initialize(self):\n        self.arm_proxy.betray()\n        self.arm_proxy.block(2.5)\n"
    )
    properties = {"TopicManager.Proxy": icestorm.manager, "Arm": "CppShouts", "ArmEvents": "CppIdle"}
    hearing = start(radio.command(tmp_path, properties)).wait_for("Radio is running")
    start(built.configure(properties).command)
    hearing.wait_for("heard\nheard 2.5\n")


def test_it_waits_for_the_topic_manager(radio: Program, start: Start, free_port: Ports, tmp_path: Path) -> None:
    manager = f"IceStorm/TopicManager:tcp -h 127.0.0.1 -p {free_port()}"
    waiting = start(radio.command(tmp_path, {"TopicManager.Proxy": manager}))
    waiting.wait_for(f"waiting for TopicManager at {manager} ... (connection refused)\n")
    assert waiting.stop() == 0
