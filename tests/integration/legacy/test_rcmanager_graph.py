"""RCManager's graph after migration and export: nodes of one name, and dependences of connected components."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from click.testing import Result
from ruamel.yaml import YAML

from conftest import write_tree

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
