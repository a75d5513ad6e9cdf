"""From a network to one that can be started: addresses for names, and tokens."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from deployments import analysed, config, deployed, network
from robocomp_yaml.deploy import own_address, protection
from robocomp_yaml.deploy.differences import differences
from robocomp_yaml.deploy.engine import RUNNING, Running
from robocomp_yaml.deploy.plan import KEEP, RESTART, plan
from robocomp_yaml.deploy.preparing import prepared
from robocomp_yaml.deploy.spec import spec_of
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost
from robocomp_yaml.source import properties

TWO = "hosts: {here: %s, there: 10.0.0.3}\ncomponents: {a: {component: mouth, host: here, port: 10001}}\n"


@pytest.fixture(autouse=True)
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    return tmp_path


def named(monkeypatch: pytest.MonkeyPatch, addresses: list[str], towards: str = "10.0.0.2") -> Network:
    """A network with a host `robot`, which has these addresses."""
    monkeypatch.setattr(own_address, "_addresses", lambda name: addresses)
    monkeypatch.setattr(own_address, "towards_address", lambda address: towards)
    return network(deployed(TWO % "robot"))


@pytest.mark.parametrize(
    ("addresses", "towards", "text"),
    [
        (["10.0.0.7"], "10.0.0.2", "tcp -h 10.0.0.7 -p 10001"),
        (["127.0.1.1", "10.0.0.7"], "10.0.0.2", "tcp -h 10.0.0.7 -p 10001"),
        (["127.0.1.1"], "10.0.0.2", "tcp -h 10.0.0.2 -p 10001"),  # Debian's own name
        (["127.0.1.1"], "127.0.0.1", "tcp -p 10001"),
        (["fd00::7"], "10.0.0.2", 'tcp -h "fd00::7" -p 10001'),
        ([], "10.0.0.2", "tcp -p 10001"),  # `up` reports that it is unknown
    ],
)
def test_a_process_listens_on_the_address_of_a_name(
    monkeypatch: pytest.MonkeyPatch, addresses: list[str], towards: str, text: str
) -> None:  # fmt: skip
    found = prepared(named(monkeypatch, addresses, towards), create=False)
    assert config(found.processes["a"])["Mouth.Endpoints"] == text
    assert found.processes["a"].endpoints[0].text == text
    assert found.processes["a"].ready.pings[0] == "mouth:tcp -h robot -p 10001", "others use the name"


def test_proxies_to_the_same_host_keep_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_address, "_addresses", lambda name: ["10.0.0.7"])
    text = TWO % "robot"
    text = text.replace("components: {", "components: {b: {component: ears, host: here, connect: {Mouth: a}}, ")
    found = prepared(network(deployed(text, ears="requires: [Mouth]\n")), create=False)
    assert config(found.processes["b"])["MouthProxy"] == "mouth:tcp -h robot -p 10001"


def test_the_token_is_made_once_and_only_in_configurations_of_components(state: Path) -> None:
    text = "components: {a: {component: mouth}, p: {program: sh, config: x.conf}}\n"
    given = network({**deployed(text), "x.conf": "a=1\n"})
    given = replace(given, folder=f"{state}/Robot")
    assert not protection.token_of(given.folder)
    one, two = prepared(given, create=True), prepared(given, create=True)
    token = protection.token_of(given.folder)
    assert len(token) == 64 and config(one.processes["a"])["RcYaml.Token"] == token
    assert one.processes == two.processes
    assert one.processes["p"] == given.processes["p"]
    (file,) = state.glob("rcyaml/deployments/*/token")
    assert file.stat().st_mode & 0o777 == 0o600 and file.parent.stat().st_mode & 0o777 == 0o700


def test_a_plan_never_shows_the_token_and_finds_nothing_to_do(state: Path) -> None:
    given = replace(network(deployed("components: {a: {component: mouth}}\n")), folder=f"{state}/Robot")
    old = spec_of(given, given.processes["a"], {})
    new = prepared(given, create=True)
    found = differences(old, spec_of(new, new.processes["a"], {}))
    assert [str(one) for one in found] == ["config RcYaml.Control: token (new)", "config RcYaml.Token: *** (new)"]
    here = Running("a", old, "localhost", RUNNING)
    made = plan(new, {"a": here})
    assert made.steps["a"].action == RESTART, "an earlier version started it"
    again = plan(prepared(given, create=False), {"a": replace(here, spec=spec_of(new, new.processes["a"], {}))})
    assert again.steps["a"].action == KEEP


def test_open_control_needs_no_token(state: Path) -> None:
    (note,), given = analysed_open()
    assert (note.code, note.severity) == ("RC4111", "note")
    given = replace(given, folder=f"{state}/Robot")
    found = config(prepared(given, create=True).processes["a"])
    assert found["RcYaml.Control"] == "open" and "RcYaml.Token" not in found
    assert not protection.token_of(given.folder)


def analysed_open() -> tuple[list[Diagnostic], Network]:
    analysis = analysed(deployed("control: open\ncomponents: {a: {component: mouth}}\n"))
    (found,) = analysis.networks.values()
    return list(analysis.diagnostics), found


@pytest.mark.parametrize(
    ("proxy", "is_sent"),
    [
        ("commonbehavior:tcp -h 127.0.0.1 -p 1", True),
        ("commonbehavior:tcp -h localhost -p 1", True),
        ("commonbehavior:ssl -h 192.0.2.9 -p 1", True),
        ("commonbehavior:tcp -h 192.0.2.9 -p 1", False),
        ("commonbehavior:ssl -h 192.0.2.9 -p 1:tcp -h 192.0.2.9 -p 2", False),
    ],
)
def test_the_token_is_not_sent_in_plain_text_to_another_host(state: Path, proxy: str, is_sent: bool) -> None:
    given = Network("Robot", "/robot.ddsl.yaml", f"{state}/Robot")
    protection.made_token(given.folder)
    assert protection.context(given, proxy) == (
        {"rcyaml.token": protection.token_of(given.folder)} if is_sent else {}
    )  # fmt: skip


def test_a_full_config_ends_with_the_token(state: Path) -> None:
    """Of two lines for one property Ice uses the last: nobody's own one replaces it."""
    files = deployed("components: {a: {component: mouth}}\n")
    given = network({**files, "mouth/etc/config": "RcYaml.Token=mine\nRcYaml.Control=none\n"})
    found = prepared(replace(given, folder=f"{state}/Robot"), create=True).processes["a"]
    assert found.config is not None
    values = properties.read(found.config.text).values
    assert len(values["RcYaml.Token"]) == 64 and values["RcYaml.Control"] == "token"


def test_hosts_by_addresses_are_not_resolved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_address, "_addresses", lambda name: pytest.fail(name))
    for address in ("10.0.0.2", "fd00::2", "localhost", "127.0.0.2"):
        assert own_address.own_address(NetworkHost("h", address), []) == address
