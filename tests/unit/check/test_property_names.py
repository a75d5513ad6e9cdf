"""Parameters whose properties clash: with each other, with those of Ice, or with those of the component's ports."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

Check = Callable[..., list[dict[str, object]]]
TREE = {
    "Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {stop: {}}}}\n"
    "topics: {Moved: {methods: {reported: {in: {n: int}}}}}\n",
    "c.cdsl.yaml": "component: C\nlanguage: cpp\nimports: [Arm]\nimplements: [Arm]\nrequires: [{Other: Arm}]\n"
    "subscribes: [Moved]\nparameters: c.pdsl.yaml\n",
}
_INT = "{type: int, default: 1}"


@pytest.mark.parametrize(
    ("parameters", "legacy", "reported"),
    [
        (f"arm: {_INT}", "", []),
        (
            f"Arm: {{group: {{x: {_INT}}}}}",
            "",
            ["RC3117 the properties of 'Arm.x' start like those of the adapter Arm"],
        ),
        (
            "Arm: {group: {Endpoints: {type: string, default: x}}}",
            "",
            ["RC3116 'Arm.Endpoints' and the endpoints of Arm both use the property 'Arm.Endpoints'"],
        ),
        (
            "statemachine: {group: {a: {type: int, default: 1}}}",
            "",
            ["RC3116 'statemachine.a' and the states of a state machine both use the property 'statemachine.…'"],
        ),
        (
            "MovedTopic: {group: {Endpoints: {type: string, default: x}}}",
            "",
            [
                "RC3116 'MovedTopic.Endpoints' and the endpoints of MovedTopic both use the property 'MovedTopic.Endpoints'"
            ],
        ),
        (f"OtherProxy: {_INT}", "", ["RC3116 'OtherProxy' and the proxy Other both use the property 'OtherProxy'"]),
        (f"Ice: {{group: {{x: {_INT}}}}}", "", ["RC3116 'Ice.x' and a property of Ice both use the property 'Ice.…'"]),
        (f"a: {_INT}, b: {_INT}", "a: X, b: X", ["RC3116 'b' and 'a' both use the property 'X'"]),
        (
            f"a: {_INT}, ids: {{list: int, default: []}}",
            "a: Id7, ids: {key: 'Id{i}'}",
            ["RC3116 'ids' and 'a' both use the property 'Id7'"],
        ),
    ],
)
def test_clashes(diagnostics: Check, tmp_path: Path, parameters: str, legacy: str, reported: list[str]) -> None:
    pdsl = f"component: c.cdsl.yaml\nparameters: {{{parameters}}}\nlegacy: {{{legacy}}}\n"
    found = diagnostics({**TREE, "c.pdsl.yaml": pdsl})
    assert [f"{each['code']} {each['message']}" for each in found] == reported
