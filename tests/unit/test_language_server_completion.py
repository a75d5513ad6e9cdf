"""What completion offers at each place: names that fit there, also while a bracket is not closed."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from in_memory import ROOT, analysed
from robocomp_yaml.lsp.completion import proposals
from robocomp_yaml.lsp.places import typed_at
from robocomp_yaml.naming.analysis import names_of

WORKSPACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Pose.idsl.yaml": "module: RoboCompPose\ntypes: {Pose: {struct: {x: float}}}\nexceptions: {Lost: {struct: {x: int}}}\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\nimports: [Pose]\ninterfaces: {Arm: {methods: {stop: }}}\ntopics: {Moved: {methods: {moved2: }}}\n"
    ),
    "interfaces/Eye.idsl.yaml": "module: RoboCompEye\ninterfaces: {Eye: {methods: {look: }}}\ntopics: {Seen: {methods: {saw: }}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters:\n  speed: {type: int, default: 1}\n  camera: {group: {width: {type: int, default: 1}}}\n",
    "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: python\nimports: [Eye]\nimplements: [Eye]\n",
}  # fmt: skip
IMPORTABLE = ["Arm", "Eye", "Pose"]
NAMES = names_of(analysed(WORKSPACE))

IDSL = "module: RoboCompLeg\nimports: [Pose]\ntypes: {Own: {enum: [a]}}\n"
CDSL = "component: C\nlanguage: python\nimports: [Arm]\n"
DDSL = "deployment: D\nhosts: {left: 10.0.0.2, right: 10.0.0.3}\ncomponents:\n  one: {component: arm}\n"
ROWS = [
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [|]\n", ["Arm", "Eye", "Pose"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [Pose, E|]\n", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports: [Pose, |", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", "module: RoboCompLeg\nimports:\n  - Pose\n  - |\n", ["Arm", "Eye"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{in: {{a: |}}}}}}}}}}\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{in: {{a: Po|", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces:\n  I:\n    methods:\n      m: {{returns: |\n      n:\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}interfaces: {{I: {{methods: {{m: {{throws: [|]}}}}}}}}\n", ["Pose.Lost"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}exceptions: {{E: {{struct: {{x: |}}}}}}\n", ["Own", "Pose.Pose"]),
    ("interfaces/Leg.idsl.yaml", f"{IDSL}topics: {{|}}\n", []),
    ("leg/leg.cdsl.yaml", "component: C\nlanguage: python\nimports: [|]\n", ["Arm", "Eye", "Pose"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}implements: [|]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: A|}}]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: {{interface: |}}}}]\n", ["Arm", "Eye +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}requires: [{{Left: {{absent: |}}}}]\n", []),
    ("leg/leg.cdsl.yaml", f"{CDSL}publishes:\n  - |\nperiod: 5\n", ["Moved", "Seen +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}subscribes: [M|", ["Moved", "Seen +Eye"]),
    ("leg/leg.cdsl.yaml", f"{CDSL}language: |\n", []),
    ("leg/leg.cdsl.yaml", f"{CDSL}# implements: [|\n", []),
    ("leg/leg.pdsl.yaml", "types: {Joint: {struct: {n: string}}}\nparameters: {a: {type: |}}\n", ["Joint"]),
    ("leg/leg.pdsl.yaml", "types: {Joint: {struct: {n: string}}}\nparameters:\n  a: {list: J|\n  b: {type: int}\n", ["Joint"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: |}}\n", ["arm", "eye"]),
    ("lab/robot.ddsl.yaml", f"{DDSL}  two: {{component: ../a|\n", ["../arm", "../eye"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, host: |}}\n", ["left", "right"]),
    ("robot.ddsl.yaml", f"{DDSL}services: {{storm: {{icestorm: {{host: |}}}}}}\n", ["left", "right"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, connect: {{Arm: |}}}}\n", ["one"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye, after: [|]}}\nservices: {{storm: {{icestorm: }}}}\n", ["one", "storm"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: eye}}\ngroups: {{g: {{components: [one, |]}}}}\n", ["one", "two"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: {{|}}}}\n", ["speed", "camera"]),
    ("robot.ddsl.yaml", f"{DDSL}  two:\n    component: arm\n    set:\n      sp|\n", ["speed", "camera"]),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm, set: |}}\n", []),
    ("robot.ddsl.yaml", f"{DDSL}  two: {{component: arm/arm.cdsl.yaml, set: {{camera: {{w|: 3}}}}}}\n", ["width"]),
    ("robot.ddsl.yaml", "deployment: |\n", []),
]  # fmt: skip


@pytest.mark.parametrize(("file", "marked", "expected"), ROWS)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_what_is_offered(file: str, marked: str, expected: list[str], end: str) -> None:
    before, _, behind = marked.replace("\n", end).partition("|")
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    place = typed_at(before + behind, line, column)
    found = proposals(f"{ROOT}/{file}", place, NAMES, IMPORTABLE) if place is not None else []
    assert sorted(f"{one.text} +{one.imports}" if one.imports else one.text for one in found) == sorted(expected)


def test_the_word_at_the_cursor_is_replaced() -> None:
    place = typed_at("module: RoboCompA\ntypes: {P: {sequence: Pose.Po}}\n", 2, 26)
    assert place is not None and place.keys == ("types", "P", "sequence")
    assert (place.line, place.column, place.end_column) == (2, 23, 30)


@pytest.mark.parametrize("text", ["", "a: [b: {", "\x00", "x: |\n  text", "- a\n- b"])
def test_odd_texts_have_no_place_or_one(text: str) -> None:
    for column in range(1, 12):
        for line in (1, 2, 9):
            typed_at(text, line, column)
