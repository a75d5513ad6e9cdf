"""Where stand-ins serve: wherever the components of a workspace, and those of its deployments, look on this machine."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.api.expected import Expectations
from robocomp_yaml.pipeline import analyse

LAMP = "module: RoboCompLamp\ninterfaces: {Lamp: {methods: {on: }}}\ntopics: {Lit: {methods: {now: }}}\n"
COMPONENT = "component: NAME\nlanguage: python\nimports: [../Lamp]\n"
DOCUMENTS = {
    "rcyaml.yaml": "",
    "Lamp.idsl.yaml": LAMP,
    "eye/eye.cdsl.yaml": COMPONENT.replace("NAME", "Eye") + "requires: [Lamp]\nsubscribes: [Lit]\n",
}
OWN = "tcp -h 127.0.0.1 -p 4711"


def served(root: Path) -> list[tuple[str, str, tuple[str, ...]]]:
    analysis = analyse([str(root)])
    eye = next(one for one in analysis.program.components.values() if one.component.name == "Eye")
    found = Expectations(analysis).servers(eye.requires[0])
    return [(one.endpoint, one.identity, one.users) for one in found]


@pytest.mark.parametrize(
    ("line", "endpoint", "identity"),
    [
        ("LampProxy=lamp:tcp -h localhost -p 4711", OWN, "lamp"),
        ("LampProxy=lamp:default -p 4711", OWN, "lamp"),
        ("LampProxy=desk:tcp -h 127.0.0.1 -p 4711 -t 500", OWN, "desk"),
        ('Proxies.Lamp = "lamp:tcp -h localhost -p 4711"', OWN, "lamp"),
        ("LampProxy=lamp:ws -h localhost -p 4711", "ws -h 127.0.0.1 -p 4711", "lamp"),
    ],
)
def test_at_the_address_in_a_flat_config(tmp_path: Path, line: str, endpoint: str, identity: str) -> None:
    write_tree(tmp_path, {**DOCUMENTS, "eye/etc/config": f"{line}\n"})
    assert served(tmp_path) == [(endpoint, identity, ("Eye",))]


def test_at_the_address_in_a_values_document(tmp_path: Path) -> None:
    """It counts before the next compile."""
    values = "component: ../eye.cdsl.yaml\nproxies: {Lamp: 'lamp:tcp -h localhost -p 4711'}\n"
    write_tree(tmp_path, {**DOCUMENTS, "eye/etc/config.yaml": values})
    assert served(tmp_path) == [(OWN, "lamp", ("Eye",))]
    write_tree(tmp_path, {"eye/etc/config": "LampProxy=lamp:tcp -p 1\n"})
    assert served(tmp_path) == [("tcp -h 127.0.0.1 -p 1", "lamp", ("Eye",))], "the user's file counts"


def test_every_address_once(tmp_path: Path) -> None:
    ear = COMPONENT.replace("NAME", "Ear") + "requires: [Lamp]\n"
    nose = COMPONENT.replace("NAME", "Nose") + "requires: [Lamp]\n"
    same = "LampProxy=lamp:tcp -h localhost -p 4711\n"
    write_tree(tmp_path, {**DOCUMENTS, "ear/ear.cdsl.yaml": ear, "nose/nose.cdsl.yaml": nose, "eye/etc/config": same})
    write_tree(tmp_path, {"ear/etc/config": same, "nose/etc/config": same.replace("4711", "4712")})
    assert served(tmp_path) == [(OWN, "lamp", ("Ear", "Eye")), (OWN.replace("4711", "4712"), "lamp", ("Nose",))]


def test_elsewhere_it_is_where_a_component_serves_it(tmp_path: Path) -> None:
    far = {"eye/etc/config": "LampProxy=lamp:tcp -h 192.0.2.7 -p 4711\n"}
    write_tree(tmp_path, {**DOCUMENTS, **far})
    [(default, identity, users)] = served(tmp_path)
    assert default.startswith("tcp -h 127.0.0.1 -p ") and (identity, users) == ("lamp", ())
    lamp = {"lamp/lamp.cdsl.yaml": COMPONENT.replace("NAME", "LampComp") + "implements: [Lamp]\n"}
    write_tree(tmp_path, {**lamp, "lamp/etc/config": "Lamp.Endpoints=tcp -p 4713\n"})
    assert served(tmp_path) == [("tcp -h 127.0.0.1 -p 4713", "lamp", ())]


def test_in_a_deployment(tmp_path: Path) -> None:
    lamp = {"lamp/lamp.cdsl.yaml": COMPONENT.replace("NAME", "LampComp") + "implements: [Lamp]\n"}
    entries = "  eye: {component: eye}\n  lamp: {component: lamp, port: 4714}\n"
    storm = "services: {storm: {icestorm: {port: 4715}}}\n"
    write_tree(tmp_path, {**DOCUMENTS, **lamp, "d.ddsl.yaml": f"deployment: D\n{storm}components:\n{entries}"})
    [(endpoint, identity, users)] = served(tmp_path)
    assert (endpoint, identity) == ("tcp -h 127.0.0.1 -p 4714", "lamp")
    assert users[0].startswith("eye of ") and users[0].endswith("d.ddsl.yaml")
    topics = Expectations(analyse([str(tmp_path)])).topics("RoboCompLamp", "Lit")
    assert ("IceStorm/TopicManager:tcp -h localhost -p 4715", "Lit") in [(one.manager, one.name) for one in topics]


def test_an_external_server_of_a_deployment(tmp_path: Path) -> None:
    entry = "eye: {component: eye, connect: {Lamp: 'bulb:tcp -h localhost -p 4716'}}"
    storm = "services: {storm: {icestorm: {}}}\n"
    write_tree(tmp_path, {**DOCUMENTS, "d.ddsl.yaml": f"deployment: D\n{storm}components: {{{entry}}}\n"})
    assert [one[:2] for one in served(tmp_path)] == [("tcp -h 127.0.0.1 -p 4716", "bulb")]


def test_topics_by_their_names_and_prefixes(tmp_path: Path) -> None:
    config = "TopicManager.Proxy=IceStorm/TopicManager:tcp -h localhost -p 4717\nProxies.LitPrefix=attic\n"
    write_tree(tmp_path, {**DOCUMENTS, "eye/etc/config": config})
    found = Expectations(analyse([str(tmp_path)])).topics("RoboCompLamp", "Lit")
    assert [(one.manager, one.name) for one in found] == [
        ("IceStorm/TopicManager:tcp -h localhost -p 4717", "attic/Lit")
    ]
