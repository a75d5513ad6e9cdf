"""`ready: {ping: …}`: a proxy that must answer, which nobody serves because of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import deployed, faults, network

HOSTS = "hosts: {one: 10.0.0.2, two: 10.0.0.3}\n"


@pytest.fixture(autouse=True)
def _in_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(("text", "expected"), [
    ("laser:tcp -p 10003", "laser:tcp -h 10.0.0.3 -p 10003"),
    ("laser:tcp -h localhost -p 10003", "laser:tcp -h 10.0.0.3 -p 10003"),
    ("laser:tcp -h 127.0.0.1 -p 10003", "laser:tcp -h 10.0.0.3 -p 10003"),
    ("laser:tcp -h 10.0.0.9 -p 10003", "laser:tcp -h 10.0.0.9 -p 10003"),
    ("left/laser -t:tcp -p 1:tcp -h other -p 2", "left/laser -t:tcp -h 10.0.0.3 -p 1:tcp -h other -p 2"),
])  # fmt: skip
def test_the_proxy_is_on_the_host_of_the_process(text: str, expected: str) -> None:
    entries = f'components: {{laser: {{program: hokuyo, host: two, ready: {{ping: "{text}", within: 3 s}}}}}}\n'
    process = network(deployed(HOSTS + entries)).processes["laser"]
    assert process.ready.pings == (expected,) and process.ready.within == 3.0
    assert not process.endpoints and process.is_server


def test_several_processes_may_name_the_same_proxy() -> None:
    entry = '{program: mission, ready: {ping: "commonbehavior:tcp -p 11247"}}'
    assert not faults(deployed(f"components: {{a: {entry}, b: {entry}}}\n"))


def test_it_is_what_is_asked_while_the_process_runs() -> None:
    entry = '{program: laser, endpoints: {Laser: tcp -p 1}, ready: {ping: "other:tcp -p 2"}, alive: on}'
    alive = network(deployed(f"components: {{a: {entry}}}\n")).processes["a"].alive
    assert alive is not None and alive.proxy == "other:tcp -h localhost -p 2"


def test_the_number_of_an_instance() -> None:
    entries = 'components: {"a{i}": {program: laser, instances: 2, ready: {ping: "laser{i}:tcp -p 1000{i}"}}}\n'
    pings = [process.ready.pings for process in network(deployed(entries)).processes.values()]
    assert pings == [("laser0:tcp -h localhost -p 10000",), ("laser1:tcp -h localhost -p 10001",)]


@pytest.mark.parametrize(
    ("text", "code"), [("laser", "RC4130"), ("laser:tcp -q 3", "RC4015"), ("laser @ Left", "RC4130")]
)
def test_what_cannot_be_asked(text: str, code: str) -> None:
    (fault,) = faults(deployed(f'components: {{a: {{program: laser, ready: {{ping: "{text}"}}}}}}\n'))
    assert fault.code == code
