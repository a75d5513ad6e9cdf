"""Topics of a network: names after renames and prefixes, their IceStorm, publishers and subscribers."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import FACE, component, config, deployed, faults, network, said
from robocomp_yaml.network.network import ICESTORM, TOPIC, Network

STORM = "services: {storm: {icestorm: {}}}\n"
BOTH = "components:\n  ears: {component: ears}\n  mind: {component: mind}\n"
EARS, MIND = "publishes: [Heard]\n", "subscribes: [Heard]\n"
ENDS = {"ears": EARS, "mind": MIND}


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def lines(found: Network) -> set[tuple[str, str, str, bool]]:
    return {(line.source, line.target, line.topic, line.is_out) for line in found.connections if line.kind == TOPIC}


def test_both_ends_are_connected_to_the_storm() -> None:
    found = network(deployed(STORM + BOTH, **ENDS))
    assert lines(found) == {("ears", "storm", "Heard", True), ("mind", "storm", "Heard", False)}
    assert found.order == (("storm",), ("ears", "mind"))
    manager = "IceStorm/TopicManager:tcp -h localhost -p 9999"
    assert config(found.processes["ears"])["TopicManager.Proxy"] == manager
    assert config(found.processes["mind"])["HeardTopic.Endpoints"] == "tcp -h 127.0.0.1 -p 0"


def test_the_storm_is_a_process() -> None:
    found = network(deployed("services: {storm: {icestorm: {port: 9998}}}\n" + BOTH, **ENDS))
    storm = found.processes["storm"]
    assert (storm.kind, storm.command) == (ICESTORM, ("icebox", "--Ice.Config={config}"))
    assert storm.folders == (f"{found.folder}/state/storm",)
    assert storm.ready.pings == ("IceStorm/TopicManager:tcp -h localhost -p 9998",)
    settings = config(storm)
    assert settings["IceStorm.TopicManager.Endpoints"] == "tcp -h 127.0.0.1 -p 9998"
    assert settings["IceStorm.LMDB.Path"] == storm.folders[0]


def test_a_storm_without_users_is_not_started() -> None:
    found = network(deployed(STORM + "components: {mouth: {component: mouth}}\n"))
    assert not found.processes["storm"].enabled and found.order == (("mouth",),)
    unused = "components: {ears: {component: ears, enabled: false}}\n"
    assert not network(deployed(STORM + unused, ears=EARS)).processes["storm"].enabled


def test_a_rename_removes_the_prefix() -> None:
    values = "component: ../ears.cdsl.yaml\ntopics: {prefix: {HeardPub: left}, name: {Heard: Words}}\n"
    files = deployed(STORM + BOTH, **ENDS, **{"ears/etc/config.yaml": values})
    (kept,) = faults(files)  # `Heard` has no publisher now
    assert (
        kept.code == "RC4210" and kept.hint == "the interface is published as left/Words: `topics: {Heard: left/Words}`"
    )
    both = BOTH.replace("}", ", topics: {Heard: all/heard}}")
    found = network({**files, "robot.ddsl.yaml": f"deployment: Robot\n{STORM}{both}"})
    assert {topic for _, _, topic, _ in lines(found)} == {"all/heard"}
    settings = config(found.processes["ears"])
    assert settings["Heard"] == "all/heard" and "Proxies.HeardPubPrefix" not in settings


def test_a_topic_without_a_storm() -> None:
    (found,) = faults(deployed(BOTH, **ENDS))
    assert said(found) == ("RC4208", "robot.ddsl.yaml", 3, 3)
    assert found.hint == "add an IceStorm: `services: {storm: {icestorm: {}}}`; 'mind' needs it, too"
    assert found.related[0].span.file == "ears/ears.cdsl.yaml"


def test_a_missing_storm_is_reported_once() -> None:
    entries = "components:\n  ear{i}: {component: ears, instances: 9}\n"
    (found,) = faults(deployed(entries, ears=EARS))
    assert found.hint.endswith("; 'ear1', 'ear2', 'ear3', 'ear4', 'ear5', 'ear6', 2 more need it, too")


def test_an_external_storm_in_the_configuration() -> None:
    manager = "IceStorm/TopicManager:tcp -h 10.0.0.9 -p 9999"
    values = f'component: ../NAME.cdsl.yaml\ntopics: {{manager: "{manager}"}}\n'
    files = {f"{name}/etc/config.yaml": values.replace("NAME", name) for name in ENDS}
    found = network(deployed(BOTH, **ENDS, **files))
    assert lines(found) == {("ears", "", "Heard", True), ("mind", "", "Heard", False)}
    assert config(found.processes["mind"])["TopicManager.Proxy"] == manager


def test_several_storms() -> None:
    two = "services: {a: {icestorm: {}}, b: {icestorm: {port: 9998}}}\n"
    assert [fault.code for fault in faults(deployed(two + BOTH, **ENDS))] == ["RC4209"]


def test_the_storm_of_the_own_host() -> None:
    text = "hosts: {l: 10.0.0.2, r: 10.0.0.3}\nservices: {a: {icestorm: {host: l}}, b: {icestorm: {host: r}}}\n"
    found = network(deployed(text + "components: {ears: {component: ears, host: r}}\n", ears=EARS))
    assert lines(found) == {("ears", "b", "Heard", True)}
    assert found.processes["b"].endpoints[0].text == "tcp -h 10.0.0.3 -p 9999"


def test_a_topic_without_a_publisher() -> None:
    (found,) = faults(deployed(STORM + "components: {mind: {component: mind}}\n", mind=MIND))
    assert said(found) == ("RC4210", "robot.ddsl.yaml", 3, 14) and found.severity == "warning"
    assert found.hint == "add the component that publishes it"
    two = "components:\n  mind{i}: {component: mind, instances: 2}\n"
    (found,) = faults(deployed(STORM + two, mind=MIND))
    assert found.hint == "add the component that publishes it; 'mind1' needs it, too"


def test_both_ends_must_have_the_same_interface() -> None:
    other = FACE.replace("word: {in: {text: string", "word: {in: {text: int")
    files = deployed(STORM + BOTH, **ENDS, **{"Other.idsl.yaml": other})
    (found,) = faults({**files, "mind/mind.cdsl.yaml": component("MindComp", MIND, "Other")})
    assert said(found) == ("RC4211", "robot.ddsl.yaml", 5, 3)
    assert found.message.endswith(
        "define the topic Heard differently: 'text' of 'word' is string in one, and int in the other"
    )


ARM = "deployment: Arm\n" + BOTH
ARMS = "include: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n"


def topics(found: Network) -> dict[str, str]:
    return {line.source: line.topic for line in found.connections if line.kind == TOPIC}


def test_each_include_keeps_its_own_topics() -> None:
    found = network(deployed(STORM + ARMS, **ENDS, **{"arm.ddsl.yaml": ARM}))
    assert topics(found) == {
        f"{side}.{name}": f"{side}/Heard" for side in ("left", "right") for name in ("ears", "mind")
    }  # fmt: skip
    assert config(found.processes["left.mind"])["Heard"] == "left/Heard"


def test_a_topic_of_an_include_by_its_name() -> None:
    outer = STORM + ARMS + "components: {all: {component: mind, topics: {Heard: right/Heard}}}\n"
    arm = ARM.replace("  mind: {component: mind}\n", "")  # the include no longer has both ends
    found = network(deployed(outer, **ENDS, **{"arm.ddsl.yaml": arm}))
    assert topics(found) == {"all": "right/Heard", "left.ears": "Heard", "right.ears": "right/Heard"}


def test_an_end_without_another_end_in_its_include_is_connected_outside() -> None:
    inner = "deployment: Arm\ncomponents: {ears: {component: ears}}\n"
    outer = STORM + ARMS + "components: {mind: {component: mind}}\n"
    found = network(deployed(outer, **ENDS, **{"arm.ddsl.yaml": inner}))
    assert set(topics(found).values()) == {"Heard"}


def test_a_slash_names_a_topic_outside_all_includes() -> None:
    arm = ARM.replace("ears}", "ears, topics: {Heard: /Heard}}")
    outer = STORM + ARMS + "components: {all: {component: mind, topics: {Heard: /Heard}}}\n"
    found = network(deployed(outer, **ENDS, **{"arm.ddsl.yaml": arm}))
    assert set(topics(found).values()) == {"Heard"}


def test_the_hint_outside_has_the_full_name() -> None:
    outer = STORM + ARMS + "components: {all: {component: mind}}\n"
    (found,) = faults(deployed(outer, **ENDS, **{"arm.ddsl.yaml": ARM}))
    assert found.code == "RC4210"
    assert found.hint == "the interface is published as left/Heard, right/Heard: `topics: {Heard: left/Heard}`"


def test_the_name_in_the_hint_works_in_the_document_of_the_subscriber() -> None:
    outer = STORM + "include: {left: arm.ddsl.yaml, right: mind.ddsl.yaml}\n"
    mind = "deployment: Mind\ncomponents: {mind: {component: mind}}\n"
    (found,) = faults(deployed(outer, **ENDS, **{"arm.ddsl.yaml": ARM, "mind.ddsl.yaml": mind}))
    assert found.hint == "the interface is published as left/Heard: `topics: {Heard: /left/Heard}`"
    named = mind.replace("mind}", "mind, topics: {Heard: /left/Heard}}")
    topic = topics(network(deployed(outer, **ENDS, **{"arm.ddsl.yaml": ARM, "mind.ddsl.yaml": named})))["right.mind"]
    assert topic == "left/Heard"


def test_the_hint_names_another_icestorm_that_carries_it() -> None:
    arm = ARM.replace("components", "services: {storm: {icestorm: {}}}\ncomponents", 1)
    outer = STORM + "include: {left: arm.ddsl.yaml}\ncomponents: {mind: {component: mind}}\n"
    (found,) = faults(deployed(outer, **ENDS, **{"arm.ddsl.yaml": arm}))
    assert found.hint == "the interface is published through the IceStorm 'left.storm': use one IceStorm for all"


def test_an_include_with_an_icestorm_of_its_own() -> None:
    arm = ARM.replace("components", "services: {storm: {icestorm: {}}}\ncomponents", 1)
    found = network(deployed(ARMS, **ENDS, **{"arm.ddsl.yaml": arm}))
    assert {line for line in lines(found) if line[0].startswith("left")} == {
        ("left.ears", "left.storm", "Heard", True), ("left.mind", "left.storm", "Heard", False)
    }  # fmt: skip
    ports = {found.processes[f"{side}.storm"].endpoints[0].port for side in ("left", "right")}
    assert len(ports) == 2  # `check` would report equal ports
