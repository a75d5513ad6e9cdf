"""The first `etc/config` of a component, and the default ports in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.addresses.port_numbers import default_port
from robocomp_yaml.addresses.table import assign
from robocomp_yaml.emit import config
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source import properties
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.transactions.plan import ONCE
from talk import component, workspace


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def text(linked: dict[str, LinkedComponent], folder: str) -> str:
    return config.plan(linked[folder], assign(linked.values(), Disk())).text


def values(linked: dict[str, LinkedComponent], folder: str) -> dict[str, str]:
    return properties.read(text(linked, folder)).values


def test_the_content_of_a_config() -> None:
    linked = workspace(
        {
            "speech": component(
                "SpeechComp", implements="[Speech]", requires="[Mouth]", subscribes="[Heard]", period="50 ms"
            ),
            "mouth": component("MouthComp", implements="[Mouth]"),
        }
    )
    mouth = values(linked, "mouth")["Mouth.Endpoints"].removeprefix("tcp -p ")
    plan = config.plan(linked["speech"], assign(linked.values(), Disk()))
    assert (plan.path, plan.policy, plan.executable) == ("etc/config", ONCE, False)
    speech, behavior = (default_port("SpeechComp", name) for name in ("Speech", "CommonBehavior"))
    assert (
        plan.text
        == f"""\
# Configuration of SpeechComp: one KEY=VALUE per line, as Ice reads it. rcyaml wrote it once; it is yours.
# The command line overrides it: bin/SpeechComp --period.compute=50 --Ice.Trace.Network=1

# The addresses on which this component listens.
# Speech: Says things,
# aloud.
Speech.Endpoints=tcp -p {speech}
# CommonBehavior: State, period, properties and orderly stop of every component.
CommonBehavior.Endpoints=tcp -p {behavior}

# The addresses of the components that it requires.
# Implemented by MouthComp (../mouth/mouth.cdsl.yaml).
MouthProxy=mouth:tcp -h localhost -p {mouth}

# Topics: IceStorm carries them, and its topic manager must be running.
TopicManager.Proxy=IceStorm/TopicManager:default -p 9999
# Heard: What was heard.
# Port 0: any free port, which only IceStorm has to know.
HeardTopic.Endpoints=tcp -p 0

# Milliseconds from one call of compute() to the next.
period.compute=50

# Ice, the middleware. To change a default, remove the # before its name.
# 1: warn when a connection is lost.
# Ice.Warn.Connections=0
# 1 to 3: log opened and closed connections, and more.
# Ice.Trace.Network=0
# 1: log every message.
# Ice.Trace.Protocol=0
# The size limit of messages, in KiB.
# Ice.MessageSizeMax=20004800
"""
    )


def test_a_component_without_ports() -> None:
    linked = workspace({"alone": component("Alone")})
    held = values(linked, "alone")
    assert [key for key in held if not key.startswith("Ice.")] == ["CommonBehavior.Endpoints", "period.compute"]
    assert held["period.compute"] == "100"


def test_a_proxy_has_the_port_of_the_other_config() -> None:
    documents = {"a": component("A", requires="[Mouth]"), "b": component("B", implements="[Mouth]")}
    linked = workspace(documents, b='Endpoints.Mouth = "tcp -h 10.0.0.7 -p 12345"\n')
    assert values(linked, "a")["MouthProxy"] == "mouth:tcp -h 10.0.0.7 -p 12345"
    linked = workspace(documents, b="Mouth.Endpoints=ws -p 12346:tcp -p 1\n")
    assert values(linked, "a")["MouthProxy"] == "mouth:ws -h localhost -p 12346"
    linked = workspace(documents, b="Mouth.Endpoints=tcp -p 0\n")
    assert values(linked, "a")["MouthProxy"] == f"mouth:tcp -h localhost -p {default_port('B', 'Mouth')}"


def test_an_interface_without_implementation() -> None:
    linked = workspace({"a": component("A", requires="[Mouth]", implements="[Speech]")})
    assert "No component of this workspace implements it" in text(linked, "a")
    assert f"MouthProxy=mouth:tcp -h localhost -p {default_port('', 'Mouth')}\n" in text(linked, "a")


def test_two_proxies_go_to_two_components() -> None:
    linked = workspace(
        {
            "a": component("A", requires="[Mouth, {Mouth1: Mouth}, {Mouth2: Mouth}]"),
            "b": component("B", implements="[Mouth]"),
            "c": component("C", implements="[Mouth]"),
        }
    )
    held = values(linked, "a")
    b, c = (values(linked, name)["Mouth.Endpoints"].removeprefix("tcp -p ") for name in "bc")
    assert [held[f"Mouth{n}Proxy"].rpartition(" ")[2] for n in ("", "1", "2")] == [b, c, c]
    assert "Implemented by B (../b/b.cdsl.yaml), also by C." in text(linked, "a")


def test_the_configs_of_a_workspace_match_in_any_order() -> None:
    linked = workspace(
        {
            "a": component("A", requires="[Mouth]"),
            "b": component("B", implements="[Mouth, Speech]"),
            "c": component("C", requires="[Speech]"),
        }
    )
    backwards = dict(reversed(linked.items()))
    assert list(backwards) != list(linked)
    assert {name: text(backwards, name) for name in linked} == {name: text(linked, name) for name in linked}


def test_a_component_may_be_passed_twice(tmp_path: Path) -> None:
    """As a component of this run, and as one of its workspace, with another spelling of its path."""
    linked = workspace({"a": component("A", requires="[Mouth]", implements="[Mouth]")})
    again = {"again": analyse([str(tmp_path)]).program.components.popitem()[1]}
    assert text({**linked, **again}, "a") == text({**again, **linked}, "a") == text(linked, "a")


@pytest.mark.parametrize(
    ("group", "period"),
    [("{compute: {type: int, default: 20}}", "20"), ("{compute: {type: int, optional: true}}", "100"),
     ("{gui: {type: int, default: 40}}", "100")],
)  # fmt: skip
def test_the_period_is_that_of_the_parameters(group: str, period: str) -> None:
    Path("a").mkdir()
    Path("a/a.pdsl.yaml").write_text(f"component: a.cdsl.yaml\nparameters: {{period: {{group: {group}}}}}\n")
    assert values(workspace({"a": component("A")}), "a")["period.compute"] == period
