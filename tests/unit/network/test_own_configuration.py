"""A component's own configuration in a deployment: what counts, in which order, and how it is shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import analysed, config, deployed, faults, network, said
from robocomp_yaml.addresses.port_numbers import default_port
from robocomp_yaml.network.network import Network
from robocomp_yaml.parameters.editing.settings import ShownSetting

PDSL = """\
component: mouth.cdsl.yaml
types:
  Motor: {struct: {name: string, vel: {type: float, range: [0, 2], default: 0.9}}}
parameters:
  volume: {type: int, range: [0, 100], default: 50}
  motors: {list: Motor, default: [{name: left}]}
  key: {type: string, optional: true, secret: true}
"""
FIRST = "# Configuration of MouthComp: one KEY=VALUE per line, as Ice reads it. rcyaml wrote it once; it is yours.\n"
ONE = "components: {lips: {component: mouth}}\n"


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def files(text: str = ONE, flat: str = "", values: str = "", **others: str) -> dict[str, str | bytes | None]:
    configs = {"mouth/etc/config": flat, "mouth/etc/config.yaml": values}
    written = {name: content for name, content in configs.items() if content}
    return dict(deployed(text, **{"mouth/mouth.pdsl.yaml": PDSL, **written, **others}))


def ports(found: Network) -> dict[str, int]:
    return {f"{name}.{e.interface}": e.port for name, process in found.processes.items() for e in process.endpoints}


def setting(found: Network, process: str, key: str) -> ShownSetting:
    return next(one for one in found.settings_of(process) if one.key == key)


def origin(one: ShownSetting) -> tuple[str, str, int]:
    return one.source, one.span.file if one.span else "", one.span.line if one.span else 0


@pytest.mark.parametrize(
    ("entry", "own", "port"),
    [
        ("", "", default_port("lips", "Mouth")),
        ("", "Mouth.Endpoints=tcp -p 12345\n", 12345),
        ("", 'Endpoints.Mouth="tcp -p 12345"\n', 12345),
        ("", f"Mouth.Endpoints=tcp -p {default_port('MouthComp', 'Mouth')}\n", default_port("lips", "Mouth")),
        (", port: 10001", "Mouth.Endpoints=tcp -p 12345\n", 10001),
        (", ports: {Mouth: 10001}", "Mouth.Endpoints=tcp -p 12345\n", 10001),
        (', endpoints: {Mouth: "ws -p 10001"}', "Mouth.Endpoints=tcp -p 12345\n", 10001),
    ],
)
def test_whose_port_counts(entry: str, own: str, port: int) -> None:
    found = network(files(f"components: {{lips: {{component: mouth{entry}}}}}\n", own))
    assert ports(found)["lips.Mouth"] == port


def test_a_default_that_config_new_writes_is_no_choice() -> None:
    both = "endpoints: {{Mouth: tcp -p {}, CommonBehavior: tcp -p {}}}\n"
    ours = both.format(*(default_port("MouthComp", name) for name in ("Mouth", "CommonBehavior")))
    found = network(files(values="component: ../mouth.cdsl.yaml\n" + ours))
    assert ports(found) == {f"lips.{name}": default_port("lips", name) for name in ("Mouth", "CommonBehavior")}
    assert not [one for one in found.settings_of("lips") if one.is_notable]


def test_the_port_of_a_values_document_counts() -> None:
    values = "component: ../mouth.cdsl.yaml\nendpoints: {Mouth: tcp -p 12345, CommonBehavior: tcp -p 12346}\n"
    found = network(files(values=values))
    assert ports(found) == {"lips.Mouth": 12345, "lips.CommonBehavior": 12346}
    assert config(found.processes["lips"])["Mouth.Endpoints"] == "tcp -h 127.0.0.1 -p 12345"
    assert origin(setting(found, "lips", "Mouth.Endpoints")) == ("set", "mouth/etc/config.yaml", 2)


@pytest.mark.parametrize(
    ("own", "text"),
    [
        ("tcp -h 127.0.0.1 -p 12345", "tcp -h 127.0.0.1 -p 12345"),
        ("tcp -h localhost -p 12345", "tcp -h 127.0.0.1 -p 12345"),
        ("default -p 12345", "tcp -h 127.0.0.1 -p 12345"),
        ("ws -p 12345", "ws -h 127.0.0.1 -p 12345"),
        ("tcp -p 12345 -t 500", "tcp -h 127.0.0.1 -p 12345 -t 500"),
        ("tcp -p 12345:udp -p 12345", "tcp -h 127.0.0.1 -p 12345:udp -h 127.0.0.1 -p 12345"),
        ("tcp -h 10.0.0.7 -p 12345", "tcp -h 10.0.0.7 -p 12345"),
    ],
)
def test_more_than_a_port_is_kept(own: str, text: str) -> None:
    found = network(files(flat=f"Mouth.Endpoints={own}\n"))
    assert config(found.processes["lips"])["Mouth.Endpoints"] == text
    assert ports(found)["lips.Mouth"] == 12345


def test_two_entries_of_one_component_cannot_share_its_port() -> None:
    two = "components: {a: {component: mouth}, b: {component: mouth}}\n"
    (found,) = faults(files(two, "Mouth.Endpoints=tcp -p 12345\n"))
    assert said(found) == ("RC4303", "robot.ddsl.yaml", 2, 37)
    assert found.hint == "set another port for 'b', in its entry: `ports: {Mouth: PORT}`"
    assert [one.span.file for one in found.related] == ["robot.ddsl.yaml", "mouth/etc/config", "mouth/etc/config"]
    assert not faults(files(two.replace("b: {", "b: {port: 10001, "), "Mouth.Endpoints=tcp -p 12345\n"))


def test_the_port_of_a_subscribed_topic_has_the_topics_name() -> None:
    ears = {
        "interfaces/News.idsl.yaml": "module: M\ntopics: {News: {methods: {said: {in: {text: string}}}}}\n",
        "ear/ear.cdsl.yaml": "component: EarComp\nlanguage: python\nimports: [News]\nsubscribes: [News]\n",
        "ear/etc/config": f"{FIRST}NewsTopic.Endpoints=tcp -p 12345\n",
        "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [News]\npublishes: [News]\n",
        "rcyaml.yaml": "interfaces: [interfaces]\n",
    }
    entries = "components: {m: {component: mouth}, a: {component: ear}, b: {component: ear}}\n"
    two = f"services: {{storm: {{icestorm: }}}}\n{entries}"
    (found,) = faults(files(two, **ears))
    assert found.hint == "set another port for 'b', in its entry: `ports: {News: PORT}`"
    assert not faults(files(two.replace("b: {", "b: {ports: {News: 12346}, "), **ears))


def test_instances_cannot_share_a_port() -> None:
    three = 'components: {"m{i}": {component: mouth, instances: 3MORE}}\n'
    own = "# mine\nMouth.Endpoints=tcp -p 12345\n"
    (found,) = faults(files(three.replace("MORE", ""), own))
    assert said(found) == ("RC3331", "robot.ddsl.yaml", 2, 14)
    assert (found.related[0].span.file, found.related[0].span.line) == ("mouth/etc/config", 2)
    assert "`port: 12345`" in found.hint
    counted = ports(network(files(three.replace("MORE", ", port: 10010"), own)))
    assert [counted[f"m{number}.Mouth"] for number in range(3)] == [10010, 10011, 10012]


def test_the_values_of_a_flat_config_count() -> None:
    flat = "volume=7\nOwn = x\\ \nIce.Trace.Network=1\nkey=${file:secrets/key}\nlong=a \\# b\n"
    found = config(network(files(flat=flat)).processes["lips"])
    assert (found["volume"], found["Own"], found["Ice.Trace.Network"], found["long"]) == ("7", "x ", "1", "a # b")
    assert found["key"] == f"${{file:{Path('mouth/etc/secrets/key').absolute()}}}", "the copy is in another folder"
    assert "motors.size" not in found, "the component has its defaults"


def test_set_overrides_a_flat_config() -> None:
    flat = "volume=7\nmotors.0.name=a\nmotors.1.name=b\nmotors.1.vel=1\n"
    text = 'components:\n  lips: {component: mouth, set: {volume: 8, "motors[1].vel": 2}}\n'
    found = network(files(text, flat))
    lines = config(found.processes["lips"])
    assert lines["volume"] == "8" and lines["motors.0.name"] == "a" and lines["motors.1.vel"] == "2"
    one = setting(found, "lips", "volume")
    assert origin(one) == ("set", "robot.ddsl.yaml", 3)
    assert [(old.value, old.span.file, old.span.line) for old in one.overrode] == [("7", "mouth/etc/config", 1)]


@pytest.mark.parametrize(
    ("flat", "more", "code", "place"),
    [
        ("# \nvolume = 101\n", "", "RC3303", ("mouth/etc/config", 2, 10)),
        ("volume=1\n", ", set: {volume: 101}", "RC3303", ("robot.ddsl.yaml", 2, 53)),
        ("volume=1\n", ', set: {"motors[1].vel": 1}', "RC4307", ("robot.ddsl.yaml", 2, 45)),
    ],
)
def test_values_are_judged_where_they_stand(flat: str, more: str, code: str, place: tuple[str, int, int]) -> None:
    (found,) = faults(files(f"components: {{lips: {{component: mouth{more}}}}}\n", flat))
    assert said(found) == (code, *place)


def test_a_value_that_nobody_sets_is_missing() -> None:
    speed = {"mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: {speed: int, gain: float}\n"}
    (found,) = faults(files("components:\n  lips: {component: mouth}\n", "gain=1\n", **speed))
    assert said(found) == ("RC3307", "mouth/etc/config", 1, 1) and "speed" in found.message
    assert not faults(files("components:\n  lips: {component: mouth, set: {speed: 1}}\n", "gain=1\n", **speed))


def test_a_values_document_counts_unless_the_user_changed_the_flat_config() -> None:
    values = "component: ../mouth.cdsl.yaml\nparameters: {volume: 60}\nendpoints: {Mouth: tcp -p 12345}\n"
    made = "# Configuration of MouthComp, written by rcyaml from config.yaml: change it there, and compile again.\n"
    stale = network(files(flat=made + "volume=1\n", values=values))
    assert config(stale.processes["lips"])["volume"] == "60", "not compiled again yet"
    edited = network(files(flat="volume=70\nMouth.Endpoints=tcp -p 12346\n", values=values))
    assert config(edited.processes["lips"])["volume"] == "70" and ports(edited)["lips.Mouth"] == 12346
    named = network(files("components: {lips: {component: mouth, config: etc/config.yaml}}\n", "volume=70\n", values))
    assert config(named.processes["lips"])["volume"] == "60", "the entry names the document"
    flat = "volume=60\nMouth.Endpoints=tcp -p 12345\n"
    shorter = network(files(flat=flat, values=values))
    assert "period.compute" not in config(shorter.processes["lips"]), "a property that the user left out"
    rest = "motors.size=1\nmotors.0.name=left\nmotors.0.vel=.9\nperiod.compute=100\nperiod.emergency=5e2\n"
    same = network(files(flat=f"# mine\n{flat}{rest}", values=values))
    assert config(same.processes["lips"])["period.emergency"] == "500", "the document contains all of it"


OWN_PROXY = {"speech/etc/config": "# mine\nMouthProxy=mouth:tcp -h 10.0.0.9 -p 4\n"}


def test_a_derived_proxy_overrides_the_own_one() -> None:
    found = network(files("components: {speech: {component: speech}, lips: {component: mouth}}\n", **OWN_PROXY))
    assert (
        config(found.processes["speech"])["MouthProxy"] == f"mouth:tcp -h localhost -p {default_port('lips', 'Mouth')}"
    )
    one = setting(found, "speech", "MouthProxy")
    assert one.source == "derived" and one.is_notable and not one.is_outside
    assert [(old.value, old.span.line) for old in one.overrode] == [("mouth:tcp -h 10.0.0.9 -p 4", 2)]


@pytest.mark.parametrize(
    "own",
    [
        OWN_PROXY,
        {"speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nproxies: {Mouth: 'mouth:tcp -h 10.0.0.9 -p 4'}\n"},
    ],
)
def test_an_own_proxy_leads_outside_where_nobody_serves(own: dict[str, str]) -> None:
    found = network(files("components: {speech: {component: speech}}\n", **own))
    assert config(found.processes["speech"])["MouthProxy"] == "mouth:tcp -h 10.0.0.9 -p 4"
    (connection,) = found.connections
    assert (connection.target, connection.proxy) == ("", "mouth:tcp -h 10.0.0.9 -p 4")
    one = setting(found, "speech", "MouthProxy")
    assert one.is_outside and origin(one)[:2] == ("set", next(iter(own)))


@pytest.mark.parametrize(
    "written",
    [
        f"MouthProxy=mouth:tcp -h localhost -p {default_port('', 'Mouth')}\n",
        f"MouthProxy=mouth:tcp -h localhost -p {default_port('MouthComp', 'Mouth')}\n",
        "Other=1\n",
    ],
)
def test_a_proxy_that_rcyaml_wrote_is_no_choice(written: str) -> None:
    tree = files("components: {speech: {component: speech}}\n", **{"speech/etc/config": written, "rcyaml.yaml": ""})
    (found,) = faults(tree)
    assert found.code == "RC4201"


def test_a_manager_that_rcyaml_wrote_is_no_choice() -> None:
    ears = {"ears": "subscribes: [Heard]\n"}
    default = {"ears/etc/config": "TopicManager.Proxy=IceStorm/TopicManager:default -p 9999\n"}
    (found,) = faults(files("components: {ears: {component: ears}}\n", **ears, **default))
    assert found.code == "RC4208"
    other = {"ears/etc/config": "TopicManager.Proxy=IceStorm/TopicManager:tcp -h 10.0.0.1 -p 9999\n"}
    found = network(files("components: {ears: {component: ears}}\n", **ears, **other))
    assert config(found.processes["ears"])["TopicManager.Proxy"].endswith("-h 10.0.0.1 -p 9999")


def test_the_port_for_events_counts() -> None:
    flat = {"ears/etc/config": "HeardTopic.Endpoints=tcp -p 12347\n"}
    text = "services: {storm: {icestorm: {}}}\ncomponents: {ears: {component: ears}, a: {component: talks}}\n"
    found = network(files(text, ears="subscribes: [Heard]\n", talks="publishes: [Heard]\n", **flat))
    assert config(found.processes["ears"])["HeardTopic.Endpoints"] == "tcp -h 127.0.0.1 -p 12347"


def test_every_value_names_its_source() -> None:
    text = "components:\n  lips: {component: mouth, port: 10001, set: {volume: 8}}\n"
    found = network(files(text, "# mine\nMouth.Endpoints=tcp -p 12345\nkey=hunter2\n"))
    shown = {one.key: (*origin(one), one.value) for one in found.settings_of("lips")}
    assert shown["Mouth.Endpoints"] == ("set", "robot.ddsl.yaml", 3, "tcp -h 127.0.0.1 -p 10001")
    assert shown["CommonBehavior.Endpoints"][0] == "derived"
    assert shown["volume"] == ("set", "robot.ddsl.yaml", 3, "8")
    assert shown["key"] == ("set", "mouth/etc/config", 3, "***")
    assert shown["motors[0].name"] == ("default", "mouth/mouth.pdsl.yaml", 6, "left")
    assert shown["Ice.MessageSizeMax"] == ("default", "", 0, "20004800")
    assert [old.value for old in setting(found, "lips", "Mouth.Endpoints").overrode] == ["tcp -p 12345"]


@pytest.mark.parametrize(
    ("flat", "values"),
    [("Ice.MessageSizeMax=7\n", ""), ("", "component: ../mouth.cdsl.yaml\nice: {MessageSizeMax: 7}\n")],
)
def test_a_default_of_the_run_time_is_not_shown_beside_what_replaces_it(flat: str, values: str) -> None:
    found = network(files(flat=flat, values=values)).settings_of("lips")
    assert [one.value for one in found if one.key == "Ice.MessageSizeMax"] == ["7"]


def test_a_file_that_rcyaml_wrote_changes_nothing() -> None:
    first = FIRST + f"Mouth.Endpoints=tcp -p {default_port('MouthComp', 'Mouth')}\nperiod.compute=100\n"
    found = network(files(flat=first))
    assert ports(found)["lips.Mouth"] == default_port("lips", "Mouth")
    assert not [one for one in found.settings_of("lips") if one.is_notable]


def test_the_flat_config_is_among_the_files_that_were_read() -> None:
    analysis = analysed(files(flat="volume=7\n"))
    assert analysis.disk.contents["mouth/etc/config"] == b"volume=7\n"
