"""Fixes that need more than one document, as they are applied."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from in_memory import ROOT, analysed
from robocomp_yaml.fixing import _applied
from robocomp_yaml.lsp.more_fixes import more_fixes
from robocomp_yaml.lsp.session import KnownNames
from robocomp_yaml.naming.analysis import names_of

WORKSPACE = {
    "interfaces/Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {stop: }}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [../interfaces/Arm]\nimplements: [Arm]\n",
    "arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters:\n  speed: {type: int, default: 1}  # how fast\n",
    "hand/hand.cdsl.yaml": "component: HandComp\nlanguage: python\nimports: [../interfaces/Arm]\nrequires: [Arm]\n",
    "robot.ddsl.yaml": "deployment: R\ncomponents:\n  one: {component: arm}\n  two: {component: arm}\n  hand: {component: hand}\n",
}  # fmt: skip


def fixed(documents: dict[str, str], code: str) -> list[tuple[str, str]]:
    """What each further fix makes of the document that it changes."""
    analysis = analysed(documents)
    known = KnownNames(names_of(analysis), analysis)
    made = []
    for one in analysis.diagnostics:
        for fix in more_fixes(one, known) if one.code == code else ():
            contents = dict(analysis.disk.contents)
            ((path, after),) = _applied([fix], contents).items()
            made.append((fix.title, after.decode()))
            again = analysed({**documents, path.removeprefix(f"{ROOT}/"): after.decode()})
            assert code not in {other.code for other in again.diagnostics}
    return made


@pytest.mark.parametrize(
    ("hand", "expected"),
    [
        ("hand: {component: hand}", "hand: {component: hand, connect: {Arm: one}}"),
        ("hand: {component: hand, after: [one]}  # 🤖", "hand: {component: hand, after: [one], connect: {Arm: one}}  # 🤖"),
        ("hand:\n    component: hand  # block", "hand:\n    component: hand  # block\n    connect: {Arm: one}"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_port_is_connected_to_a_candidate(hand: str, expected: str, end: str) -> None:
    text = WORKSPACE["robot.ddsl.yaml"].replace("hand: {component: hand}", hand).replace("\n", end)
    made = fixed({**WORKSPACE, "robot.ddsl.yaml": text}, "RC4202")
    assert [title for title, _ in made] == ["connect Arm to 'one'", "connect Arm to 'two'"]
    assert made[0][1].endswith(expected.replace("\n", end) + end)


@pytest.mark.parametrize(
    ("value", "type_"),
    [("3", "int"), ("0.5", "float"), ("true", "bool"), ("x", "string"), ("[1, 2]", "{list: int}")],
)
def test_a_parameter_is_added(value: str, type_: str) -> None:
    values = f"component: ../arm.cdsl.yaml\nparameters: {{gain: {value}}}\n"
    made = fixed({**WORKSPACE, "arm/etc/config.yaml": values}, "RC3301")
    assert [title for title, _ in made] == ["add the parameter 'gain' to arm.pdsl.yaml"]
    assert made[0][1].endswith(f"  speed: {{type: int, default: 1}}  # how fast\n  gain: {type_}\n")


def test_under_set_too() -> None:
    text = WORKSPACE["robot.ddsl.yaml"].replace("one: {component: arm}", "one: {component: arm, set: {gain: 3}}")
    documents = {**WORKSPACE, "robot.ddsl.yaml": text.replace("  hand: {component: hand}\n", "")}
    assert len(fixed(documents, "RC3301")) == 1
