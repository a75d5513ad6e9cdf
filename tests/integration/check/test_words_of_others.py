"""Hints at words of other formats, at names instead of paths, and no report that only follows from another one."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
TREE = {
    "rcyaml.yaml": "interfaces: [idl]\n",
    "idl/Arm.idsl.yaml": "module: RoboCompArm\ntypes: {Way: {sequence: float}}\ninterfaces: {Arm: {methods: {go: }}}\n",
    "parts/arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "parts/arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters:\n  speed: {type: int, range: [1, 9], default: 3}\n",
    "parts/arm/etc/config.yaml": "parameters: {speed: 4}\n",
    "nets/robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  arm: {component: ../parts/arm}\n",
}
IDSL, CDSL, PDSL, DDSL = list(TREE)[1], list(TREE)[2], list(TREE)[3], list(TREE)[5]


@pytest.mark.parametrize(
    ("path", "old", "new", "code", "hint"),
    [
        (CDSL, "python", "c++", "RC0204", "did you mean 'cpp'?"),
        (CDSL, "python", "py", "RC0204", "did you mean 'python'?"),
        (CDSL, "implements", "provides", "RC0202", "did you mean 'implements'?"),
        (IDSL, "sequence", "vector", "RC0202", "did you mean 'sequence'?"),
        (IDSL, "sequence: float", "dictionary: {key: int, value: int}", "RC0202", "did you mean 'map'?"),
        (PDSL, "range: [1, 9]", "min: 1", "RC0202", "write `range: [LOWEST, HIGHEST]`"),
        (PDSL, "range: [1, 9]", "choices: [1, 3]", "RC0202", "did you mean 'values'?"),
        (DDSL, "../parts/arm}", "../parts/arm, depends_on: [x]}", "RC0202", "did you mean 'after'?"),
        (DDSL, "../parts/arm", "ArmComp", "RC4101", "did you mean '../parts/arm', the folder of ArmComp?"),
        (DDSL, "../parts/arm", "ArmCmp", "RC4101", "did you mean '../parts/arm', the folder of ArmComp?"),
        (DDSL, "../parts/arm", "Legs", "RC4101", ""),
        (CDSL, "implements: [Arm]", "implements: Arm", "RC0204", ""),
    ],
)
def test_one_report(rcyaml: Run, tmp_path: Path, path: str, old: str, new: str, code: str, hint: str) -> None:
    write_tree(tmp_path, {**TREE, path: TREE[path].replace(old, new)})
    found = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    assert [(one["code"], one["file"], one["hint"]) for one in found if one["code"] != "RC4403"] == [(code, path, hint)]
