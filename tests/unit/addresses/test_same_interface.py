"""Two documents that define one interface: when the definitions are equal, and the diagnostic when they differ."""

from __future__ import annotations

import pytest

from deployments import component
from in_memory import Said, said

FACE = """\
module: RoboCompFace
types:
  Pose: {struct: {x: {type: float, unit: mm}, y: float}}
  Mode: {enum: [slow, fast]}
  Poses: {sequence: Pose}
  Named: {map: {key: string, value: Pose}}
exceptions:
  Stuck: {struct: {why: string}}
  Lost: {struct: {why: string}}
interfaces:
  Mouth:
    methods:
      go: {in: {pose: Pose, mode: Mode}, out: {left: float}, returns: {type: bool, unit: s}, throws: [Stuck]}
      all: {in: {poses: Poses, named: Named}}
      stop:
"""


def told(was: str, now: str) -> list[Said]:
    """The diagnostics when one component requires the interface of one document, and another serves that of the
    other."""
    assert was in FACE
    text = "deployment: R\ncomponents: {speech: {component: speech}, mouth: {component: mouth}}\n"
    return said(
        {
            "robot.ddsl.yaml": text,
            "Face.idsl.yaml": FACE,
            "Other.idsl.yaml": FACE.replace(was, now, 1),
            "rcyaml.yaml": "lint: {RC4403: 'off'}\n",
            "speech/speech.cdsl.yaml": component("SpeechComp", "requires: [Mouth]\n"),
            "mouth/mouth.cdsl.yaml": component("MouthComp", "implements: [Mouth]\n", "Other"),
        },
        "robot.ddsl.yaml",
    )


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ("[slow, fast]", "{slow: 0, fast: 1}"),
        ("unit: mm", "unit: mm, doc: Ahead."),
        ("{type: float, unit: mm}", "float"),
    ],
)
def test_equal_definitions(was: str, now: str) -> None:
    assert told(was, now) == []


@pytest.mark.parametrize(
    ("was", "now", "difference", "places"),
    [
        ('go: {in', 'goto: {in', "'go' is in one only", ['go', 'Mouth']),
        ('      stop:\n', '', "'stop' is in one only", ['stop', 'Mouth']),
        ('      stop:\n', '      stop:\n      rest:\n', "'rest' is in one only", ['Mouth', 'rest']),
        ('go: {in', 'go: {idempotent: true, in', "'go' is idempotent in one only", ['go', 'go']),
        ('pose: Pose, mode', 'to: Pose, mode', "'go' has 'pose' where the other has 'to'", ['pose', 'to']),
        ('pose: Pose, mode: Mode', 'pose: Pose', "'mode' of 'go' is in one only", ['go', 'go']),
        ('mode: Mode}', 'mode: Mode, more: int}', "'more' of 'go' is in one only", ['go', 'go']),
        ('out: {left: float}', 'out: {left: double}', "'left' of `out` of 'go' is float in one, and double in the other", ['float', 'double']),
        ('out: {left: float}, ', '', "'left' of `out` of 'go' is in one only", ['go', 'go']),
        ('returns: {type: bool, unit: s}', 'returns: int', "what 'go' returns is bool in one, and int in the other", ['bool', 'int']),
        ('returns: {type: bool, unit: s}, ', '', "'go' returns something in one only", ['go', 'go']),
        ('unit: s', 'unit: ms', "what 'go' returns is in s in one, and in ms in the other", ['go', 'go']),
        ('throws: [Stuck]', 'throws: [Lost]', "'go' throws Lost in one only", ['go', 'go']),
        ('throws: [Stuck]', 'throws: [Stuck, Lost]', "'go' throws Lost in one only", ['go', 'go']),
        (', throws: [Stuck]', '', "'go' throws Stuck in one only", ['go', 'go']),
        ('Stuck: {struct: {why: string}}', 'Stuck: {struct: {why: int}}', "'why' of RoboCompFace.Stuck is string in one, and int in the other", ['string', 'int']),
        ('x: {type: float, unit: mm}', 'x: {type: float, unit: m}', "'x' of RoboCompFace.Pose is in mm in one, and in m in the other", ['x', 'x']),
        ('x: {type: float, unit: mm}', 'x: double', "'x' of RoboCompFace.Pose is float in one, and double in the other", ['float', 'double']),
        ('y: float', 'z: float', "RoboCompFace.Pose has 'y' where the other has 'z'", ['y', 'z']),
        (', y: float', '', "'y' of RoboCompFace.Pose is in one only", ['Pose', 'Pose']),
        ('y: float}', 'y: float, z: float}', "'z' of RoboCompFace.Pose is in one only", ['Pose', 'Pose']),
        ('[slow, fast]', '[fast, slow]', 'the enumerators of RoboCompFace.Mode differ', ['Mode', 'Mode']),
        ('[slow, fast]', '{slow: 0, fast: 2}', 'the enumerators of RoboCompFace.Mode differ', ['Mode', 'Mode']),
        ('Poses: {sequence: Pose}', 'Poses: {sequence: float}', 'an element of RoboCompFace.Poses is Pose in one, and float in the other', ['Pose', 'float']),
        ('key: string', 'key: int', 'a key of RoboCompFace.Named is string in one, and int in the other', ['string', 'int']),
        ('value: Pose', 'value: Mode', 'a value of RoboCompFace.Named is RoboCompFace.Pose in one, and RoboCompFace.Mode in the other', ['Pose', 'Mode']),
        ('Mode: {enum: [slow, fast]}', 'Mode: {struct: {a: int}}', 'RoboCompFace.Mode has two kinds of definition', ['Mode', 'Mode']),
        ('module: RoboCompFace', 'module: RoboCompFaces', 'its module is RoboCompFace in one, and RoboCompFaces in the other', ['Mouth', 'Mouth']),
        ('mode: Mode}', 'mode: string}', "'mode' of 'go' is Mode in one, and string in the other", ['Mode', 'string']),
    ],
)  # fmt: skip
def test_different_definitions(was: str, now: str, difference: str, places: list[str]) -> None:
    (found,) = told(was, now)
    assert found.code == "RC4203" and found.message.endswith(f"define Mouth differently: {difference}")
    assert [at for _, at in found.related] == places


def test_only_the_first_difference_is_reported() -> None:
    assert len(told("{x: {type: float, unit: mm}, y: float}", "{a: int}")) == 1
