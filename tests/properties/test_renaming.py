"""A name is renamed everywhere, and the workspace means the same: it checks and compiles as before, and the way back
gives the same bytes."""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import DefinedName
from robocomp_yaml.naming.renaming import key_after

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\ntypes:\n  Pose: {struct: {x: float, y: float}}\n  Mode: {enum: [slow, fast]}\n"
        "exceptions: {Lost: {struct: {why: string}}}\ninterfaces:\n  Arm:\n    methods:\n"
        "      carry: {in: {at: Pose}, returns: bool, throws: [Lost]}  # \U0001f916 carry\n      stop: {}\n"
        "  Grip: {methods: {close: {in: {how: Mode}}}}\ntopics: {Moved: {methods: {arrived: {in: {at: 'Pose'}}}}}\n"
    ),
    "arm/arm.cdsl.yaml": (
        "component: ArmComp\r\nlanguage: python\r\nimports: [Arm]\r\nimplements: [Arm, Grip]\r\npublishes: [RoboCompArm.Moved]\r\n"
        "statemachine:\r\n  initial: idle\r\n  final: over\r\n  events: [go]\r\n  states: {idle: , busy: }\r\n  transitions:\r\n"
        "    idle: [{to: busy, event: go}]\r\n    busy: [{to: over, if: \"not In('idle')\"}, idle]\r\n"
    ),
    "arm/arm.pdsl.yaml": (
        "component: arm.cdsl.yaml\ntypes: {Wheel: {struct: {radius: {type: float, default: 1}}}}\nparameters:\n"
        "  speed: {type: float, default: 1, range: [0, 2], editable: true}\n"
        "  camera: {group: {width: {type: int, default: 640, editable: true}}}\n"
        "  wheels: {list: Wheel, default: [{radius: 2}]}\nconstraints: [speed < camera.width]\n"
    ),
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 1.5, camera: {width: 320}}\n",
    "hand/hand.cdsl.yaml": (
        "component: HandComp\nlanguage: python\nimports: [Arm]\nrequires: [Arm, {Second: Arm}, Grip]\nsubscribes: [Moved]\n"
    ),
    "eye/eye.cdsl.yaml": (
        "component: EyeComp\nlanguage: cpp\nimports: [Arm]\nimplements: [Grip]\nrequires: [Arm]\npublishes: [Moved]\n"
        "statemachine: eye.scxml\n"
    ),
    "eye/eye.scxml": (
        '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" name="eye" initial="shut">\n'
        '  <state id="shut"><transition event="open" target="open"/></state>\n'
        '  <state id="open"><transition event="shut" cond="not In(\'shut\')" target="shut"/></state>\n</scxml>\n'
    ),
    "eye/eye.pdsl.yaml": "component: eye.cdsl.yaml\nparameters: {gain: {type: float, default: 1, editable: true}}\n",
    "robot.ddsl.yaml": (
        "deployment: Robot\nhosts: {left: 10.0.0.2, right: {address: 10.0.0.3}}\nservices: {storm: {icestorm: {host: left}}}\ncomponents:\n"
        "  arm: {component: arm, host: left, set: {speed: 0.5, camera.width: 100}}\n"
        "  eye: {component: eye, host: right, connect: {Arm: arm}}\n"
        "  'hand{i}': {component: hand, host: right, instances: 2, connect: {Arm: arm, Second: arm.Arm, Grip: eye}, after: [storm, eye]}\n"
        "groups: {both: {components: [arm, hand0]}}\n"
    ),
    "test.mock.yaml": "interfaces: {Arm: {methods: {carry: {returns: true}}}}\n",
}  # fmt: skip
CODE = {
    "arm/src/specificworker.py": (
        "    def compute(self) -> None:\n",
        '        self.moved_proxy.arrived(RoboCompArm.Pose(1.0, self.parameters.speed))\n        self.Arm_stop()\n'
        '        if self.statemachine.is_in("idle"):\n            self.events.go()\n'
        '        self.parameters.set("camera.width", 7)\n        camera = self.parameters.camera\n        print(camera.width, self.parameters.wheels[0])\n',
    ),
    "hand/src/specificworker.py": (
        "    def compute(self) -> None:\n",
        "        try:\n            ok = self.arm_proxy.carry(RoboCompArm.Pose(1.0, 2.0))\n            self.second_proxy.stopAsync()\n"
        "            grip = self.grip_proxy\n            grip.close(RoboCompArm.Mode.fast)\n"
        "        except RoboCompArm.Lost:\n            self.log.info(str(ok))\n",
    ),
    "eye/src/specificworker.cpp": (
        "void SpecificWorker::compute()\n{\n",
        "    RoboCompArm::Pose pose; pose.x = 1; pose.y = 2; // \U0001f916 at\n    auto mode = RoboCompArm::Mode::fast;\n    bool ok = arm_proxy->carry(pose);\n"
        "    auto other = this->arm_proxy;\n    other->stop();\n    moved_pubproxy->arrived(pose);\n"
        '    parameters.setGain(parameters.gain());\n    Grip_close(mode);\n    if (ok && statemachine.isIn("shut")) sm_open();\n',
    ),
}  # fmt: skip
REFUSED = {("member", "x"), ("member", "y")}
"""What the code may use without a trace of its type."""


@pytest.fixture(scope="module")
def ws(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = write_tree(tmp_path_factory.mktemp("renaming") / "ws", DOCUMENTS)
    before = os.getcwd()
    os.chdir(folder)
    try:
        compiled = api.load().compile()
        assert not compiled.has_errors, compiled.diagnostics
        compiled.apply()
    finally:
        os.chdir(before)
    for path, (line, more) in CODE.items():
        text = (folder / path).read_text()
        assert line in text
        (folder / path).write_text(text.replace(line, line + more))
    return folder


def _files() -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in Path().rglob("*") if path.is_file()}


def _found() -> Counter[tuple[str, str]]:
    return Counter((one.span.file, one.code) for one in api.load().check())


def _place(one: DefinedName) -> str:
    return f"{one.span.file}:{one.span.line}:{one.span.column}"


def test_every_name_is_renamed_and_back(ws: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ws)
    files, found = _files(), _found()
    names = names_of(api.load().analysis)
    assert len(names.defined) > 35
    refused = set()
    for one in names.defined.values():
        new = f"Q{one.name}" if one.name[0].isupper() else f"{one.name[0]}zz{one.name[1:]}"
        try:
            renaming = api.load().rename(_place(one), new)
        except api.Refused:
            refused.add((one.kind, one.name))
            continue
        assert _files() == files  # nothing is written before `apply`
        renaming.apply()
        assert len(_files()) == len(files) and _found() == found, one
        after = api.load()
        compiled = after.compile()
        assert not compiled.has_errors, one
        then = names_of(after.analysis).defined[key_after(one.key, one.key, new)]
        after.rename(_place(then), one.name).apply()
        assert _files() == files, one
    assert refused == REFUSED


def test_code_follows_in_both_languages(ws: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ws)
    renaming = api.load().rename("Arm.carry", "bring")
    assert renaming.what == "method carry"
    where = sorted((one.span.file, one.text, one.is_code) for one in renaming.edits)
    assert where == [
        ("arm/src/specificworker.py", "Arm_bring", True),
        ("arm/src/specificworker.py", "Arm_bring", True),  # in the text that it logs
        ("eye/src/specificworker.cpp", "bring", True),
        ("hand/src/specificworker.py", "bring", True),
        ("interfaces/Arm.idsl.yaml", "bring", False),
        ("test.mock.yaml", "bring", False),
    ]
    diff = "".join(api.load().rename("idle", "waiting").diffs())
    for line in ('+        if self.statemachine.is_in("waiting"):', "+    def sm_waiting(self) -> None:",
                 "+    idle".replace("idle", "waiting"), "not In('waiting')", "+  initial: waiting"):  # fmt: skip
        assert line in diff


@pytest.mark.parametrize(
    ("what", "name", "reason"),
    [
        ("Arm.carry", "stop", "RC0103"),
        ("host:left", "right", "RC"),
        ("Pose", "Mode", "RC"),
        ("speed", "camera", "RC"),
        ("entry:eye", "arm", "RC"),
        ("idle", "busy", "RC"),
        ("Arm.carry", "two words", "RC"),
        ("Arm.carry", "class", "RC"),  # of C++ and Python: a warning would be new
        ("interface:Arm", "Grip", "RC"),
        ("camera.width", "", "at least one character"),
        ("hand{i}", "hand", "{i}"),
        ("nothing", "x", "unknown name"),
        ("Wheel.speed", "x", "unknown name"),
    ],
)
def test_what_would_not_be_the_same_is_refused(
    ws: Path, monkeypatch: pytest.MonkeyPatch, what: str, name: str, reason: str
) -> None:
    monkeypatch.chdir(ws)
    files = _files()
    with pytest.raises(api.Refused, match=reason):
        api.load().rename(what, name).apply()
    assert _files() == files


def test_code_with_errors_of_syntax_is_not_renamed(ws: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ws)
    path = ws / "hand/src/specificworker.py"
    before = path.read_bytes()
    path.write_bytes(before + b"def broken(:\n")
    try:
        with pytest.raises(api.Refused, match=r"hand/src/specificworker\.py:\d+:\d+: .*cannot be renamed"):
            api.load().rename("Arm.carry", "bring")
    finally:
        path.write_bytes(before)
    path.write_bytes(before + b"\n    qarm_proxy = 3\n")
    try:
        with pytest.raises(api.Refused, match="has a 'qarm_proxy' already"):
            api.load().rename("interface:Arm", "QArm")
    finally:
        path.write_bytes(before)
