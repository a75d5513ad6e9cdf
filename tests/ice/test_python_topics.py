"""Python components that publish and subscribe over a real IceStorm."""

from __future__ import annotations

import pytest

from components import Build, Built
from processes import Ports, Start, Storm
from scenario import INTERFACES, cdsl

PUBLISHER = """
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompTypes

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.armevents_proxy.moved(RoboCompTypes.Pose(x=4, side=RoboCompTypes.Side.right))
        for n in range(100):
            self.armevents_proxy.count(n)
        print("published")
"""
SUBSCRIBER = """
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.counted = []

    def ArmEvents_moved(self, pose):
        print("moved to", pose.x, pose.side)

    def ArmEvents_count(self, n):
        self.counted.append(n)
        if len(self.counted) == 100:
            print("in order:", self.counted == list(range(100)))
"""


@pytest.fixture
def pair(build: Build, icestorm: Storm) -> tuple[Built, Built]:
    """A publisher and a subscriber of a topic that no other test uses."""
    built = build(
        {
            **INTERFACES,
            "p/p.cdsl.yaml": cdsl("Publisher", publishes=["ArmEvents"]),
            "s/s.cdsl.yaml": cdsl("Subscriber", subscribes=["ArmEvents"]),
        }
    )
    (built["Publisher"].root / "src" / "specificworker.py").write_text(PUBLISHER)
    (built["Subscriber"].root / "src" / "specificworker.py").write_text(SUBSCRIBER)
    return built["Publisher"], built["Subscriber"]


@pytest.mark.parametrize(
    ("for_publisher", "for_subscriber"),
    [
        ({}, {}),
        ({"ArmEvents": "Renamed"}, {"ArmEvents": "Renamed", "ArmEventsTopic.Endpoints": "tcp -h 127.0.0.1 -p 0"}),
        ({"Proxies.ArmEventsPubPrefix": '"left"'}, {"Proxies.ArmEventsPrefix": "left"}),
    ],
    ids=["plain", "renamed", "prefixed"],
)
def test_events_arrive_in_order(
    pair: tuple[Built, Built],
    start: Start,
    icestorm: Storm,
    for_publisher: dict[str, str],
    for_subscriber: dict[str, str],
) -> None:
    publisher, subscriber = pair
    publisher.configure({"TopicManager.Proxy": icestorm.manager, **for_publisher})
    subscriber.configure({"Proxies.TopicManager": f'"{icestorm.manager}"', **for_subscriber})
    receiving = start(subscriber.command).wait_for("Subscriber is running")
    start(publisher.command).wait_for("published")
    receiving.wait_for("in order: True\n")
    assert "moved to 4.0 right\n" in receiving.output
    assert receiving.stop() == 0


def test_two_subscribers_and_one_that_goes(pair: tuple[Built, Built], start: Start, icestorm: Storm) -> None:
    """Each subscriber gets all events; one that has stopped has unsubscribed, and can subscribe again."""
    publisher, subscriber = pair
    for component in pair:
        component.configure({"TopicManager.Proxy": icestorm.manager, "ArmEvents": "Two"})
    first = start(subscriber.command).wait_for("Subscriber is running")
    assert first.stop() == 0
    subscribers = [start(subscriber.command).wait_for("Subscriber is running") for _ in range(2)]
    start(publisher.command)
    for receiving in subscribers:
        receiving.wait_for("in order: True\n")


def test_it_waits_for_the_topic_manager(pair: tuple[Built, Built], start: Start, free_port: Ports) -> None:
    publisher, _ = pair
    manager = f"IceStorm/TopicManager:tcp -h 127.0.0.1 -p {free_port()}"
    waiting = start(publisher.configure({"TopicManager.Proxy": manager}).command)
    waiting.wait_for(f"waiting for TopicManager at {manager} ... (connection refused)\n")
    assert waiting.stop() == 0


def test_the_topic_manager_is_not_configured(pair: tuple[Built, Built], start: Start) -> None:
    publisher, _ = pair
    failing = start(publisher.configure({"X": "1"}).command, cwd=publisher.root)
    assert failing.exit_code() == 1
    (line,) = failing.output.splitlines()
    assert line.endswith(
        "ERROR Publisher: IceStorm's topic manager is not configured: "
        "set TopicManager.Proxy or Proxies.TopicManager in etc/config"
    )


def test_an_interface_published_and_subscribed_by_one(build: Build, start: Start, icestorm: Storm) -> None:
    """A component may receive its own events; of an interface, only methods that topics can carry are called."""
    documents = {**INTERFACES, "e/e.cdsl.yaml": cdsl("Echo", publishes=["Arm"], subscribes=["Arm"])}
    echo = build(documents)["Echo"].configure({"TopicManager.Proxy": icestorm.manager, "Arm": "Echo"})
    generic = (echo.root / "generated" / "genericworker.py").read_text()
    assert "def Arm_betray" in generic and "def Arm_move" not in generic
    (echo.root / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
        "    def compute(self):\n        self.arm_proxy.betray()\n\n"
        "    def Arm_betray(self):\n        print('heard')\n"
    )
    start(echo.command).wait_for("heard")
