"""RCManager's graph after migration and export: nodes of one name, and dependences of connected components."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from click.testing import Result
from ruamel.yaml import YAML

from conftest import write_tree
from rcmanager_facts import facts

Run = Callable[..., Result]
LASER = '<node alias="laser" endpoint="laser:tcp -h localhost -p 10003">{}</node>'
UP = '<upCommand command="rcremote localhost tab /opt/laser ./bin/laser"/>'
NODE = (
    '<node alias="{0}" endpoint="{1}:tcp -h localhost -p {2}">{3}'
    '<upCommand command="rcremote localhost {0} /x/{0} ./bin/{0} etc/config"/></node>'
)


def test_nodes_of_one_name_are_processes_of_their_own(rcyaml: Run, tmp_path: Path) -> None:
    """RCManager accepts them, and a dependence means the first one."""
    elements = [
        LASER.format(UP), LASER.format(UP),
        LASER.format(UP.replace("./bin/laser", "./bin/laser etc/rear")).replace("10003", "10004"),
        '<node alias="laser_2" endpoint="x:tcp -p 10005">' + UP.replace("laser", "x") + "</node>",
        '<node alias="base" endpoint="base:tcp -h localhost -p 10006"><dependence alias="laser"/>'
        + UP.replace("laser", "base") + "</node>",
    ]  # fmt: skip
    write_tree(tmp_path, {"robot.xml": "\n".join(["<rcmanager>", *elements, "</rcmanager>"])})
    result = rcyaml("migrate", "robot.xml")
    assert result.exit_code == 0
    assert (result.output.count("RC5005"), result.output.count("RC5037")) == (3, 1)
    components = YAML(typ="safe").load(tmp_path / "robot.ddsl.yaml")["components"]
    assert list(components) == ["laser", "laser_2", "laser_3", "laser_2_2", "base"]
    assert components["laser_2"]["process"] == "laser" and components["base"]["after"] == ["laser"]
    assert rcyaml("check", "robot.ddsl.yaml").exit_code == 0
    exported = rcyaml("deploy", "export", "--as", "rcmanager", "robot.ddsl.yaml").stdout
    nodes = '<node alias="(.*?)" endpoint="(.*?)"'
    assert re.findall(nodes, exported) == re.findall(nodes, (tmp_path / "robot.xml").read_text(encoding="utf-8"))
    assert exported.count('<dependence alias="laser"/>') == 1


def test_the_graph_of_rcmanager_stays(rcyaml: Run, tmp_path: Path) -> None:
    """Components are connected, and have topics: RCManager's dependences are the same again, and no others. A component
    that is added needs what its connections imply."""
    module = "module RoboComp{0} {{{{ interface {0} {{{{ void go(); }}}}; }}}};\n".format
    head = 'import "Arm.idsl";\nimport "News.idsl";\nComponent {} {{ Communications {{ {} }}; language python; }};\n'
    write_tree(tmp_path, {
        "Arm.idsl": module("Arm").format(), "News.idsl": module("News").format(),
        "arm/arm.cdsl": head.format("arm", "implements Arm; publishes News;"),
        "arm/etc/config": "Arm.Endpoints=tcp -p 10003\nTopicManager.Proxy=IceStorm/TopicManager:default -p 9999\n",
        "hand/hand.cdsl": head.format("hand", "requires Arm; subscribesTo News;"),
        "hand/etc/config": "ArmProxy=arm:tcp -h localhost -p 10003\nNewsTopic.Endpoints=tcp -p 10005\n"
        "TopicManager.Proxy=IceStorm/TopicManager:default -p 9999\n",
        "robot.xml": "\n".join([
            "<rcmanager>",
            '<node alias="storm" endpoint="IceStorm/TopicManager:tcp -p 9999"><upCommand command="rcnode.sh"/></node>',
            NODE.format("arm", "arm", 10003, ""), NODE.format("hand", "hand", 10006, ""),
            NODE.format("second", "commonbehavior", 10007, '<dependence alias="arm"/>'), "</rcmanager>",
        ]),
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    document = tmp_path / "robot.ddsl.yaml"
    assert "component: hand/hand.cdsl.yaml" in document.read_text()
    exported = rcyaml("deploy", "export", "--as", "rcmanager", str(document)).stdout
    dependences = re.findall(r'<node alias="(\w+)"|<dependence alias="(\w+)"', exported)
    assert [one for one in dependences if one[1] or one[0] == "second"] == [("second", ""), ("", "arm")], exported
    text = document.read_text().replace(
        "  second:", "  third: {component: hand/hand.cdsl.yaml, ports: {News: 10009}}\n  second:"
    )
    document.write_text(text)
    exported = rcyaml("deploy", "export", "--as", "rcmanager", str(document)).stdout
    third = exported.partition('<node alias="third"')[2].partition("</node>")[0]
    assert re.findall(r'dependence alias="(\w+)"', third) == ["arm", "storm"], exported


def test_what_the_export_derives_is_not_repeated(rcyaml: Run, tmp_path: Path) -> None:
    """A component is started as it is here, its endpoint is what it serves itself, or is for all components; texts that
    repeat the command are patterns, and a second name of a process has what the first one has."""
    module = "module RoboComp{0} {{{{ interface {0} {{{{ void go(); }}}}; }}}};\n".format
    head = 'import "Arm.idsl";\nComponent {} {{ Communications {{ {} }}; language Cpp; }};\n'
    home = "/home/ann/robocomp/components/robot"
    look = '<downCommand command="{}"/><configFile path="{}"/><workingDir path="/home/ann"/><xpos value="1.25"/><ypos value="-3"/>'
    up = '<upCommand command="rcremote localhost {} {} {}"/>'

    def node(alias: str, endpoint: str, tab: str, folder: str, words: str, kill: str, config: str) -> str:
        inside = up.format(tab, folder, words) + look.format(kill, config)
        return f'<node alias="{alias}" endpoint="{endpoint}">{inside}</node>'

    sim = ("sim", "/opt/sim", "rcis world.xml", "killall -9 rcis", "kate world.xml")
    write_tree(tmp_path, {
        "Arm.idsl": module("Arm").format(),
        "arm/arm.cdsl": head.format("arm", "implements Arm;"),
        "arm/etc/config": "CommonBehavior.Endpoints=tcp -p 11003\nArm.Endpoints=tcp -p 10003\n",
        "log/log.cdsl": head.format("log", "subscribesTo Arm;"),
        "log/etc/config": "ArmTopic.Endpoints=tcp -p 10010\nCommonBehavior.Endpoints=tcp -p 11010\n"
        "TopicManager.Proxy=IceStorm/TopicManager:default -p 9999\n",
        "robot.xml": "\n".join([
            "<rcmanager>",
            node("arm", "arm:tcp -p 10003", "a", f"{home}/arm", "./bin/arm etc/config", "killall -9 arm", "etc/config"),
            node("log", "commonbehavior:tcp -p 11010", "log", f"{home}/log", "./bin/log etc/config", "killall -9 log",
                 "etc/config"),
            node("laser", "laser:tcp -p 10004", *sim), node("base", "base:tcp -p 10005", *sim),
            node("plan", "plan:tcp -p 10006", "plan", "/opt/p", "python src/plan.py /opt/p.conf", "pkill -9 -f plan.py",
                 "kate /opt/p.conf"), "</rcmanager>",
        ]),
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    kept = YAML(typ="safe").load(tmp_path / "robot.ddsl.yaml")
    each = kept["x-rcmanager"]["each"]
    patterns = {"endpoint": "{identity}:tcp -p {port}", "downCommand": "{kill}", "configFile": "{config}"}
    assert each == {**patterns, "workingDir": "/home/ann"}
    assert {name: entry["x-rcmanager"] for name, entry in kept["components"].items()} == {
        "arm": {"tab": "a", "at": [1.25, -3]}, "log": {"at": [1.25, -3]}, "base": {"at": [1.25, -3]},
        "laser": {"tab": "sim", "configFile": "kate world.xml", "at": [1.25, -3]},
        "plan": {"configFile": "kate {config}", "at": [1.25, -3]},
    }  # fmt: skip
    exported = rcyaml("deploy", "export", "--as", "rcmanager", "robot.ddsl.yaml").stdout
    was, now = facts((tmp_path / "robot.xml").read_bytes())[0], facts(exported.encode())[0]
    assert {name: one[0] for name, one in now.items()} == {name: one[0] for name, one in was.items()}
    assert [now[name] for name in ("laser", "base", "plan")] == [was[name] for name in ("laser", "base", "plan")]
    started = dict(dict(now["arm"][1])["upCommand"])["command"]
    assert started.startswith(f"rcremote localhost a {tmp_path}/arm ./bin/arm {tmp_path}/.rcyaml/deployments/robot/")
