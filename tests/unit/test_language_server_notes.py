"""What is shown beside the text: users and values in hover, lenses, and hints in lines."""

from __future__ import annotations

import pytest

from in_memory import ROOT, analysed, text_at
from robocomp_yaml.lsp import notes, users
from robocomp_yaml.lsp.session import KnownNames
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import DefinedName

WORKSPACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\ninterfaces: {Arm: {methods: {stop: }}, Idle: {methods: {wait: }}}\ntopics: {Moved: {methods: {arrived: }}}\n"
    ),
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\npublishes: [Moved]\n",
    "arm/arm.pdsl.yaml": (
        "component: arm.cdsl.yaml\nparameters:\n  speed: {type: float, default: 1, range: [0, 2], unit: m/s}\n"
        "  token: {type: string, optional: true, secret: true}\n  size: {type: int, default: 3}\n"
    ),
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 1.5}\n",
    "hand/hand.cdsl.yaml": "component: HandComp\nlanguage: python\nimports: [Arm]\nrequires: [Arm]\nsubscribes: [Moved]\n",
    "robot.ddsl.yaml": (
        "deployment: Robot\nhosts: {left: 10.0.0.2}\nservices: {storm: {icestorm: {host: left}}}\ncomponents:\n"
        "  arm: {component: arm, host: left, port: 11000, set: {speed: 0.5}}\n  'hand{i}': {component: hand, host: left, instances: 2}\n"
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def known() -> KnownNames:
    analysis = analysed(WORKSPACE)
    return KnownNames(names_of(analysis), analysis)


def named(known: KnownNames, kind: str, name: str) -> DefinedName:
    return next(one for one in known.names.of_kinds(kind) if one.name == name)


@pytest.mark.parametrize(
    ("kind", "name", "lens"),
    [
        ("interface", "Arm", ["1 implements it, 1 requires it"]),
        ("interface", "Idle", ["no component uses it"]),
        ("topic", "Moved", ["1 publishes it, 1 subscribes to it"]),
        ("component", "HandComp", ["2 processes"]),
        ("component", "ArmComp", ["1 process"]),
        ("entry", "hand{i}", ["4 connections, 0 to it"]),
        ("entry", "arm", ["1 connection, 2 to it"]),
        ("host", "left", []),
    ],
)
def test_lenses(known: KnownNames, kind: str, name: str, lens: list[str]) -> None:
    assert list(notes.lens_of(known, named(known, kind, name))) == lens


@pytest.mark.parametrize(
    ("kind", "name", "expected"),
    [
        ("interface", "Arm", "implemented by ArmComp|required by HandComp"),
        ("topic", "Moved", "published by ArmComp|subscribed to by HandComp"),
        ("component", "HandComp", "processes: hand0 (robot.ddsl.yaml), hand1 (robot.ddsl.yaml)"),
        ("host", "left", "processes: arm, hand0, hand1"),
        ("parameter", "speed", "A number from 0 to 2 (m/s); default: 1.|effective values:\n- `1.5 m/s` in etc/config.yaml\n- `0.5 m/s` for arm (robot.ddsl.yaml)"),
        ("entry", "hand{i}", "hand0:\n- serves CommonBehavior: `tcp -h 10.0.0.2 -p PORT`\n- Arm → arm\n- subscribes to Moved"),
    ],
)  # fmt: skip
def test_hover_shows_users_and_values(known: KnownNames, kind: str, name: str, expected: str) -> None:
    found = "|".join(users.described(known.analysis, named(known, kind, name)))
    if "PORT" in expected:
        assert "- Arm → arm" in found and "- subscribes to Moved" in found and found.startswith("hand0:")
    else:
        assert found == expected


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("robot.ddsl.yaml", {"arm": "⟨Arm 11000", "hand": "⟨CommonBehavior"}),
        ("arm/arm.cdsl.yaml", {"Arm": "⟨tcp "}),
        ("hand/hand.cdsl.yaml", {"Arm": "⟨→ ArmComp⟩"}),
        ("arm/etc/config.yaml", {"parameters": "⟨"}),
        ("interfaces/Arm.idsl.yaml", {}),
    ],
)
def test_hints(known: KnownNames, file: str, expected: dict[str, str]) -> None:
    found = {text_at(WORKSPACE[file], span): label for span, label, _ in notes.hints_of(known, f"{ROOT}/{file}")}
    assert found.keys() == expected.keys()
    for at, label in expected.items():
        assert found[at].startswith(label), found


def test_the_defaults_of_a_values_document_are_listed(known: KnownNames) -> None:
    ((_, label, more),) = list(notes.hints_of(known, f"{ROOT}/arm/etc/config.yaml"))
    assert "size: 3" in more and "speed" not in more and label


@pytest.mark.parametrize(
    "values", ["component: ../leg.cdsl.yaml\nparameters: {speed: 1}\n", "parameters: {speed: 1}\n"]
)
def test_values_of_an_unknown_component_have_no_hints(values: str) -> None:
    place = {
        "rcyaml.yaml": "",
        "etc/config.yaml": f"# yaml-language-server: $schema=.rcyaml/schemas/config.schema.json\n{values}",
    }
    analysis = analysed(place)
    assert analysis.program.values
    assert not list(notes.hints_of(KnownNames(names_of(analysis), analysis), f"{ROOT}/etc/config.yaml"))
