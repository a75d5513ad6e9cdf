"""Where processes listen, and what others get as their addresses: `listen:` of hosts and entries."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import config, deployed, network
from robocomp_yaml.network.listening import listening
from robocomp_yaml.network.network import Network, NetworkHost
from robocomp_yaml.source.ice_endpoint import completed, parse_endpoints


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def texts(found: Network) -> dict[str, str]:
    processes = found.processes.values()
    return {f"{one.name}.{served.interface}": served.text for one in processes for served in one.endpoints}


HOSTS = "hosts: {{here: {{address: 10.0.0.2{}}}, there: 10.0.0.3}}\n"


def of(host: str = "", entry: str = "", more: str = "") -> Network:
    components = f"components:\n  a: {{component: mouth, host: here, port: 10001{entry}}}\n"
    return network(deployed(HOSTS.format(host) + more + components))


@pytest.mark.parametrize(
    ("host", "entry", "text", "published"),
    [
        ("", "", "tcp -h 10.0.0.2 -p 10001", ""),
        (", listen: address", "", "tcp -h 10.0.0.2 -p 10001", ""),
        (", listen: any", "", "tcp -p 10001", "tcp -h 10.0.0.2 -p 10001"),
        ("", ", listen: any", "tcp -p 10001", "tcp -h 10.0.0.2 -p 10001"),
        (", listen: any", ", listen: address", "tcp -h 10.0.0.2 -p 10001", ""),
        (", listen: [address, any]", "", "tcp -p 10001", "tcp -h 10.0.0.2 -p 10001"),
        (
            ", listen: [address, 192.168.1.5]", "",
            "tcp -h 10.0.0.2 -p 10001:tcp -h 192.168.1.5 -p 10001", "tcp -h 10.0.0.2 -p 10001",
        ),
        (
            ", listen: [wifi.local, address, address]", "",
            "tcp -h wifi.local -p 10001:tcp -h 10.0.0.2 -p 10001", "tcp -h 10.0.0.2 -p 10001",
        ),
        (", listen: 192.168.1.5", "", "tcp -h 192.168.1.5 -p 10001", ""),
        (', listen: "fd00::2"', "", 'tcp -h "fd00::2" -p 10001', ""),
    ],
)  # fmt: skip
def test_listen_of_a_host_and_of_an_entry(host: str, entry: str, text: str, published: str) -> None:
    found = of(host, entry)
    assert texts(found)["a.Mouth"] == text
    properties = config(found.processes["a"])
    assert properties["Mouth.Endpoints"] == text
    assert properties.get("Mouth.PublishedEndpoints", "") == published


@pytest.mark.parametrize(
    ("listen", "at"),
    [("", "10.0.0.2"), (", listen: any", "10.0.0.2"), (", listen: 192.168.1.5", "192.168.1.5"),
     (", listen: [192.168.1.5, address]", "10.0.0.2")],
)  # fmt: skip
def test_others_call_the_address_on_which_it_listens(listen: str, at: str) -> None:
    assert of(listen).processes["a"].ready.pings[0] == f"mouth:tcp -h {at} -p 10001"


@pytest.mark.parametrize(
    ("listen", "manager", "published"),
    [("", "tcp -h 10.0.0.2 -p 9999", None), (", listen: any", "tcp -p 9999", "tcp -h 10.0.0.2 -p 9999")],
)
def test_icestorm_and_subscribers(listen: str, manager: str, published: str | None) -> None:
    """A subscriber has no fixed port: it listens only where others reach it."""
    text = HOSTS.format(listen) + (
        "services: {storm: {icestorm: {host: here, publish: 9998}}}\n"
        "components: {ears: {component: ears, host: there}, mind: {component: mind, host: here}}\n"
    )
    found = network(deployed(text, ears="publishes: [Heard]\n", mind="subscribes: [Heard]\n"))
    storm = config(found.processes["storm"])
    assert storm["IceStorm.TopicManager.Endpoints"] == manager
    assert storm.get("IceStorm.TopicManager.PublishedEndpoints") == published
    assert storm.get("IceStorm.Publish.PublishedEndpoints") == (published and published.replace("9999", "9998"))
    assert config(found.processes["mind"])["HeardTopic.Endpoints"] == "tcp -h 10.0.0.2 -p 0"


def test_without_hosts_it_is_the_loopback_address_unless_the_entry_says_otherwise() -> None:
    found = network(deployed("components:\n  a: {component: mouth, port: 1}\n  b: {component: mouth, listen: any}\n"))
    assert texts(found)["a.Mouth"] == "tcp -h 127.0.0.1 -p 1"
    assert texts(found)["b.Mouth"].startswith("tcp -p ")
    assert "Mouth.PublishedEndpoints" not in config(found.processes["b"])


@pytest.mark.parametrize(
    ("text", "protocol", "made"),
    [
        ("tcp -p 1", "tcp", "tcp -h 10.0.0.2 -p 1"),
        (" tcp -p 1 -t 500 ", "tcp", "tcp -h 10.0.0.2 -p 1 -t 500"),
        ("tcp -h * -p 1", "tcp", "tcp -h * -p 1"),
        ("tcp -h 10.1.1.1 -p 1:udp -p 2", "tcp", "tcp -h 10.1.1.1 -p 1:udp -h 10.0.0.2 -p 2"),
        ("tcp -p 1", "ssl", "ssl -h 10.0.0.2 -p 1"),
        ("default -p 1:ws -h a -p 2:udp -p 3", "ssl", "ssl -h 10.0.0.2 -p 1:wss -h a -p 2:udp -h 10.0.0.2 -p 3"),
        ('tcp -h "fd00::1" -p 1', "ssl", 'ssl -h "fd00::1" -p 1'),
        ("tpc -p 1", "ssl", "tpc -p 1"),
    ],
)
def test_endpoints_of_a_document_are_completed(text: str, protocol: str, made: str) -> None:
    assert completed(text, ("10.0.0.2",), protocol) == made


def test_several_addresses_complete_an_endpoint_several_times() -> None:
    made = completed("tcp -p 1 -z", ("10.0.0.2", "fd00::2"), "tcp")
    assert made == 'tcp -h 10.0.0.2 -p 1 -z:tcp -h "fd00::2" -p 1 -z'
    assert [one.host for one in parse_endpoints(made)] == ["10.0.0.2", "fd00::2"]


def test_without_an_address_for_others_an_adapter_without_a_port_follows_listen() -> None:
    found = listening(NetworkHost("here"), ("any",))
    assert found.endpoints(0) == "tcp -p 0" and not found.published(7)


@pytest.mark.parametrize("address", ["::1", "fd00::2", "::ffff:10.0.0.2", "fe80::1%eth0"])
@pytest.mark.parametrize("spelling", ['"{}"', '{{address: "{}"}}'])
def test_a_host_can_have_an_ipv6_address(address: str, spelling: str) -> None:
    components = "components:\n  a: {component: mouth, port: 10001}\n"
    found = network(deployed(f"hosts: {{here: {spelling.format(address)}}}\n{components}"))
    assert found.hosts["here"].address == address
    assert f"{address}" in texts(found)["a.Mouth"]
