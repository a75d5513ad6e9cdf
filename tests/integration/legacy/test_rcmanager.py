"""RCManager's XML as deployments: commands, endpoints, second names, components; and rejected files."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result

from conftest import write_tree
from rcmanager_facts import facts
from robocomp_yaml.emit.exports import export
from robocomp_yaml.legacy.networks import endpoint
from robocomp_yaml.legacy.networks.node import safe_name
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source import rcremote
from robocomp_yaml.source.tree import parse

Run = Callable[..., Result]
LASER = '<node alias="laser" endpoint="laser:tcp -h localhost -p 10003">{}</node>'
UP = '<upCommand command="rcremote localhost tab /opt/laser ./bin/laser"/>'


@pytest.fixture
def migrated(rcyaml: Run, tmp_path: Path) -> Callable[..., tuple[Any, list[str]]]:
    """Return the document of a manager with these elements, and the codes of the diagnostics."""

    def migrate(*elements: str) -> tuple[Any, list[str]]:
        text = "\n".join(["<rcmanager>", *elements, "</rcmanager>"])
        write_tree(tmp_path, {"robot.xml": text})
        said = json.loads(rcyaml("migrate", "robot.xml", "--format", "json").stdout)["diagnostics"]
        path = tmp_path / "robot.ddsl.yaml"
        tree = parse(str(path), path.read_text(encoding="utf-8"))[0] if path.exists() else None
        return tree.data if tree is not None else None, [diagnostic["code"] for diagnostic in said]

    return migrate


@pytest.mark.parametrize(("text", "words", "config", "stem"), [
    ("rcremote host tab /d ./bin/x --Ice.Config=/c.conf", ("./bin/x",), "/c.conf", "x"),
    ("rcremote host tab /d  ./bin/x   etc/config ", ("./bin/x",), "etc/config", "x"),
    ("rcremote host tab /d python src/x.py etc/config", ("python", "src/x.py"), "etc/config", "x"),
    ("rcremote host tab /d rcis simulation.xml -f 100", ("rcis", "simulation.xml", "-f", "100"), "", "rcis"),
    ("rcremote host tab /d x 'a b' \"c d\"", ("x", "a b", "c d"), "", "x"),
    ("rcremote host tab /d x don't", ("x", "don't"), "", "x"),
    ("rcremote host tab /d x > log", ("sh", "-c", "x > log"), "", "sh"),
    ("./start.sh", ("./start.sh",), "", "start"),
])  # fmt: skip
def test_commands(text: str, words: tuple[str, ...], config: str, stem: str) -> None:
    found = rcremote.parse(text, "/w")
    assert found is not None
    assert (found.words, found.config, found.stem) == (words, config, stem)
    remote = text.startswith("rcremote")
    assert (found.host, found.folder) == (("host", "/d") if remote else ("localhost", "/w"))


@pytest.mark.parametrize("text", ["", "  ", "rcremote", "rcremote host tab", "rcremote host tab /d", "rcremote h t / "])
def test_nothing_to_run(text: str) -> None:
    assert rcremote.parse(text, "/w") is None


def test_endpoints() -> None:
    found = endpoint.parse("acpi: tcp -p 10025")
    assert found == endpoint.NodeEndpoint("acpi", "tcp", 10025) and found.text == "tcp -p 10025"
    found = endpoint.parse("laser:tcp -t 500 -h robot.local -p 10003 -z")
    assert found is not None and (found.host, found.text) == ("robot.local", "tcp -p 10003 -t 500 -z")
    storm = endpoint.parse("IceStorm/TopicManager:default -p 9999")
    assert storm is not None and storm.is_storm
    for wrong in ("", "laser", "laser:tcp", "laser:tcp -p 70000", "laser:tcp -p x", "a:tcp -p 1:tcp -p 2", "laser@A"):
        assert endpoint.parse(wrong) is None


def test_names() -> None:
    assert safe_name("mission - no deps") == "mission_no_deps"
    assert safe_name("3d") == "n3d"
    assert safe_name("año", {"a_o"}) == "a_o_2"
    assert safe_name("...") == "node"


def test_one_host_needs_no_hosts(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    document, said = migrated(LASER.format(UP))
    assert document == {
        "deployment": "robot",
        "components": {"laser": {
            "program": "./bin/laser", "cwd": "/opt/laser", "endpoints": {"laser": "tcp -p 10003"},
            "x-rcmanager": {"tab": "tab"},
        }},
    }  # fmt: skip
    assert said == []


def test_hosts_have_names_addresses_and_users(
    migrated: Callable[..., tuple[Any, list[str]]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("socket.gethostname", lambda: "operator")
    there = ('<node alias="{0}" endpoint="{0}:tcp -h {1} -p {2}"><upCommand command="rcremote {1} t /d {0}"/>'
             '<downCommand command="ssh ana@{1} killall {0}"/></node>')  # fmt: skip
    document, said = migrated(there.format("a", "10.0.0.2", 1), there.format("b", "robot.local", 2), LASER.format(UP))
    assert document["hosts"] == {
        "host1": {"address": "10.0.0.2", "user": "ana"}, "robot": {"address": "robot.local", "user": "ana"},
        "localhost": {"address": "operator"},
    }  # fmt: skip
    assert [entry["host"] for entry in document["components"].values()] == ["host1", "robot", "localhost"]
    assert said == ["RC5047"]  # other hosts cannot connect to 'localhost'


def test_icestorm_is_a_service(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    storm = ('<node alias="IS" endpoint="IceStorm/TopicManager:default -p 9999">'
             '<upCommand command="rcremote localhost IS /d rcnode"/></node>')  # fmt: skip
    document, said = migrated(storm, LASER.format('<dependence alias="IS"/>' + UP))
    assert document["services"] == {"IS": {"icestorm": {"port": 9999}}}
    assert document["components"]["laser"]["after"] == ["IS"]
    assert document["x-rcmanager"]["nodes"]["IS"]["upCommand"] == "rcremote localhost IS /d rcnode"
    assert said == []


def test_a_second_name_waits_with_the_first(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    needs = '<dependence alias="laser"/><dependence alias="js"/>'
    base = f'<node alias="base" endpoint="base:tcp -p 10004">{needs}{UP}</node>'
    js = '<node alias="js" endpoint="js:tcp -p 10005"><upCommand command="rcremote localhost js /d js"/></node>'
    document, said = migrated(LASER.format(UP), base, js)
    assert document["components"]["base"]["process"] == "laser"
    assert document["components"]["laser"]["after"] == ["js"]
    assert document["components"]["base"]["x-rcmanager"]["dependence"] == ["laser", "js"]
    assert said == ["RC5037"]


@pytest.mark.parametrize(("element", "code"), [
    (LASER.format(UP + '<dependence alias="nobody"/>'), "RC5033"),
    (LASER.format('<upCommand command=""/>'), "RC5034"),
    (LASER.format('<upCommand command="rcremote localhost a"/>'), "RC5034"),
    ('<node alias="a" endpoint="a:tcp -h 10.0.0.1 -p 1">' + UP + "</node>", "RC5035"),
    ('<node alias="a" endpoint="a:tcp">' + UP + "</node>", "RC5035"),
    (LASER.format('<upCommand command="cd /a &amp;&amp; ./b"/>'), "RC5036"),
    (LASER.format('<upCommand command="rcremote localhost t /opt/bin/x /etc/x.conf"/>'), "RC5038"),
    ('<node alias="a b" endpoint="a:tcp -p 1">' + UP + "</node>", "RC5005"),
    (LASER.format(UP + UP), "RC5006"),
    (LASER.format('<upCommand command="a & b"/>'), "RC5005"),
    ("<?php echo ?>" + LASER.format(UP), "RC5051"),
])  # fmt: skip
def test_problems_are_reported(migrated: Callable[..., tuple[Any, list[str]]], element: str, code: str) -> None:
    document, said = migrated(element)
    assert document is not None and code in said


@pytest.mark.parametrize(("element", "code"), [
    ("<node>" + UP + "</node>", "RC5004"),
    (LASER.format("<upCommand command='a'></downCommand>"), "RC5004"),
    (LASER.format('<upCommand command="a" command="b"/>'), "RC5004"),
    (LASER.format('<upCommand command="&lol;"/>'), "RC5004"),
    (LASER.format('<upCommand command="&#0;"/>'), "RC5004"),
    ("hello", "RC5004"),
    ("<![CDATA[hello]]>", "RC5004"),
    ("<node", "RC5003"),
    ("<a>" * 500, "RC5003"),
    ("<a>" * 500 + "</a>" * 500, "RC5003"),
])  # fmt: skip
def test_rejected_files(migrated: Callable[..., tuple[Any, list[str]]], element: str, code: str) -> None:
    document, said = migrated(element)
    assert document is None and code in said


def test_a_document_type_is_rejected(rcyaml: Run, tmp_path: Path) -> None:
    laughs = '<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]><rcmanager><node alias="&b;" endpoint=""/></rcmanager>'
    write_tree(tmp_path, {"robot.xml": laughs})
    result = rcyaml("migrate", "robot.xml")
    assert result.exit_code == 1 and "document type" in result.output and not (tmp_path / "robot.ddsl.yaml").exists()


def test_other_xml_is_skipped(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"world.xml": "<innerModel/>", "robot.xml": f"<rcmanager>{LASER.format(UP)}</rcmanager>"})
    assert rcyaml("migrate", ".", "--report", "ledger.json").exit_code == 0
    files = json.loads((tmp_path / "ledger.json").read_text(encoding="utf-8"))["files"]
    assert [file["source"] for file in files] == ["robot.xml"]
    assert "RC5001" in rcyaml("migrate", "world.xml").output


def test_comments_keep_their_position(rcyaml: Run, tmp_path: Path) -> None:
    manager = f"""<?xml version="1.0" encoding="UTF-8"?>
<!-- The robot. -->
<rcmanager>
 <!-- In front. -->
 {LASER.format(" <!-- was: --><!--<dependence alias='x'/>--> <dependence alias='js'/> " + UP + " <!-- last -->")}
 <!--<node alias="old">
   <xpos value="1"/>
 </node>-->
 <node alias="js" endpoint="js:tcp -p 10005"><upCommand command="rcremote localhost js /d js"/></node>
</rcmanager>
<!-- The end. -->
"""
    write_tree(tmp_path, {"robot.xml": manager})
    assert rcyaml("-q", "migrate", "robot.xml").output == ""
    assert (
        (tmp_path / "robot.ddsl.yaml").read_text(encoding="utf-8").split("\n", 1)[1]
        == """
# The robot.
deployment: robot
components:
  # In front.
  laser:
    program: ./bin/laser
    cwd: /opt/laser
    endpoints: {laser: tcp -p 10003}
    after:
      # was:
      # <dependence alias='x'/>
      - js
    x-rcmanager:
      upCommand: rcremote localhost tab /opt/laser ./bin/laser  # last
  # <node alias="old">
  #   <xpos value="1"/>
  # </node>
  js:
    program: js
    cwd: /d
    endpoints: {js: tcp -p 10005}
    x-rcmanager: {endpoint: "{identity}:tcp -p {port}"}
# The end.
"""
    )


CDSL = (
    'import "{1}.idsl";\nComponent {0}\n{{\n    Communications\n    {{\n        implements {1}{2};\n    }};\n'
    "    language {3};\n}};\n"
)
IDSL = "module RoboComp{0}\n{{\n    interface {0}\n    {{\n        void go();\n    }};\n}};\n"


def test_components_of_the_repository_are_discovered(rcyaml: Run, tmp_path: Path) -> None:
    node = (
        '<node alias="{0}" endpoint="{1}:tcp -h localhost -p {2}">{3}'
        '<upCommand command="rcremote localhost {0} /home/me/repo/{4}"/></node>'
    )
    needs = '<dependence alias="legs"/>'
    manager = "\n".join([
        "<rcmanager>",
        node.format("legs", "motor", 10001, "", "motor ./bin/motorcomp /home/me/repo/motor/etc/config"),
        node.format("head", "speech", 10002, needs, "speech python src/speechcomp.py -v"),
        node.format("sim", "laser", 10003, "", "sim rcis"), "</rcmanager>",
    ])  # fmt: skip
    write_tree(tmp_path, {
        "interfaces/Motor.idsl": IDSL.format("Motor"), "interfaces/Speech.idsl": IDSL.format("Speech"),
        "motor/motor.cdsl": CDSL.format("MotorComp", "Motor", "", "cpp"), "motor/etc/config": "Motor.Speed = 1\n",
        "speech/speech.cdsl":
            'import "Motor.idsl";\n' + CDSL.format("SpeechComp", "Speech", ";\n requires Motor", "python"),
        "etc/robot.xml": manager,
    })  # fmt: skip
    assert rcyaml("-q", "migrate", ".").exit_code == 0
    text = (tmp_path / "etc/robot.ddsl.yaml").read_text(encoding="utf-8")
    tree, _ = parse("x", text)
    assert tree is not None
    entries: Any = tree.data["components"]  # type: ignore[index,call-overload]
    for entry in entries.values():
        del entry["x-rcmanager"]
    assert entries == {
        "legs": {"component": "../motor/motor.cdsl.yaml", "config": "etc/config.yaml", "port": 10001},
        "head": {"component": "../speech/speech.cdsl.yaml", "args": ["-v"], "port": 10002, "connect": {"Motor": "legs"},
                 "after": ["legs"]},
        "sim": {"program": "rcis", "cwd": "/home/me/repo/sim", "endpoints": {"laser": "tcp -p 10003"}},
    }  # fmt: skip
    result = rcyaml("check")
    assert "error" not in result.output and result.exit_code == 0, result.output


def test_existing_components_are_discovered(rcyaml: Run, tmp_path: Path) -> None:
    component = "component: Laser\nlanguage: python\nimports: [Laser]\nimplements: [Laser]\n"
    write_tree(tmp_path, {
        "rcyaml.yaml": "interfaces: [.]\n", "Laser.idsl.yaml": "module: M\ninterfaces:\n  Laser: {}\n",
        "laser/laser.cdsl.yaml": component, "robot.xml": f"<rcmanager>{LASER.format(UP)}</rcmanager>",
    })  # fmt: skip
    assert rcyaml("migrate", "robot.xml").exit_code == 0
    text = (tmp_path / "robot.ddsl.yaml").read_text(encoding="utf-8")
    assert "component: laser/laser.cdsl.yaml" in text and "port: 10003" in text


NODE = '<node alias="{0}" endpoint="{1}">{2}<upCommand command="rcremote {3} {0} /opt/{0} ./bin/{0}"/></node>'


def node(alias: str, endpoint: str, *after: str, host: str = "localhost") -> str:
    return NODE.format(alias, endpoint, "".join(f'<dependence alias="{other}"/>' for other in after), host)


def test_an_endpoint_that_several_nodes_name_is_pinged(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    document, said = migrated(node("a", "arm:tcp -p 10001"), node("b", "arm:tcp -p 10001 -h 127.0.0.1"))
    entries = document["components"]
    assert said == ["RC5044"]
    assert entries["a"]["endpoints"] == {"arm": "tcp -p 10001"}
    assert "endpoints" not in entries["b"] and entries["b"]["ready"] == {"ping": "arm:tcp -p 10001"}
    assert entries["b"]["x-rcmanager"]["pinged"] == "arm:tcp -p 10001 -h 127.0.0.1"


def test_the_same_port_on_two_hosts_is_served(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    there = [node(name, f"arm:tcp -h {host} -p 10001", host=host) for name, host in (("a", "r1"), ("b", "r2"))]
    document, said = migrated(*there)
    assert not said and all("endpoints" in entry for entry in document["components"].values())


def test_an_endpoint_on_another_host_is_pinged_there(migrated: Callable[..., tuple[Any, list[str]]]) -> None:
    document, said = migrated(node("a", "arm:tcp -h 10.0.0.9 -p 10001", host="10.0.0.2"))
    assert said == ["RC5035"]
    assert document["components"]["a"]["ready"] == {"ping": "arm:tcp -h 10.0.0.9 -p 10001"}


@pytest.mark.parametrize(("waits", "kept"), [
    ({"a": ["b"], "b": ["a"]}, {"a": ["b"]}),
    ({"a": ["b"], "b": ["c"], "c": ["a"]}, {"a": ["b"], "b": ["c"]}),
    ({"a": ["b", "c"], "b": ["c"], "c": []}, {"a": ["b", "c"], "b": ["c"]}),
], ids=["two", "three", "none"])  # fmt: skip
def test_waits_in_a_circle(
    migrated: Callable[..., tuple[Any, list[str]]], waits: dict[str, list[str]], kept: dict[str, list[str]]
) -> None:
    nodes = [node(name, f"arm:tcp -p {10001 + n}", *after) for n, (name, after) in enumerate(waits.items())]
    document, said = migrated(*nodes)
    entries = document["components"]
    assert {name: entry["after"] for name, entry in entries.items() if "after" in entry} == kept
    dropped = [name for name, after in waits.items() if kept.get(name, []) != after]
    assert said == ["RC5045"] * len(dropped)
    assert all(entries[name]["x-rcmanager"]["dependence"] == waits[name] for name in dropped)


def test_the_operators_address_is_that_of_its_clients(rcyaml: Run, tmp_path: Path) -> None:
    manager = "\n".join([
        "<rcmanager>", node("legs", "motor:tcp -h localhost -p 10001"),
        '<node alias="head" endpoint="speech:tcp -h 10.0.0.2 -p 10002"><upCommand command="rcremote 10.0.0.2 head '
        '/home/me/repo/speech ./bin/talk --Ice.Config=etc/config_robot"/></node>', "</rcmanager>",
    ])  # fmt: skip
    write_tree(tmp_path, {
        "interfaces/Motor.idsl": IDSL.format("Motor"), "interfaces/Speech.idsl": IDSL.format("Speech"),
        "speech/speech.cdsl":
            'import "Motor.idsl";\n' + CDSL.format("SpeechComp", "Speech", ";\n requires Motor", "python"),
        "speech/etc/config_robot": "MotorProxy = motor:tcp -h 10.0.0.7 -p 10001\nSpeech.Endpoints = tcp -p 10002\n",
        "robot.xml": manager,
    })  # fmt: skip
    rcyaml("-q", "migrate", ".")
    tree, _ = parse("x", (tmp_path / "robot.ddsl.yaml").read_text(encoding="utf-8"))
    assert tree is not None
    document: Any = tree.data
    assert document["hosts"]["localhost"] == {"address": "10.0.0.7"}
    # The component is found from the folder of its program, whose name is another one.
    assert document["components"]["head"]["component"] == "speech/speech.cdsl.yaml"
    result = rcyaml("check", "robot.ddsl.yaml")
    assert "error" not in result.output, result.output


TWO_MOTORS = [node("left", "motor:tcp -p 10001"), node("right", "motor:tcp -p 10002")]


@pytest.mark.parametrize(("config", "after", "connect", "code"), [
    ("MotorProxy = motor:tcp -h localhost -p 10002\n", [], "right", []),
    ("MotorProxy = motor:tcp -h localhost -p 10003\n", [], "motor:tcp -h localhost -p 10003", []),
    ("", ["right"], "right", []),
    ("", [], "left", ["RC5046"]),
], ids=["address", "elsewhere", "dependence", "guess"])  # fmt: skip
def test_who_serves_what_several_nodes_serve(
    rcyaml: Run, tmp_path: Path, config: str, after: list[str], connect: str, code: list[str]
) -> None:
    waits = "".join(f'<dependence alias="{other}"/>' for other in after)
    head = (
        f'<node alias="head" endpoint="speech:tcp -p 10009">{waits}<upCommand command="rcremote localhost head '
        '/home/me/repo/speech python src/speechcomp.py etc/config"/></node>'
    )
    write_tree(tmp_path, {
        "interfaces/Motor.idsl": IDSL.format("Motor"), "interfaces/Speech.idsl": IDSL.format("Speech"),
        "speech/speech.cdsl":
            'import "Motor.idsl";\n' + CDSL.format("SpeechComp", "Speech", ";\n requires Motor", "python"),
        "speech/etc/config": "Speech.Endpoints = tcp -p 10009\n" + config,
        "robot.xml": "\n".join(["<rcmanager>", *TWO_MOTORS, head, "</rcmanager>"]),
    })  # fmt: skip
    said = json.loads(rcyaml("migrate", ".", "--format", "json").stdout)["diagnostics"]
    assert [one["code"] for one in said if one["code"] == "RC5046"] == code
    tree, _ = parse("x", (tmp_path / "robot.ddsl.yaml").read_text(encoding="utf-8"))
    assert tree is not None
    document: Any = tree.data
    assert document["components"]["head"]["connect"] == {"Motor": connect}
    result = rcyaml("check", "robot.ddsl.yaml")
    assert "error" not in result.output, result.output


def test_what_most_nodes_share_is_kept_once(rcyaml: Run, tmp_path: Path) -> None:
    look = '<xpos value="1.5"/><radius value="10.0"/><color value="{}"/><workingDir path="/home/robot"/>'
    nodes = [
        f'<node alias="{name}" endpoint="arm:tcp -h localhost -p {port}">{look.format(color)}'
        f'<upCommand command="rcremote localhost {name} /opt ./bin/{name}"/></node>'
        for name, port, color in (("a", 10001, "#111"), ("b", 10002, "#222"), ("c", 10003, "#111"))
    ]
    source = "\n".join(["<rcmanager>", *nodes, "</rcmanager>"])
    write_tree(tmp_path, {"robot.xml": source})
    rcyaml("-q", "migrate", "robot.xml")
    text = (tmp_path / "robot.ddsl.yaml").read_text(encoding="utf-8")
    assert text.count("/home/robot") == text.count("radius") == text.count("#111") == text.count("#222") == 1
    (exported,) = export(analyse([str(tmp_path / "robot.ddsl.yaml")]).networks.popitem()[1], "rcmanager").values()
    assert facts(exported.encode())[0] == facts(source.encode())[0]
