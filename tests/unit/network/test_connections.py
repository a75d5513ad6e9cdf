"""Connections of required interfaces: explicit, by candidates, and the diagnostics for no candidate or several."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import Tree
from deployments import FACE, MOUTH, component, deployed, faults, network, said
from robocomp_yaml.network.network import Connection, Network


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def proxies(found: Network) -> dict[str, tuple[str, str]]:
    return {f"{line.source}.{line.port}": (line.target, line.proxy) for line in found.connections}


def line_of(found: Network, source: str) -> Connection:
    (line,) = [line for line in found.connections if line.source == source]
    return line


BOTH = "  speech: {component: speech}\n  mouth: {component: mouth, port: 10002}\n"


def test_the_only_candidate() -> None:
    found = network(deployed(f"components:\n{BOTH}"))
    assert proxies(found) == {"speech.Mouth": ("mouth", "mouth:tcp -h localhost -p 10002")}
    assert found.processes["speech"].after == ("mouth",)
    assert line_of(found, "speech").span.line == 3


@pytest.mark.parametrize(
    ("target", "port"),
    [
        ("other", 10005),
        ("other.Mouth", 10005),
        ("mouth", 10002),
        ("all", 10006),
        ("base", 10007),
        ("laser.Mouth", 10007),
    ],
)
def test_as_connect_says(target: str, port: int) -> None:
    found = network(
        deployed(
            f"components:\n  speech: {{component: speech, connect: {{Mouth: {target}}}}}\n"
            "  mouth: {component: mouth, port: 10002}\n  other: {component: mouth, port: 10005}\n"
            "  third: {component: mouth, port: 10006}\n  laser: {program: sh, endpoints: {Laser: tcp -p 10003}}\n"
            "  base: {process: laser, endpoints: {Mouth: tcp -p 10007}}\n"
            "groups: {all: {components: [third]}}\n"
        )
    )
    assert line_of(found, "speech").proxy == f"mouth:tcp -h localhost -p {port}"


def test_a_proxy_of_an_external_server() -> None:
    text = "mouth:tcp -h 10.0.0.9 -p 10002"
    found = network(deployed(f'components: {{speech: {{component: speech, connect: {{Mouth: "{text}"}}}}}}\n'))
    assert proxies(found) == {"speech.Mouth": ("", text)}


def test_an_equal_interface_of_another_document() -> None:
    files = deployed(f"components:\n{BOTH}", **{"Copy.idsl.yaml": f"# a copy\n{FACE}"})
    network({**files, "mouth/mouth.cdsl.yaml": component("MouthComp", MOUTH, "Copy")})


@pytest.mark.parametrize(
    ("was", "now", "difference", "place"),
    [
        ("returns: bool", "returns: int", "what 'moveTo' returns is bool in one, and int in the other", (6, 57)),
        ("pose: Pose", "to: Pose", "'moveTo' has 'pose' where the other has 'to'", (6, 35)),
        ("y: float", "z: float", "RoboCompFace.Pose has 'y' where the other has 'z'", (3, 47)),
        ("unit: mm", "unit: m", "'x' of RoboCompFace.Pose is in mm in one, and in m in the other", (3, 19)),
        ("moveTo", "move", "'moveTo' is in one only", (6, 21)),
        (
            "module: RoboCompFace",
            "module: RoboCompFaces",
            "its module is RoboCompFace in one, and RoboCompFaces in the other",
            (6, 3),
        ),
    ],
)
def test_the_same_name_with_another_content(was: str, now: str, difference: str, place: tuple[int, int]) -> None:
    files = deployed(f"components:\n{BOTH}", **{"Other.idsl.yaml": FACE.replace(was, now)})
    (found,) = faults({**files, "mouth/mouth.cdsl.yaml": component("MouthComp", MOUTH, "Other")})
    assert said(found) == ("RC4203", "robot.ddsl.yaml", 3, 3)
    assert found.message.endswith(difference)
    first, second = (related.span for related in found.related)
    assert (first.file, first.line, first.column) == ("Face.idsl.yaml", *place)
    assert second.file == "Other.idsl.yaml"


def test_documentation_and_defaults_make_no_difference() -> None:
    other = FACE.replace("y: float", "y: {type: float, default: 2, doc: Up.}")
    files = deployed(f"components:\n{BOTH}", **{"Other.idsl.yaml": other})
    network({**files, "mouth/mouth.cdsl.yaml": component("MouthComp", MOUTH, "Other")})


def test_several_candidates() -> None:
    (found,) = faults(deployed(f"components:\n{BOTH}  other: {{component: mouth}}\n"))
    assert said(found) == ("RC4202", "robot.ddsl.yaml", 3, 3)
    assert found.message.endswith("several processes serve: mouth, other")
    assert [related.span.file for related in found.related] == [*["robot.ddsl.yaml"] * 2, "speech/speech.cdsl.yaml"]


def test_a_disabled_process_is_not_a_candidate_beside_an_enabled_one() -> None:
    found = network(deployed(f"components:\n{BOTH}  other: {{component: mouth, enabled: false}}\n"))
    assert line_of(found, "speech").target == "mouth"


def test_no_candidate() -> None:
    (found,) = faults(deployed("components: {speech: {component: speech}}\n"))
    assert said(found) == ("RC4201", "robot.ddsl.yaml", 2, 14) and found.severity == "error"
    assert found.related[0].span.file == "speech/speech.cdsl.yaml"


def test_no_candidate_for_what_can_be_absent() -> None:
    lists = "requires: [{Mouth: {interface: Mouth, absent: ignore}}]\n"
    (found,) = faults(deployed("components: {speech: {component: speech}}\n", speech=lists))
    assert (found.code, found.severity) == ("RC4201", "warning")


def test_an_unreadable_document_may_serve_anything() -> None:
    files = deployed(f"components:\n{BOTH}")
    found = faults({**files, "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: klingon\n"})
    assert {fault.span.file for fault in found} == {"mouth/mouth.cdsl.yaml"}


@pytest.mark.parametrize("connect", ["", ", connect: {Mouth: mouth}"])
def test_an_unreadable_interface_is_not_reported_again(connect: str) -> None:
    files = deployed(f"components:\n  speech: {{component: speech{connect}}}\n  mouth: {{component: mouth}}\n")
    found = faults({**files, "Face.idsl.yaml": "module: [\n"})
    assert {fault.span.file for fault in found} == {"Face.idsl.yaml"}


@pytest.mark.parametrize(
    ("connect", "code", "hint"),
    [
        ("speech", "RC4204", "it serves Speech, CommonBehavior"),
        ("mouth.Speech", "RC4204", "it serves Mouth, CommonBehavior"),
        ("storm", "RC4204", "it is an IceStorm, which carries topics"),
        ("muoth", "RC4205", "did you mean 'mouth'?"),
    ],
)
def test_connect_names_a_process_that_does_not_serve_it(connect: str, code: str, hint: str) -> None:
    (found,) = faults(
        deployed(
            f"services: {{storm: {{icestorm: {{}}}}}}\ncomponents:\n  speech: {{component: speech, connect: {{Mouth: "
            f"{connect}}}}}\n  mouth: {{component: mouth}}\n"
        )
    )
    assert said(found) == (code, "robot.ddsl.yaml", 4, 48)
    assert found.hint == hint


def group(text: str, connect: str = "") -> Tree:
    return deployed(
        f"components:\n  speech: {{component: speech{connect}}}\n  mouth: {{component: mouth, port: 10002}}\n"
        f"  other: {{component: mouth, port: 10003}}\n  inner: {{component: speech}}\ngroups:\n  face: {text}\n"
    )


def test_a_closed_group_is_not_a_candidate_outside() -> None:
    found = network(group("{components: [inner, other], expose: {Speech: inner}}"))
    assert line_of(found, "inner").target == "other" and line_of(found, "speech").target == "mouth"


def test_a_connection_to_a_group_is_one_to_the_member_that_serves() -> None:
    found = network(group("{components: [inner, other], expose: {Mouth: other}}", ", connect: {Mouth: face}"))
    assert line_of(found, "speech").target == "other"


@pytest.mark.parametrize("connect", ["face.Lips", "face.Mouth"])
def test_what_a_group_serves_has_a_name_of_its_own(connect: str) -> None:
    found = network(
        group(
            "{components: [inner, other], expose: {Lips: other.Mouth, Speech: inner}}",
            f", connect: {{Mouth: {connect}}}",
        )
    )
    assert line_of(found, "speech").target == "other"


def test_what_a_group_does_not_serve() -> None:
    (found,) = faults(group("{components: [inner, other], expose: {Speech: inner}}", ", connect: {Mouth: face.Mouth}"))
    assert said(found) == ("RC4204", "robot.ddsl.yaml", 3, 48) and found.hint == "it serves Speech"


def test_members_of_a_closed_group_cannot_be_connected_from_outside() -> None:
    (found,) = faults(group("{components: [inner, other], expose: {Speech: inner}}", ", connect: {Mouth: other}"))
    assert said(found) == ("RC4206", "robot.ddsl.yaml", 3, 48)


def test_a_rule_adds_a_gate() -> None:
    found = network(
        group(
            "{components: [inner, other], expose: {Lips: {member: other.Mouth, rate: 10}}}", ", connect: {Mouth: face}"
        )
    )
    gate = found.processes["face.gate"]
    assert proxies(found)["speech.Mouth"] == ("face.gate", f"mouth:tcp -h localhost -p {gate.endpoints[0].port}")
    assert proxies(found)["face.gate.Lips"][0] == "other" and proxies(found)["inner.Mouth"][0] == "other"
    assert (gate.groups, gate.after, gate.ready.port) == (("face",), ("other",), gate.endpoints[0].port)
    assert found.processes["speech"].after == ("face.gate",)


def test_gates_of_nested_groups_are_connected_in_series() -> None:
    found = network(
        deployed(
            "components:\n  speech: {component: speech}\n  mouth: {component: mouth, port: 10002}\ngroups:\n"
            "  lips: {components: [mouth], expose: {Mouth: {member: mouth, allow: [moveTo]}}}\n"
            "  face: {components: [lips], expose: {Mouth: {member: mouth, rate: 5}}}\n"
        )
    )
    assert [(line.source, line.target) for line in found.connections] == [
        ("speech", "face.gate"),
        ("lips.gate", "mouth"),
        ("face.gate", "lips.gate"),
    ]
    assert found.order == (("mouth",), ("lips.gate",), ("face.gate",), ("speech",))


def test_a_process_after_a_group_is_after_its_gates() -> None:
    found = network(
        deployed(
            "components:\n  mouth: {component: mouth, after: [other]}\n  other: {program: sleep}\n"
            "  watch: {program: sleep, after: [face]}\ngroups:\n"
            "  lips: {components: [mouth], expose: {Mouth: {member: mouth, rate: 5}}}\n"
            "  face: {components: [lips, other]}\n"
        )
    )
    assert set(found.processes["watch"].after) == {"lips.gate", "mouth", "other"}
    assert found.processes["mouth"].after == ("other",)


def test_a_member_is_not_after_the_gate_that_needs_it() -> None:
    found = network(
        deployed(
            "components:\n  mouth: {component: mouth, after: [lips]}\n"
            "groups: {lips: {components: [mouth], expose: {Mouth: {member: mouth, rate: 5}}}}\n"
        )
    )
    assert found.order == (("mouth",), ("lips.gate",))


def test_a_process_that_can_be_ignored_is_optional() -> None:
    files = deployed("components:\n  speech: {component: speech}\n  mouth: {component: mouth}\n")
    text = str(files["speech/speech.cdsl.yaml"]).replace("[Mouth]", "[{Mouth: {interface: Mouth, absent: ignore}}]")
    speech = network({**files, "speech/speech.cdsl.yaml": text}).processes["speech"]
    assert (speech.after, speech.optional) == (("mouth",), ("mouth",))
    assert network(files).processes["speech"].optional == ()


def test_the_inner_group_can_come_later_in_the_document() -> None:
    found = network(
        deployed(
            "components:\n  speech: {component: speech, connect: {Mouth: face}}\n  mouth: {component: mouth}\ngroups:\n"
            "  face: {components: [lips], expose: {Mouth: {member: mouth, rate: 5}}}\n"
            "  lips: {components: [mouth], expose: {Mouth: {member: mouth, allow: [moveTo]}}}\n"
        )
    )
    assert found.order == (("mouth",), ("lips.gate",), ("face.gate",), ("speech",))


def test_candidates_in_closed_groups_are_named_by_the_groups() -> None:
    (found,) = faults(
        deployed(
            "components:\n  speech: {component: speech}\n  mouth: {component: mouth}\n  other: {component: mouth}\n"
            "groups:\n  left: {components: [mouth], expose: {Mouth: mouth}}\n"
            "  right: {components: [other], expose: {Lips: other.Mouth}}\n"
        )
    )
    assert found.message.endswith("several processes serve: left.Mouth, right.Lips")
    assert found.hint == "write `connect: {Mouth: left.Mouth}`, or another one"


def test_an_include_prefers_connections_inside() -> None:
    arm = "deployment: Arm\ncomponents:\n  speech: {component: speech}\n  mouth: {component: mouth}\n"
    found = network(
        deployed(
            "components:\n  speech: {component: speech, connect: {Mouth: left.mouth}}\n"
            "include: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n",
            **{"arm.ddsl.yaml": arm},
        )
    )
    assert {line.source: line.target for line in found.connections} == {
        "speech": "left.mouth",
        "left.speech": "left.mouth",
        "right.speech": "right.mouth",
    }


def test_an_include_can_be_connected_to_another_include() -> None:
    files = deployed(
        "include: [a.ddsl.yaml, b.ddsl.yaml]\n",
        **{
            "a.ddsl.yaml": "deployment: A\ncomponents: {speech: {component: speech}}\n",
            "b.ddsl.yaml": "deployment: B\ncomponents: {mouth: {component: mouth}}\n",
        },
    )
    assert not faults(files)


def test_one_cause_is_reported_once() -> None:
    (found,) = faults(deployed('components: {"speech{i}": {component: speech, instances: 20}}\n'))
    assert said(found) == ("RC4201", "robot.ddsl.yaml", 2, 14)


def test_a_program_gets_proxies_by_name() -> None:
    found = network(
        deployed(
            "components:\n  mouth: {component: mouth, port: 10002}\n"
            "  p: {program: sh, config-as: --Ice.Config, connect: {Lips: mouth.Mouth}}\n"
        )
    )
    assert proxies(found) == {"p.Lips": ("mouth", "mouth:tcp -h localhost -p 10002")}
    assert found.processes["p"].after == ("mouth",)
