"""`rcyaml record`: files that MCAP's own reader decodes, and networks in which they are played."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from hypothesis import HealthCheck, given, settings

from components import Built
from conftest import write_tree
from cpp_programs import Programs as CppPrograms
from cpp_programs import needs_cpp
from in_memory import program as in_memory
from java_programs import needs_java
from processes import Ports, Start, Storm, until
from robocomp_yaml.source.yaml_text import flow
from scenario import INTERFACES
from test_call import tls  # noqa: F401 (the fixture)
from test_java import Program, built, program  # noqa: F401 (fixtures)
from test_topic_commands import PUBLISHER, Talk, listed, secure_storm, talk  # noqa: F401 (fixtures)
from test_wire import DOCUMENTS, everything, names, node, right

pytest.importorskip("mcap", reason="MCAP for Python is not installed (pip install mcap mcap-protobuf-support)")
pytest.importorskip("mcap_protobuf", reason="MCAP's decoder of Protobuf is not installed")

Rcyaml = Callable[..., Result]
RCYAML = os.path.join(os.path.dirname(sys.executable), "rcyaml")


def decoded(path: Path) -> list[tuple[str, Any]]:
    """The messages of a file, by MCAP's own reader: channel and values."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [(channel.topic, message) for _, channel, _, message in reader.iter_decoded_messages()]


@pytest.fixture(scope="module")
def message_type(ice: Any) -> Any:
    """The Protobuf message of a topic that carries every type."""
    from robocomp_yaml.wire.interfaces import WireInterface
    from robocomp_yaml.wire.protobuf import MessageType
    from robocomp_yaml.wire.types import Types

    topic = "topics:\n  Wires:\n    methods:\n      all: {in: {value: All, grid: Grid, text: string}}\n      none:\n"
    documents = {**DOCUMENTS, "Wire.idsl.yaml": DOCUMENTS["Wire.idsl.yaml"] + topic}
    scopes = {scope.module.name: scope for scope in in_memory(documents).modules.values()}
    interface = WireInterface(scopes["WireModule"], scopes["WireModule"].module.topics[0], Types())
    return {name: MessageType(interface, operation) for name, operation in interface.operations.items()}


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(everything, names)
def test_every_value_comes_back(message_type: Any, value: dict[str, Any], text: str) -> None:
    made = message_type["all"]
    arguments = {"value": value, "grid": value["grid"], "text": text}
    values = made.operation.arguments(node(arguments), right)
    back = made.operation.inputs_as_data(made.decode(made.encode(values)))
    assert flow(back) == flow(made.operation.inputs_as_data(values))
    assert message_type["none"].decode(message_type["none"].encode(())) == ()


def test_what_a_component_publishes(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    start(talk.publisher.command).wait_for("Publisher is running")
    done = rcyaml("record", talk.name, "--count", "30", "-o", "a.mcap", "--format", "json")
    assert done.exit_code == 0, done.output
    assert {key: json.loads(done.stdout)[key] for key in ("file", "messages", "dropped")} == {
        "file": "a.mcap", "messages": 30, "dropped": {},
    }  # fmt: skip
    messages = decoded(tmp_path / "a.mcap")
    numbers = [values.n for channel, values in messages if channel == f"{talk.name}/count"]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers))) and len(messages) == 30
    poses = [values.pose for channel, values in messages if channel == f"{talk.name}/moved"]
    assert {(one.y, one.side) for one in poses} == {(2.5, 1)}
    assert type(poses[0]).DESCRIPTOR.full_name == "RoboCompTypes.Pose"

    found = json.loads(rcyaml("record", "info", "a.mcap", "--format", "json").stdout)
    assert found["messages"] == 30 and found["dropped"] == {} and found["deployment"] == "Robot"
    assert {(one["method"], one["type"]): one["messages"] for one in found["topics"]} == {
        ("moved", "RoboCompArm.ArmEvents.moved"): len(poses), ("count", "RoboCompArm.ArmEvents.count"): len(numbers),
    }  # fmt: skip
    assert "a.mcap: 30 messages in 0." in rcyaml("record", "info", "a.mcap").stdout


def test_a_killed_recorder_leaves_a_file(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    start(talk.publisher.command).wait_for("Publisher is running")
    recorder = start([RCYAML, "record", "-o", "k.mcap"], cwd=tmp_path).wait_for("recording")
    until(
        lambda: rcyaml("record", "info", "k.mcap", "--format", "json").stdout.count('"messages": 0') == 0,
        "a checkpoint",
    )
    assert "the recorder still runs, or was killed" in rcyaml("record", "info", "k.mcap").stdout
    recorder.stop(signal.SIGKILL)
    assert len(decoded(tmp_path / "k.mcap")) > 10
    assert "the recorder still runs, or was killed" in rcyaml("record", "info", "k.mcap").stdout


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_completes_the_file(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path, number: int) -> None:  # noqa: F811
    start(talk.publisher.command).wait_for("Publisher is running")
    recorder = start([RCYAML, "record", f"{talk.name}.count", "-o", "c.mcap"], cwd=tmp_path).wait_for("recording")
    time.sleep(0.5)
    assert recorder.stop(number) == 128 + number
    messages = decoded(tmp_path / "c.mcap")
    assert messages and {channel for channel, _ in messages} == {f"{talk.name}/count"}
    assert "killed" not in rcyaml("record", "info", "c.mcap").stdout


def test_a_largest_size(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    """Never more, also if it is hardly enough for one message."""
    start(talk.publisher.command).wait_for("Publisher is running")
    done = rcyaml("record", "--max-size", "8KB", "-o", "s.mcap")
    assert done.exit_code == 0 and "would be larger than 8.0 KB" in done.output
    assert 5000 < os.path.getsize("s.mcap") <= 8000
    assert decoded(tmp_path / "s.mcap")
    done = rcyaml("record", "--max-size", "100", "-o", "t.mcap")
    assert done.exit_code == 2 and "bytes: --max-size must be larger" in done.output
    assert not os.path.exists("t.mcap")
    least = int(done.output.partition("at least ")[2].split()[0])
    for more in (0, 50, 150, 400):
        assert rcyaml("record", "--max-size", str(least + more), "-o", f"{more}.mcap").exit_code == 0
        assert os.path.getsize(f"{more}.mcap") <= least + more


def test_what_was_dropped_is_counted(talk: Talk, start: Start, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.setattr("robocomp_yaml.commands._arriving.MOST_WAITING", 3)
    monkeypatch.setattr("robocomp_yaml.commands.record.PAUSE", 0.5)
    start(talk.publisher.command).wait_for("Publisher is running")
    done = rcyaml("record", "--for", "1600ms", "-o", "d.mcap")
    assert "messages were dropped: they came too fast" in done.output
    dropped = json.loads(rcyaml("record", "info", "d.mcap", "--format", "json").stdout)["dropped"]
    assert dropped[talk.name] > 10
    assert f"dropped: {dropped[talk.name]} of {talk.name}" in rcyaml("record", "info", "d.mcap").stdout


def test_it_is_played_in_another_network(
    talk: Talk,  # noqa: F811
    start: Start,
    rcyaml: Rcyaml,
    tmp_path: Path,
) -> None:
    """Under the same name, but without the publisher: a component hears what was recorded, in its times."""
    publisher = start(talk.publisher.command).wait_for("Publisher is running")
    assert rcyaml("record", "--for", "2s", "-o", "p.mcap").exit_code == 0
    publisher.stop()
    recorded = decoded(tmp_path / "p.mcap")
    (tmp_path / "s" / "src" / "specificworker.py").write_text(
        "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
        "    def ArmEvents_moved(self, pose):\n        print('moved', pose.x, pose.y, pose.side)\n\n"
        "    def ArmEvents_count(self, n):\n        print('count', n)\n"
    )
    subscriber = Built("Subscriber", tmp_path / "s", "python")
    hearing = start(subscriber.configure({"TopicManager.Proxy": talk.manager, "ArmEvents": talk.name}).command)
    hearing.wait_for("Subscriber is running")
    began = time.monotonic()
    done = rcyaml("record", "play", "p.mcap", "--rate", "2", "--deployment", "robot.ddsl.yaml", "--format", "json")
    assert json.loads(done.stdout)["sent"] == len(recorded)
    assert 0.8 < time.monotonic() - began < 10
    until(
        lambda: hearing.output.count("count ") + hearing.output.count("moved ") == len(recorded), lambda: hearing.output
    )
    heard = [line for line in hearing.output.splitlines() if line.startswith(("count ", "moved "))]
    expected = [
        f"count {values.n}" if channel.endswith("count") else f"moved {values.pose.x:.1f} 2.5 right"
        for channel, values in recorded
    ]
    assert heard == expected
    assert json.loads(rcyaml("record", "play", "p.mcap", talk.name, "--rate", "0", "--format", "json").stdout)["sent"]


def test_another_version_is_not_played(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    start(talk.publisher.command).wait_for("Publisher is running")
    assert rcyaml("record", f"{talk.name}.count", "--count", "3", "-o", "v.mcap").exit_code == 0
    write_tree(
        tmp_path,
        {"Arm.idsl.yaml": INTERFACES["Arm.idsl.yaml"].replace("count: {in: {n: int}}", "count: {in: {n: long}}")},
    )
    done = rcyaml("record", "play", "v.mcap")
    assert (
        done.exit_code == 2
        and "was recorded with another version of RoboCompArm.ArmEvents: 'count' differs" in done.output
    )


def of_a_radio(
    rcyaml: Rcyaml, name: str, tmp_path: Path, start: Start, manager: str, command: list[str | Path]
) -> None:
    """A component in another language publishes some events when it starts, which are recorded by their type."""
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    options = ["--storm", manager, "--type", "ArmEvents", "--count", "4", "-o", "r.mcap"]
    recorder = start([RCYAML, "record", name, *options], cwd=tmp_path).wait_for("recording")
    until(lambda: " 1 subscriber" in listed(rcyaml, name, manager), lambda: recorder.output)
    start(command)
    assert recorder.exit_code() == 0, recorder.output
    (channel, moved), *counts = decoded(tmp_path / "r.mcap")
    assert (channel, moved.pose.x, moved.pose.y, moved.pose.side) == (f"{name}/moved", 4.0, 2.5, 1)
    assert [(channel, values.n) for channel, values in counts] == [(f"{name}/count", n) for n in range(3)]


@needs_cpp
@pytest.mark.slow
def test_a_publisher_in_cpp(
    programs: CppPrograms, start: Start, icestorm: Storm, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    name = f"Cpp{time.monotonic_ns()}"
    properties = {"TopicManager.Proxy": icestorm.manager, "ArmEvents": name}
    of_a_radio(rcyaml, name, tmp_path, start, icestorm.manager, programs("Radio").command(tmp_path, properties))


@needs_java
@pytest.mark.slow
def test_a_publisher_in_java(
    program: Program,  # noqa: F811
    start: Start,
    icestorm: Storm,
    free_port: Ports,
    rcyaml: Rcyaml,
    tmp_path: Path,
) -> None:
    port, name = free_port(), f"Java{time.monotonic_ns()}"
    write_tree(tmp_path, {**INTERFACES, "rcyaml.yaml": "interfaces: [.]\n"})
    hand = start([RCYAML, "mock", "Hand", "--endpoint", f"Hand=tcp -h 127.0.0.1 -p {port}"], cwd=tmp_path)
    hand.wait_for("serving")
    properties = {
        "TopicManager.Proxy": icestorm.manager, "ArmEvents": name, "Arm.Endpoints": f"tcp -p {free_port()}",
        "HandProxy": f"hand:tcp -h 127.0.0.1 -p {port}",
    }  # fmt: skip
    of_a_radio(rcyaml, name, tmp_path, start, icestorm.manager, program("Radio", properties))


def test_tls_and_another_icestorm(
    talk: Talk,  # noqa: F811
    tls: dict[str, str],  # noqa: F811
    secure_storm: str,  # noqa: F811
    start: Start,
    rcyaml: Rcyaml,
    tmp_path: Path,
) -> None:
    """Recorded in a network without TLS, played into one with it, and recorded there again: the same values."""
    publisher = start(talk.publisher.command).wait_for("Publisher is running")
    assert rcyaml("record", talk.name, "--count", "12", "-o", "plain.mcap").exit_code == 0
    publisher.stop()
    secured = ["--storm", secure_storm, "--ice-config", "tls.cfg"]
    again = start(
        [RCYAML, "record", talk.name, "--type", "ArmEvents", "--count", "12", "-o", "tls.mcap", *secured], cwd=tmp_path
    ).wait_for("recording")
    done = rcyaml("record", "play", "plain.mcap", "--rate", "0", *secured, "--format", "json")
    assert json.loads(done.stdout)["sent"] == 12, done.output
    assert again.exit_code() == 0, again.output

    def values(name: str) -> list[str]:
        return [f"{channel} {message}" for channel, message in decoded(tmp_path / name)]

    assert values("tls.mcap") == values("plain.mcap")
    done = rcyaml("record", "play", "plain.mcap", "--storm", secure_storm)
    assert done.exit_code == 2 and "--ice-config FILE" in done.output


def test_a_full_disk(talk: Talk, start: Start, tmp_path: Path) -> None:  # noqa: F811
    """What was written before can be read."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(disk)], capture_output=True).returncode:
        pytest.skip("only root may mount a small disk")
    try:
        start(talk.publisher.command).wait_for("Publisher is running")
        recorder = start([RCYAML, "record", "-o", "disk/f.mcap", "--for", "30s"], cwd=tmp_path)
        assert recorder.exit_code() == 1
        assert "cannot write disk/f.mcap: no space left on device" in recorder.output, recorder.output
        assert "Traceback" not in recorder.output
        assert len(decoded(disk / "f.mcap")) > 10
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["ArmEvent"], "did you mean 'ArmEvents'?"),
        (["-o", "there.mcap"], "there.mcap exists already, and is kept as it is"),
        (["-o", "no/folder/x.mcap"], "cannot write no/folder/x.mcap"),
        (["--max-size", "big"], "'big' is not a size, such as 500MB or 2GB"),
        (["info", "there.mcap"], "there.mcap is not an MCAP file"),
        (["play", "there.mcap"], "there.mcap is not an MCAP file"),
        (["info", "short.mcap"], "short.mcap is not an MCAP file"),
        (["play", "empty.mcap"], "empty.mcap is not an MCAP file"),
        (["info", "nowhere.mcap"], "nowhere.mcap"),
    ],
)
def test_what_cannot_be_done(rcyaml: Rcyaml, icestorm: Storm, tmp_path: Path, words: list[str], said: str) -> None:
    cdsl = "component: P\nlanguage: python\nimports: [Types, Arm]\npublishes: [ArmEvents]\n"
    write_tree(
        tmp_path,
        {**INTERFACES, "p/p.cdsl.yaml": cdsl, "rcyaml.yaml": "interfaces: [.]\n", "there.mcap": "no file of MCAP " * 9,
         "short.mcap": "MCAP", "empty.mcap": ""},
    )  # fmt: skip
    recording = words[0] not in ("info", "play")
    done = rcyaml("record", *words, *(["--storm", icestorm.manager, "--for", "1s"] if recording else []))
    assert done.exit_code == 2
    assert said in done.output
    assert (tmp_path / "there.mcap").read_text() == "no file of MCAP " * 9


def test_damaged_files(talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path) -> None:  # noqa: F811
    """Whatever is lost or wrong in a file: it is read, or refused in words."""
    start(talk.publisher.command).wait_for("Publisher is running")
    assert rcyaml("record", "-o", "good.mcap", "--count", "20").exit_code == 0
    good, chance, refused = (tmp_path / "good.mcap").read_bytes(), random.Random(4), 0
    for number in range(60):
        data, at = bytearray(good), chance.randrange(len(good))
        if number % 3 == 0:
            del data[at:]
        elif number % 3 == 1:
            del data[at : at + 7]
        else:
            data[at] ^= 0x55
        (tmp_path / "damaged.mcap").write_bytes(data)
        for words in (["info", "damaged.mcap"], ["play", "damaged.mcap", "--rate", "0"]):
            done = rcyaml("record", *words)
            assert done.exit_code in (0, 2) and (done.exception is None or isinstance(done.exception, SystemExit)), (
                f"{number} {words}: {done.output} {done.exception!r}"
            )
            refused += done.exit_code
    assert refused > 40
