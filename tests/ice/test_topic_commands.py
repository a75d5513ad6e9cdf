"""`rcyaml topic`: a real IceStorm, and a generated component that publishes."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from components import Build, Built
from conftest import write_tree
from cpp_programs import Programs as CppPrograms
from cpp_programs import needs_cpp
from java_programs import needs_java
from processes import Ports, Start, Storm, answers, until
from scenario import INTERFACES, cdsl
from test_call import tls  # noqa: F401 (the fixture)
from test_java import Program, built, program  # noqa: F401 (fixtures)

Rcyaml = Callable[..., Result]
RCYAML = os.path.join(os.path.dirname(sys.executable), "rcyaml")
PUBLISHER = """
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompTypes

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.n = 0

    def compute(self):
        self.n += 1
        self.armevents_proxy.count(self.n)
        if self.n % 2:
            self.armevents_proxy.moved(RoboCompTypes.Pose(x=self.n, side=RoboCompTypes.Side.right))
"""
DEPLOYMENT = """\
deployment: Robot
components:
  left: {{component: p, config: etc/config, topics: {{ArmEvents: {name}}}}}
  right: {{component: s, config: etc/config, topics: {{ArmEvents: {name}}}}}
"""


class Talk:
    """A publisher at 50 Hz of a topic of the documents whose name in IceStorm is `name`."""

    def __init__(self, name: str, publisher: Built, manager: str) -> None:
        self.name, self.publisher, self.manager = name, publisher, manager
        publisher.configure({"TopicManager.Proxy": manager, "ArmEvents": name, "period.compute": 20})


@pytest.fixture
def talk(build: Build, icestorm: Storm, tmp_path: Path) -> Talk:
    name = f"Events{time.monotonic_ns()}"
    write_tree(tmp_path, {"rcyaml.yaml": "interfaces: [.]\n"})
    made = build({
        **INTERFACES,
        "p/p.cdsl.yaml": cdsl("Publisher", publishes=["ArmEvents"]),
        "s/s.cdsl.yaml": cdsl("Subscriber", subscribes=["ArmEvents"]),
    })  # fmt: skip
    (made["Publisher"].root / "src" / "specificworker.py").write_text(PUBLISHER)
    for folder in "ps":
        write_tree(tmp_path, {f"{folder}/etc/config": f"TopicManager.Proxy = {icestorm.manager}\n"})
    write_tree(tmp_path, {"robot.ddsl.yaml": DEPLOYMENT.format(name=name)})
    return Talk(name, made["Publisher"], icestorm.manager)


def rows(rcyaml: Rcyaml) -> dict[str, dict[str, object]]:
    done = rcyaml("topic", "list", "--format", "json")
    assert done.exit_code == 0, done.output
    return {one["topic"]: one for one in json.loads(done.stdout)["topics"]}


def test_who_publishes_and_subscribes(talk: Talk, start: Start, rcyaml: Rcyaml) -> None:
    before = rows(rcyaml)[talk.name]
    assert before == {
        "topic": talk.name, "carries": "RoboCompArm.ArmEvents", "storm": talk.manager, "publishers": ["left"],
        "subscribers": ["right"], "subscribed": None,
    }  # fmt: skip
    start(talk.publisher.command).wait_for("Publisher is running")
    assert rows(rcyaml)[talk.name]["subscribed"] == 0
    listed = rcyaml("topic", "list").stdout.splitlines()
    assert listed[0].split("  ")[0].startswith("TOPIC")
    assert [talk.name, "RoboCompArm.ArmEvents", "left"] in [one.split()[:3] for one in listed]


def test_messages_as_they_come(talk: Talk, start: Start, rcyaml: Rcyaml) -> None:
    start(talk.publisher.command).wait_for("Publisher is running")
    done = rcyaml("topic", "echo", f"{talk.name}.count", "--count", "5", "--format", "json")
    messages = [json.loads(line) for line in done.stdout.splitlines()]
    numbers = [one["arguments"]["n"] for one in messages]
    assert numbers == list(range(numbers[0], numbers[0] + 5))
    assert {(one["topic"], one["method"]) for one in messages} == {(talk.name, "count")}
    done = rcyaml("topic", "echo", talk.name, "--count", "4")
    assert f"{talk.name}.moved(pose: {{x: " in done.stdout and "side: right})" in done.stdout
    assert len(done.stdout.splitlines()) == 4
    assert rows(rcyaml)[talk.name]["subscribed"] == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_the_subscription_ends_with_the_command(
    talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path, number: int
) -> None:
    if signal.getsignal(number) == signal.SIG_IGN:
        pytest.skip("these tests run under nohup, whose programs ignore SIGHUP")
    start(talk.publisher.command).wait_for("Publisher is running")
    echo = start([RCYAML, "topic", "echo", talk.name], cwd=tmp_path).wait_for(f"{talk.name}.count(n: ")
    assert rows(rcyaml)[talk.name]["subscribed"] == 1
    code = echo.stop(number)
    assert code == (130 if number == signal.SIGINT else -9 if number == signal.SIGKILL else 143)
    # What is killed cannot say goodbye: IceStorm removes it when the next message does not arrive.
    until(lambda: rows(rcyaml)[talk.name]["subscribed"] == 0, "the end of the subscription", 10)


def test_the_reader_goes(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:
    start(talk.publisher.command).wait_for("Publisher is running")
    head = start(["bash", "-c", f"set -o pipefail; '{RCYAML}' topic echo {talk.name} | head -1"], cwd=tmp_path)
    assert head.exit_code() == 141
    assert rows(rcyaml)[talk.name]["subscribed"] == 0


def test_rate_and_jitter(talk: Talk, start: Start, rcyaml: Rcyaml) -> None:
    start(talk.publisher.command).wait_for("Publisher is running")
    done = rcyaml("topic", "hz", f"{talk.name}.count", "--for", "2s", "--every", "900ms", "--format", "json")
    reports = [json.loads(line) for line in done.stdout.splitlines()]
    assert 2 <= len(reports) <= 4
    assert 25 < reports[1]["rate"] < 60 and reports[1]["min"] <= reports[1]["mean"] <= reports[1]["max"]
    assert "/s   every " in rcyaml("topic", "hz", talk.name, "--count", "10").stdout
    done = rcyaml(
        "topic", "hz", talk.name, "--for", "300ms", "--storm", talk.manager, "--type", "ArmEvents", "--every", "200ms"
    )
    assert done.exit_code == 0


def test_a_component_hears_what_is_published(
    talk: Talk, build: Build, start: Start, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    (tmp_path / "s" / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
        "    def ArmEvents_moved(self, pose):\n        print('moved', pose.x, pose.y, pose.side)\n\n"
        "    def ArmEvents_count(self, n):\n        print('count', n)\n"
    )
    subscriber = Built("Subscriber", tmp_path / "s", "python")
    subscriber.configure({"TopicManager.Proxy": talk.manager, "ArmEvents": talk.name})
    hearing = start(subscriber.command).wait_for("Subscriber is running")
    assert rcyaml("topic", "pub", f"{talk.name}.moved", "pose={x: 4, side: right}").exit_code == 0
    hearing.wait_for("moved 4.0 2.5 right")
    began = time.monotonic()
    done = rcyaml("topic", "pub", f"{talk.name}.count", "n=7", "--rate", "20", "--count", "6", "--format", "json")
    assert json.loads(done.stdout)["sent"] == 6 and time.monotonic() - began > 0.2
    until(lambda: hearing.output.count("count 7") == 6, lambda: hearing.output)


def test_a_thousand_messages_per_second(talk: Talk, start: Start, tmp_path: Path) -> None:
    """What is published as fast as it goes arrives completely, in its order."""
    echo = start([RCYAML, "topic", "echo", f"{talk.name}.count", "--count", "5000", "--format", "json"], cwd=tmp_path)
    topic = "from robocomp_yaml.api.addresses import Addresses\nfrom robocomp_yaml.api.topics import Topics\n"
    script = f"""{topic}
import time
topics = Topics(Addresses("robot.ddsl.yaml"))
topic, _ = topics.find({talk.name!r})
end = time.monotonic() + 60
while not {{one.name: one.subscribed for one in topics.known()[0]}}[topic.name] and time.monotonic() < end:
    time.sleep(0.05)
messages = [topics.message(topic, "count", [f"n={{n}}"]) for n in range(5000)]
with topics.publisher(topic) as publisher:
    began = time.monotonic()
    for number, message in enumerate(messages):
        time.sleep(max(0, began + number / 1250 - time.monotonic()))
        publisher.send(message)
print("sent in", time.monotonic() - began)
"""
    start([sys.executable, "-c", script], cwd=tmp_path).wait_for("sent in")
    assert echo.exit_code() == 0
    numbers = [json.loads(line)["arguments"]["n"] for line in echo.output.splitlines()]
    assert numbers == list(range(5000))


@pytest.fixture
def storm(ice: object, free_port: Ports, tmp_path: Path) -> Storm:
    """An IceStorm of one's own, which a test starts and kills."""
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    (tmp_path / "storm").mkdir()
    return Storm.new(tmp_path / "storm", free_port(), free_port())


def test_an_icestorm_that_goes_away_is_waited_for(
    ice: object, storm: Storm, start: Start, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    """Started again, it may have forgotten its subscribers, or be the same one that was only halted."""
    options = ["--storm", storm.manager, "--timeout", "1s"]
    running = start(storm.command)
    until(lambda: answers(ice, storm.manager), lambda: running.output)
    echo = start([RCYAML, "topic", "echo", "ArmEvents", *options], cwd=tmp_path)
    hz = start([RCYAML, "topic", "hz", "ArmEvents", *options], cwd=tmp_path)
    record = start([RCYAML, "record", "ArmEvents", *options, "--count", "3", "-o", "all.mcap"], cwd=tmp_path)

    def heard(n: int) -> None:
        assert rcyaml("topic", "pub", "ArmEvents.count", f"n={n}", *options).exit_code == 0
        echo.wait_for(f"ArmEvents.count(n: {n})")

    listening = lambda: "3 subscribers" in rcyaml("topic", "list", *options).stdout  # noqa: E731
    until(listening, lambda: echo.output + hz.output + record.output)
    heard(1)
    running.process.kill()
    for each in (echo, hz, record):
        each.wait_for(f"does not answer at '{storm.manager}': nothing listens there; waiting until it does")
    shutil.rmtree(tmp_path / "storm/db")
    (tmp_path / "storm/db").mkdir()
    running = start(storm.command)
    for each in (echo, hz, record):
        each.wait_for(f"IceStorm answers again at '{storm.manager}'")
    until(listening, lambda: echo.output + hz.output + record.output)
    heard(2)
    running.process.send_signal(signal.SIGSTOP)
    echo.wait_for("it does not answer in time; waiting")
    running.process.send_signal(signal.SIGCONT)
    until(lambda: echo.output.count("answers again") == 2, lambda: echo.output)
    heard(3)
    assert record.exit_code() == 0 and "3 messages" in record.output
    running.process.kill()
    until(lambda: hz.output.count("nothing listens there") == 2, lambda: hz.output)
    began = time.monotonic()
    assert (echo.stop(signal.SIGINT), hz.stop(signal.SIGINT)) == (130, 130) and time.monotonic() - began < 5


def test_what_ends_while_icestorm_is_away(
    ice: object, storm: Storm, start: Start, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    """Exit code 1: messages may be missing."""
    running = start(storm.command)
    until(lambda: answers(ice, storm.manager), lambda: running.output)
    options = ["--storm", storm.manager, "--for", "6s"]
    every = [
        start([RCYAML, *words, "ArmEvents", *options], cwd=tmp_path)
        for words in (["topic", "echo"], ["topic", "hz"], ["record", "-o", "short.mcap"])
    ]
    until(lambda: "3 subscribers" in rcyaml("topic", "list", *options[:2]).stdout, lambda: every[0].output)
    running.process.kill()
    assert [one.exit_code() for one in every] == [1, 1, 1], [one.output for one in every]
    assert rcyaml("record", "info", "short.mcap").exit_code == 0


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["echo", "ArmEvent"], 2, "unknown topic 'ArmEvent'; did you mean"),
        (["echo", "ArmEvents.mooved"], 2, "did you mean 'moved'?"),
        (["echo", "Other", "--type", "Nothing"], 2, "'Nothing' is not a topic of these documents; known are RoboComp"),
        (["echo", "Other", "--type", "ArmEvent"], 2, "did you mean 'ArmEvents'?"),
        (["echo", "Other"], 2, "--type says what another topic carries"),
        (["pub", "ArmEvents.count", "n=1", "--rat", "5"], 2, "No such option '--rat'"),
        (["pub", "ArmEvents"], 2, "name the message: ArmEvents.moved, ArmEvents.count"),
        (["pub", "ArmEvents.count", "n=x"], 1, "argument 1:1:3"),
        (["pub", "ArmEvents.count", "n=1"], 1, "does not answer at 'IceStorm/TopicManager:tcp -h localhost -p 9"),
        (["list"], 1, "does not answer at"),
        (["echo", "ArmEvents"], 1, "nothing listens there"),
    ],
)
def test_what_cannot_be_done(rcyaml: Rcyaml, tmp_path: Path, words: list[str], code: int, said: str) -> None:
    write_tree(
        tmp_path,
        {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n", "p/p.cdsl.yaml": cdsl("P", publishes=["ArmEvents"])},
    )
    done = rcyaml("topic", *words, "--storm", "IceStorm/TopicManager:tcp -h localhost -p 9")
    assert done.exit_code == code
    assert said in done.output


def test_what_is_not_an_icestorm(talk: Talk, rcyaml: Rcyaml) -> None:
    """By HOST:PORT, which is enough for one that is; by an identity that nobody has; and something else."""
    endpoint = talk.manager.partition(":")[2]
    at = f"127.0.0.1:{endpoint.rpartition('-p ')[2].split()[0]}"
    done = rcyaml("topic", "pub", f"{talk.name}.count", "n=1", "--storm", at)
    assert done.exit_code == 0, done.output
    done = rcyaml("topic", "list", "--storm", f"Storm/TopicManager:{endpoint}")
    assert done.exit_code == 1 and "there is no object 'Storm/TopicManager'" in done.output
    done = rcyaml("topic", "list", "--storm", f"IceStorm/topic.{talk.name}:{endpoint}")
    assert done.exit_code == 1 and "what answers there is not its topic manager" in done.output


@pytest.fixture
def secure_storm(ice: object, tls: dict[str, str], start: Start, free_port: Ports, tmp_path: Path) -> str:  # noqa: F811
    """The topic manager of an IceStorm with TLS only."""
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    port = free_port()
    (tmp_path / "db").mkdir()
    properties = {
        **tls, "IceBox.Service.IceStorm": "IceStormService,37:createIceStorm", "IceBox.InheritProperties": "1",
        "IceStorm.InstanceName": "IceStorm", "IceStorm.TopicManager.Endpoints": f"ssl -h 127.0.0.1 -p {port}",
        "IceStorm.Publish.Endpoints": f"ssl -h 127.0.0.1 -p {free_port()}", "IceStorm.LMDB.Path": str(tmp_path / "db"),
        "IceStorm.LMDB.MapSize": "10",
    }  # fmt: skip
    write_tree(tmp_path, {"box.cfg": "".join(f"{key}={value}\n" for key, value in properties.items())})
    start(["icebox", "--Ice.Config=box.cfg"], cwd=tmp_path)
    return f"IceStorm/TopicManager:ssl -h 127.0.0.1 -p {port}"


def test_topics_with_tls(
    build: Build,
    tls: dict[str, str],  # noqa: F811
    secure_storm: str,
    start: Start,
    rcyaml: Rcyaml,
    tmp_path: Path,
) -> None:
    """A component publishes, and both ends of the commands, with the certificate of the robot."""
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    made = build({**INTERFACES, "p/p.cdsl.yaml": cdsl("Publisher", publishes=["ArmEvents"])})["Publisher"]
    (made.root / "src" / "specificworker.py").write_text(PUBLISHER)
    made.configure({**tls, "TopicManager.Proxy": secure_storm, "period.compute": 20})
    start(made.command).wait_for("Publisher is running")
    secured = ["--storm", secure_storm, "--ice-config", "tls.cfg"]
    assert "ArmEvents  RoboCompArm.ArmEvents" in rcyaml("topic", "list", *secured).stdout
    done = rcyaml("topic", "echo", "ArmEvents.count", *secured, "--count", "3")
    assert done.stdout.count("ArmEvents.count(n: ") == 3, done.output
    assert rcyaml("topic", "pub", "ArmEvents.count", "n=1", *secured).exit_code == 0
    done = rcyaml("topic", "list", "--storm", secure_storm)
    assert done.exit_code == 2 and "--ice-config FILE" in done.output


def of_a_radio(
    rcyaml: Rcyaml, name: str, tmp_path: Path, start: Start, manager: str, command: list[str | Path]
) -> None:
    """A component that publishes some events when it starts, in another language than Python; and hears others."""
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    options = ["--storm", manager, "--type", "ArmEvents"]
    echo = start([RCYAML, "topic", "echo", name, *options, "--count", "4"], cwd=tmp_path)
    until(lambda: f"{name} " in rcyaml("topic", "list", "--storm", manager).stdout, lambda: echo.output)
    until(lambda: " 1 subscriber" in listed(rcyaml, name, manager), lambda: listed(rcyaml, name, manager))
    start(command)
    assert echo.exit_code() == 0
    said = [line.partition(" ")[2] for line in echo.output.splitlines()]
    assert said == [
        f'{name}.moved(pose: {{x: 4.0, "y": 2.5, side: right}})',
        *(f"{name}.count(n: {n})" for n in range(3)),
    ]
    assert rcyaml("topic", "pub", f"{name}.count", "n=5", *options).exit_code == 0


def listed(rcyaml: Rcyaml, name: str, manager: str) -> str:
    lines = rcyaml("topic", "list", "--storm", manager).stdout.splitlines()
    return next((line for line in lines if line.startswith(f"{name} ")), "")


@needs_cpp
@pytest.mark.slow
def test_topics_of_cpp(programs: CppPrograms, start: Start, icestorm: Storm, rcyaml: Rcyaml, tmp_path: Path) -> None:
    properties = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": "CppHeard"}
    of_a_radio(rcyaml, "CppHeard", tmp_path, start, icestorm.manager, programs("Radio").command(tmp_path, properties))


@needs_java
@pytest.mark.slow
def test_topics_of_java(
    program: Program,  # noqa: F811
    start: Start,
    icestorm: Storm,
    free_port: Ports,
    rcyaml: Rcyaml,
    tmp_path: Path,
) -> None:
    port = free_port()
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    hand = start([RCYAML, "mock", "Hand", "--endpoint", f"Hand=tcp -h 127.0.0.1 -p {port}"], cwd=tmp_path)
    hand.wait_for("serving")
    properties = {
        "TopicManager.Proxy": icestorm.manager, "ArmEvents": "JavaHeard", "Arm.Endpoints": f"tcp -p {free_port()}",
        "HandProxy": f"hand:tcp -h 127.0.0.1 -p {port}",
    }  # fmt: skip
    of_a_radio(rcyaml, "JavaHeard", tmp_path, start, icestorm.manager, program("Radio", properties))
