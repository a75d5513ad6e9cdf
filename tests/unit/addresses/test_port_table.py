"""Default ports are stable and different; ports that users set are compared."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.addresses import clashes, port_numbers, table
from robocomp_yaml.addresses.own import adapters
from robocomp_yaml.addresses.port_numbers import default_port
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint
from talk import component, workspace


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def numbers(linked: dict[str, LinkedComponent], assigned: table.PortTable) -> dict[str, int]:
    return {
        f"{folder}.{name}": assigned.endpoint(one, name).port
        for folder, one in linked.items()
        for name in adapters(one)
    }


def test_default_ports_never_change() -> None:
    assert default_port("SpeechComp", "Speech") == 14740
    assert default_port("SpeechComp", "CommonBehavior") == 29956


def test_the_range_avoids_icestorm_and_ephemeral_ports() -> None:
    found = [default_port(f"Comp{number}", "CommonBehavior") for number in range(5000)]
    assert min(found) >= 10000 and max(found) < 32768
    assert len(set(found)) > 4000


def test_the_later_name_gets_the_next_port(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_numbers, "default_port", lambda owner, interface, ports: 11310)
    linked = workspace({"z": component("A", implements="[Mouth, Speech]"), "a": component("B", implements="[Mouth]")})
    for order in (list(linked.values()), list(linked.values())[::-1]):
        assert numbers(linked, table.assign(order, Disk())) == {
            "z.CommonBehavior": 11310,
            "z.Mouth": 11312,
            "z.Speech": 11313,
            "a.CommonBehavior": 11314,
            "a.Mouth": 11315,
        }, "11311 is ROS 1's"


def test_the_range_is_a_ring(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_numbers, "default_port", lambda owner, interface, ports: 29999)
    linked = workspace({"a": component("A", implements="[Mouth]")})
    assert [e.port for e in table.assign(linked.values(), Disk()).endpoints.values()] == [29999, 10000]


def test_a_port_in_a_config_is_reserved() -> None:
    port = default_port("A", "Mouth")
    linked = workspace(
        {"a": component("A", implements="[Mouth]"), "b": component("B", implements="[Speech]")},
        b=f"Speech.Endpoints=tcp -p {port}\n",
    )
    assigned = numbers(linked, table.assign(linked.values(), Disk()))
    assert assigned["b.Speech"] == port
    assert assigned["a.Mouth"] == port + 1


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("tcp -p 10", IceEndpoint(10)),
        ('"tcp -p 10"', IceEndpoint(10)),
        ("ws -h 1.2.3.4 -p 10", IceEndpoint(10, "ws", "1.2.3.4")),
        ("udp -p 10:tcp -p 11", IceEndpoint(10, "udp")),
        ("tcp -h * -p 10", IceEndpoint(10)),
        ("tcp -p 0", None),
        ("tcp", None),
        ("tcp -p x", None),
        ("tcp -p 70000", None),
        ("", None),
        ("tcp -p ²", None),
        ("tcpx -p 1", None),
    ],
)
def test_endpoints(value: str, expected: IceEndpoint | None) -> None:
    assert parse_endpoint(value) == expected


def test_clashes_are_reported_at_their_line() -> None:
    linked = workspace(
        {"a": component("A", implements="[Mouth]"), "b": component("B", implements="[Mouth]")},
        a="Mouth.Endpoints=tcp -p 12000\nX.Endpoints=udp -p 12000\n",
        b="# mine\n\n  Mouth.Endpoints=tcp -p 12000\nCommonBehavior.Endpoints=tcp -p 12001\n",
    )
    (said,) = clashes.clashes(linked.values(), Disk())
    assert (said.code, said.severity) == ("RC6008", "warning")
    assert (said.span.file, said.span.line, said.span.column, said.span.end_column) == ("b/etc/config", 3, 3, 18)
    assert said.message == "port 12000 of B's Mouth is also the port of A's Mouth"
    assert (said.related[0].span.file, said.related[0].span.line) == ("a/etc/config", 1)


def test_different_hosts_do_not_clash() -> None:
    documents = {"a": component("A", implements="[Mouth]"), "b": component("B", implements="[Mouth]")}
    linked = workspace(documents, a="Mouth.Endpoints=tcp -h x -p 1\n", b="Mouth.Endpoints=tcp -h y -p 1\n")
    assert not clashes.clashes(linked.values(), Disk())
    linked = workspace(documents, a="Mouth.Endpoints=tcp -h x -p 1\n", b="Mouth.Endpoints=tcp -p 1\n")
    assert len(clashes.clashes(linked.values(), Disk())) == 1


def test_a_config_that_cannot_be_read_is_ignored(tmp_path: Path) -> None:
    linked = workspace({"a": component("A")})
    (tmp_path / "a/etc/config").mkdir(parents=True)
    assert not clashes.clashes(linked.values(), Disk())
    assert table.assign(linked.values(), Disk()).endpoints
