"""TCP ports of a network: explicit, counted for instances, distinct defaults, and the endpoints of adapters."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import deployed, faults, network, said
from robocomp_yaml.addresses.port_numbers import default_port
from robocomp_yaml.network.network import Network


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


TWO_HOSTS = "hosts: {onboard: 10.0.0.2, head: {address: 10.0.0.3, user: robocomp}}\n"


def ports(found: Network) -> dict[str, int]:
    return {f"{name}.{e.interface}": e.port for name, process in found.processes.items() for e in process.endpoints}


def texts(found: Network) -> dict[str, str]:
    return {f"{name}.{e.interface}": e.text for name, process in found.processes.items() for e in process.endpoints}


def test_port_is_for_the_first_interface_and_the_others_have_defaults() -> None:
    found = ports(network(deployed("components: {ears: {component: mouth, port: 10001}}\n")))
    assert found == {"ears.Mouth": 10001, "ears.CommonBehavior": default_port("ears", "CommonBehavior")}


def test_port_of_a_component_without_interfaces_is_for_common_behavior() -> None:
    assert ports(network(deployed("components: {a: {component: idle, port: 10001}}\n", idle=""))) == {
        "a.CommonBehavior": 10001
    }


def test_ports_by_name() -> None:
    found = ports(network(deployed("components: {a: {component: mouth, ports: {Mouth: 1, CommonBehavior: 2}}}\n")))
    assert found == {"a.Mouth": 1, "a.CommonBehavior": 2}


def test_an_endpoint_in_the_syntax_of_ice() -> None:
    found = network(deployed('components: {a: {component: mouth, endpoints: {Mouth: "ssl -p 10007 -t 500"}}}\n'))
    (mouth, _) = found.processes["a"].endpoints
    assert (mouth.text, mouth.port, mouth.protocol) == ("ssl -h 127.0.0.1 -p 10007 -t 500", 10007, "ssl")
    assert found.processes["a"].ready.pings[0] == "mouth:ssl -h localhost -p 10007"


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("port: 10010", [10010, 10011, 10012]),
        ("ports: {Mouth: 10010, CommonBehavior: 10011}", [10010, 10012, 10014]),
    ],
)
def test_instances_count_up_by_the_number_of_entries(given: str, expected: list[int]) -> None:
    found = ports(network(deployed(f'components: {{"m{{i}}": {{component: mouth, instances: 3, {given}}}}}\n')))
    assert [found[f"m{number}.Mouth"] for number in range(3)] == expected
    assert len(set(found.values())) == 6


def test_defaults_depend_on_names_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robocomp_yaml.addresses.port_numbers.default_port", lambda owner, interface, ports: 11310)
    one = ports(network(deployed("components: {a: {component: mouth}, b: {component: mouth}}\n")))
    assert one == {"a.CommonBehavior": 11310, "a.Mouth": 11312, "b.CommonBehavior": 11313, "b.Mouth": 11314}
    other = ports(network(deployed("components: {b: {component: mouth}, a: {component: mouth}}\n")))
    assert other == one


def test_an_explicit_port_displaces_a_default() -> None:
    taken = default_port("a", "Mouth")
    found = ports(
        network(
            deployed(f"components: {{a: {{component: mouth}}, p: {{program: sh, endpoints: {{X: tcp -p {taken}}}}}}}\n")
        )
    )
    assert found["a.Mouth"] == taken + 1


def test_each_host_has_its_own_ports() -> None:
    found = network(
        deployed(
            TWO_HOSTS + "components:\n  a: {component: mouth, host: head, port: 10001}\n"
            "  b: {component: mouth, host: onboard, port: 10001}\n"
        )
    )
    assert (texts(found)["a.Mouth"], texts(found)["b.Mouth"]) == (
        "tcp -h 10.0.0.3 -p 10001",
        "tcp -h 10.0.0.2 -p 10001",
    )
    assert found.processes["a"].ready.pings[0] == "mouth:tcp -h 10.0.0.3 -p 10001"
    assert found.hosts["head"].ssh.user == "robocomp" and found.is_distributed


@pytest.mark.parametrize(
    ("hosts", "text", "proxy"),
    [
        ("", "tcp -h 127.0.0.1 -p 10001", "tcp -h localhost -p 10001"),
        ("hosts: {here: 127.0.0.2}\n", "tcp -h 127.0.0.2 -p 10001", "tcp -h 127.0.0.2 -p 10001"),
        ("hosts: {here: robot.local}\n", "tcp -h robot.local -p 10001", "tcp -h robot.local -p 10001"),
        ('hosts: {here: "fd00::2"}\n', 'tcp -h "fd00::2" -p 10001', 'tcp -h "fd00::2" -p 10001'),
    ],
)
def test_where_a_component_listens_and_is_reached(hosts: str, text: str, proxy: str) -> None:
    found = network(deployed(f"{hosts}components: {{a: {{component: mouth, port: 10001}}}}\n"))
    assert texts(found)["a.Mouth"] == text
    assert found.processes["a"].ready.pings[0] == f"mouth:{proxy}"


def test_a_port_that_is_counted_too_high() -> None:
    (found,) = faults(deployed('components: {"m{i}": {component: mouth, instances: 9, port: 65530}}\n'))
    assert said(found) == ("RC4302", "robot.ddsl.yaml", 2, 61)
    assert "'m6' would have port 65536" in found.message


def test_a_port_for_the_events_of_a_topic() -> None:
    found = network(
        deployed(
            "services: {storm: {icestorm: {}}}\ncomponents:\n  ears: {component: ears}\n"
            '  "mind{i}": {component: mind, instances: 2, ports: {Heard: 10010}}\n',
            ears="publishes: [Heard]\n",
            mind="subscribes: [Heard]\n",
        )
    )
    assert [texts(found)[f"mind{number}.HeardTopic"] for number in range(2)] == [
        "tcp -h 127.0.0.1 -p 10010",
        "tcp -h 127.0.0.1 -p 10011",
    ]
    assert all("heard" not in ping for ping in found.processes["mind0"].ready.pings)
