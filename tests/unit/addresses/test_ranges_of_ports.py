"""`ports:` of a workspace and of a deployment: defaults in that range, given ports left out, a full and an empty range."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from deployments import analysed, deployed, faults, network
from robocomp_yaml.addresses.port_numbers import FreePorts, default_port
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.network.network import Network
from robocomp_yaml.pipeline import analyse

BOTH = "components: {speech: {component: speech}, lips: {component: mouth}}\n"
STORM = "services: {storm: {icestorm: MORE}}\ncomponents: {ears: {component: ears}, a: {component: talks}}\n"
TOPICS = {"ears": "subscribes: [Heard]\n", "talks": "publishes: [Heard]\n"}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def ports(found: Network) -> dict[str, int]:
    return {f"{name}.{e.interface}": e.port for name, process in found.processes.items() for e in process.endpoints}


def test_a_default_is_in_the_range() -> None:
    small = PortRange(12000, 12009)
    found = [default_port(f"Comp{number}", "CommonBehavior", small) for number in range(200)]
    assert min(found) == 12000 and max(found) == 12009


def test_a_range_is_used_up_to_its_last_port() -> None:
    free, small = FreePorts([12001]), PortRange(12000, 12003)
    assert sorted(free.assign("A", f"I{number}", small) for number in range(3)) == [12000, 12002, 12003]
    assert not free.missing and free.assign("A", "I9", small) == 0
    (found,) = free.diagnostics()
    assert found.code == "RC6011" and "12000–12003" in found.message and "A's I9" in found.message


def test_the_range_of_a_deployment() -> None:
    found = ports(network(deployed("ports: {from: 12000, to: 12099}\n" + BOTH)))
    assert all(12000 <= number <= 12099 for number in found.values()) and len(set(found.values())) == 4


def test_without_a_range_defaults_are_as_ever() -> None:
    found = ports(network(deployed(BOTH)))
    assert found["speech.Speech"] == 27354 and found["lips.Mouth"] == default_port("lips", "Mouth")


def test_a_deployment_has_the_range_of_its_workspace() -> None:
    tree = {**deployed(BOTH), "rcyaml.yaml": "ports: {from: 12000, to: 12099}\n"}
    assert all(12000 <= number <= 12099 for number in ports(network(tree)).values())
    own = {**deployed("ports: {from: 13000, to: 13099}\n" + BOTH), "rcyaml.yaml": "ports: {from: 12000, to: 12099}\n"}
    assert all(13000 <= number <= 13099 for number in ports(network(own)).values())


def test_an_included_deployment_has_its_own_range() -> None:
    tree = deployed(
        "ports: {from: 12000, to: 12099}\ninclude: {left: a.ddsl.yaml, right: b.ddsl.yaml}\n",
        **{"a.ddsl.yaml": "deployment: A\ncomponents: {m: {component: mouth}}\n",
           "b.ddsl.yaml": "deployment: B\nports: {from: 13000, to: 13099}\ncomponents: {m: {component: mouth}}\n"},
    )  # fmt: skip
    found = ports(network(tree))
    assert 12000 <= found["left.m.Mouth"] <= 12099 and 13000 <= found["right.m.Mouth"] <= 13099


def test_ports_that_are_set_are_left_out() -> None:
    text = "ports: {from: 12000, to: 12003}\ncomponents: {speech: {component: speech, port: 12001}, lips: {component: mouth}}\n"
    found = ports(network(deployed(text)))
    assert found["speech.Speech"] == 12001 and sorted(found.values()) == [12000, 12001, 12002, 12003]


def test_a_full_range_is_reported_at_its_line() -> None:
    (found,) = faults(deployed("ports: {from: 12000, to: 12002}\n" + BOTH))
    assert (found.code, found.span.file, found.span.line, found.span.column) == ("RC6011", "robot.ddsl.yaml", 2, 8)


def test_an_empty_range_is_reported() -> None:
    (found,) = faults(deployed("ports: {from: 12002, to: 12000}\n" + BOTH))
    assert (found.code, found.span.line) == ("RC6012", 2) and "{from: 12000, to: 12002}" in found.hint
    tree = {**deployed(BOTH), "rcyaml.yaml": "interfaces: []\nports: {from: 12002, to: 12000}\n"}
    (found,) = faults(tree)
    assert (found.code, found.span.file, found.span.line) == ("RC6012", "rcyaml.yaml", 2)


def test_the_ports_of_an_icestorm() -> None:
    plain = ports(network(deployed(STORM.replace("MORE", "{}"), **TOPICS)))
    assert plain["storm.TopicManager"] == 9999 and 10000 <= plain["storm.Publish"] <= 29999
    both = ports(network(deployed(STORM.replace("MORE", "{port: 9001, publish: 9002}"), **TOPICS)))
    assert (both["storm.TopicManager"], both["storm.Publish"]) == (9001, 9002)
    ranged = ports(network(deployed("ports: {from: 12000, to: 12099}\n" + STORM.replace("MORE", "{}"), **TOPICS)))
    assert all(12000 <= ranged[f"storm.{name}"] <= 12099 for name in ("TopicManager", "Publish"))


def test_the_publish_port_of_an_icestorm_can_conflict() -> None:
    (found,) = faults(deployed(STORM.replace("MORE", "{port: 9001, publish: 9001}"), **TOPICS))
    assert (found.code, found.span.line) == ("RC4303", 2)


def test_a_workspace_writes_first_configs_in_its_range() -> None:
    write_tree(Path(), {**deployed("components: {}\n"), "rcyaml.yaml": "ports: {from: 12000, to: 12099}\n"})
    analysis = analyse(["."])
    table = analysis.addresses.table(next(iter(analysis.program.components.values())))
    numbers = [endpoint.port for endpoint in table.endpoints.values()]
    assert len(set(numbers)) == 4 and all(12000 <= number <= 12099 for number in numbers)


def test_a_full_range_of_a_workspace_is_reported() -> None:
    tree = {**deployed("components: {}\n"), "rcyaml.yaml": "ports: {from: 12000, to: 12001}\n"}
    found = [one for one in analysed(tree, folder=True).diagnostics if one.code == "RC6011"]
    assert [(one.span.file, one.span.line) for one in found] == [("rcyaml.yaml", 1)]


@pytest.mark.parametrize(
    "wrong", ["[1, 2]", "12000", "{from: 0, to: 10}", "{from: 1}", "{from: 1, to: 70000}", "{from: a, to: 3}"]
)
def test_a_wrong_range(wrong: str) -> None:
    found = faults(deployed(f"ports: {wrong}\n" + BOTH))
    assert found and {(one.severity, one.span.line) for one in found} == {("error", 2)}
