"""Pictures of networks: their content, all forms, and an SVG in which nothing overlaps."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable, Mapping
from itertools import combinations
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from networks import large, speaking
from robocomp_yaml.diag.codes.files import ALIASES, SYNTAX, WORKSPACE_SETTING, WRONG_SHAPE
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.forms import draw
from robocomp_yaml.emit.graphs.geometry import LABEL, Geometry, Rectangle, geometry_of
from robocomp_yaml.emit.graphs.grid import layers
from robocomp_yaml.emit.graphs.measure import shortened, width
from robocomp_yaml.emit.graphs.of_network import picture_of
from robocomp_yaml.emit.graphs.picture import Box, Picture, PictureLine, PictureNode
from robocomp_yaml.network.network import Connection, Network, Process

Golden = Callable[[str, Mapping[str, str]], None]
FORMS = {"text": "txt", "dot": "dot", "mermaid": "mmd", "json": "json", "svg": "svg"}


def faulty() -> tuple[Network, list[Diagnostic]]:
    """Two processes of a document, with an error that both have, and one at a connection."""
    network = Network("Two", "/two.ddsl.yaml", "/f", dict(large(1, 1).hosts))
    for line, name in ((3, "a"), (6, "b")):
        span = Span("two.ddsl.yaml", line, 3)
        network.processes[name] = Process(name, "localhost", (name,), "/", span=span)
    network = replace(network, connections=(Connection("a", "B", "B", "b", span=Span("two.ddsl.yaml", 5, 14)),))
    there = Related("there", Span("two.ddsl.yaml", 7, 4))
    said = [
        SYNTAX.at(Span("two.ddsl.yaml", 4, 9), problem="they quarrel", related=(there,)),
        ALIASES.at(Span("two.ddsl.yaml", 5, 14), problem="not equal").as_severity(WARNING),
        WRONG_SHAPE.at(Span("other.cdsl.yaml", 1, 1), problem="somewhere else"),
        WORKSPACE_SETTING.at(Span("two.ddsl.yaml", 3, 1), problem="by the way").as_severity("note"),
    ]
    return network, said


@pytest.mark.parametrize("form", FORMS)
def test_golden(golden: Golden, form: str) -> None:
    golden(f"graphs/{form}", {
        f"head.{FORMS[form]}": draw(picture_of(speaking()), form),
        f"faulty.{FORMS[form]}": draw(picture_of(*faulty()), form),
    })  # fmt: skip


def test_diagnostics_are_at_their_nodes_and_lines() -> None:
    made = picture_of(*faulty())
    codes = {name: [fault.code for fault in node.faults] for name, node in made.nodes.items()}
    assert codes == {"a": ["RC0101", "RC0105"], "b": ["RC0101"]}
    (line,) = made.lines
    assert [fault.code for fault in line.faults] == ["RC0105"]
    assert [fault.code for fault in made.faults] == ["RC0204"]
    assert [fault.code for _, fault in made.all_faults()] == ["RC0101", "RC0105", "RC0204"]


def test_a_topic_is_between_publishers_and_subscribers() -> None:
    made = picture_of(speaking())
    topic = made.nodes["storm/robot1/SpeechEvents"]
    assert (topic.kind, topic.box) == (parts.TOPIC, "onboard")
    assert {(line.source, line.kind) for line in made.lines if line.target == topic.name} == {
        ("speech", parts.PUBLISHES), ("mouth", parts.SUBSCRIBES),
    }  # fmt: skip
    assert made.nodes["camera:tcp -h 10.0.0.9 -p 10100"].kind == parts.OUTSIDE


def test_a_dependence_without_a_connection_is_a_line() -> None:
    network = replace(speaking(), connections=())
    lines = {(line.source, line.target) for line in picture_of(network).lines if line.kind == parts.AFTER}
    assert lines == {("mouth", "motors"), ("mouth", "storm"), ("speech", "mouth"), ("speech", "storm")}


def test_layers_with_and_without_cycles() -> None:
    assert layers("abcd", {"a": ["b"], "b": ["c"]}) == {"a": 0, "b": 1, "c": 2, "d": 2}
    found = layers("abc", {"a": ["b"], "b": ["c"], "c": ["a"]})
    assert sorted(found.values()) == [0, 1, 2]
    chain = [str(number) for number in range(3000)]
    assert layers(chain, dict(zip(chain, ([name] for name in chain[1:]), strict=False)))["2999"] == 2999


def test_text_is_measured() -> None:
    assert width("iii", 10) < width("MMM", 10) < width("MMM", 10, bold=True)
    name = "left_front_wheel_motor_controller_7"
    cut = shortened(name, 13, 120)
    assert width(cut, 13) <= 120 and cut.startswith("left") and cut.endswith("7") and "…" in cut
    assert shortened("short", 13, 120) == "short"


@pytest.mark.parametrize(("count", "hosts"), [(1, 1), (3, 1), (20, 3), (60, 20), (200, 4), (200, 1)])
def test_nothing_overlaps(count: int, hosts: int) -> None:
    made = geometry_of(picture_of(large(count, hosts)))
    check(made)
    assert made.width < 3400 and len(made.nodes) == count


@st.composite
def pictures(draw_: st.DrawFn) -> Picture:
    made = Picture("any")
    made.boxes = [Box(f"h{i}", f"host {i}") for i in range(draw_(st.integers(0, 15)))]
    names = [f"n{i}" for i in range(draw_(st.integers(1, 25)))]
    kinds = st.sampled_from([parts.COMPONENT, parts.PROGRAM, parts.ICESTORM, parts.TOPIC, parts.OUTSIDE])
    for name in names:
        title = draw_(st.text(st.characters(codec="utf-8"), min_size=1, max_size=60))
        box = draw_(st.sampled_from(["", *(box.name for box in made.boxes)]))
        serves = tuple((f"Interface{i}", 10000 + i) for i in range(draw_(st.integers(0, 9))))
        made.nodes[name] = PictureNode(name, title, draw_(kinds), box, serves=serves)
    ends = st.tuples(st.sampled_from(names), st.sampled_from(names))
    labels, line_kinds = st.sampled_from(["", "Laser", "JointMotor: JointMotors"]), st.sampled_from([
        parts.USES, parts.PUBLISHES, parts.SUBSCRIBES, parts.AFTER,
    ])  # fmt: skip
    for source, target in draw_(st.lists(ends, max_size=50)):
        made.lines.append(PictureLine(source, target, draw_(labels), draw_(line_kinds)))
    return made


@settings(max_examples=80, deadline=None)
@given(pictures())
def test_nothing_overlaps_in_any_picture(picture: Picture) -> None:
    check(geometry_of(picture))
    for form in FORMS:
        text = draw(picture, form)
        if form == "svg":
            ElementTree.fromstring(text.encode())
        elif form == "json":
            json.loads(text)


def check(made: Geometry) -> None:
    """No two nodes, hosts or labels overlap, and no line runs through a node or on another line's track."""
    nodes = list(made.nodes.values())
    for one, other in combinations(nodes, 2):
        assert not overlap(one, other)
    for one, other in combinations(made.hosts.values(), 2):
        assert not overlap(one, other)
    labels = [
        Rectangle(x + 5, y - 6 - LABEL, width(net.label, LABEL), LABEL) for net, (x, y) in made.labels if net.label
    ]
    for label in labels:
        assert not any(overlap(label, node) for node in nodes)
    for one, other in combinations(labels, 2):
        assert not overlap(one, other)
    used: dict[tuple[str, float], list[tuple[float, float, object]]] = {}
    for way in made.paths:
        for (x1, y1), (x2, y2) in zip(way.points, way.points[1:], strict=False):
            assert x1 == x2 or y1 == y2
            segment = Rectangle(min(x1, x2), min(y1, y2), abs(x1 - x2), abs(y1 - y2))
            assert not any(overlap(segment, node, 0.5) for node in nodes)
            assert segment.x >= 0 and segment.x + segment.width <= made.width
            assert segment.y >= 0 and segment.y + segment.height <= made.height
            key, span = (("x", x1), (y1, y2)) if x1 == x2 else (("y", y1), (x1, x2))
            used.setdefault(key, []).append((min(span), max(span), way.net))
    for runs in used.values():
        for (first, last, net), (begin, end, other) in combinations(runs, 2):
            assert net is other or min(last, end) - max(first, begin) < 0.5


def overlap(one: Rectangle, other: Rectangle, room: float = 0.0) -> bool:
    return (one.x + one.width > other.x + room and other.x + other.width > one.x + room
            and one.y + one.height > other.y + room and other.y + other.height > one.y + room)  # fmt: skip


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
@pytest.mark.parametrize("network", [speaking(), large(30)], ids=["head", "large"])
def test_graphviz_accepts_it(network: Network) -> None:
    done = subprocess.run(["dot", "-Tsvg"], input=draw(picture_of(network), "dot"), capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
