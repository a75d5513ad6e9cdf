"""`check --code` runs a type checker over Python code; generated code and the run time have no findings themselves."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import ROOT, write_tree

pytestmark = pytest.mark.processes

Rcyaml = Callable[..., Result]
TREE = {
    "interfaces/Arm.idsl.yaml": """\
module: RoboCompArm
types:
  Side: {enum: [left, right]}
  Joint: {struct: {name: string, angle: float, side: Side}}
  Bytes: {sequence: byte}
  Joints: {sequence: Joint}
  Named: {map: {key: string, value: Joint}}
exceptions:
  Blocked: {struct: {at: Joint}}
interfaces:
  Arm:
    methods:
      move: {in: {joints: Joints, fast: bool}, returns: int, throws: [Blocked]}
      state: {out: {joints: Joints, named: Named}}
      from: {in: {context: string, data: Bytes}}
topics: {ArmEvents: {methods: {moved: {in: {angle: float}}}}}
""",
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "use/use.cdsl.yaml": """\
component: Use
language: python
imports: [Arm]
requires: [Arm]
publishes: [ArmEvents]
statemachine: {initial: a, states: {a: {}, b: {}}, transitions: {a: {to: b, event: go}}}
""",
    "use/use.pdsl.yaml": "component: use.cdsl.yaml\nparameters: {speed: {type: int, default: 3, editable: true}}\n",
}
RIGHT = """\
from __future__ import annotations

import Ice
from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompArm


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.log.info("%d", self.parameters.speed)

    def compute(self) -> None:
        joint = RoboCompArm.Joint("elbow", 1, RoboCompArm.Side.left)
        try:
            count: int = self.arm_proxy.move((joint, joint), True, {"key": "value"})
        except RoboCompArm.Blocked as blocked:
            self.log.warning("%s", blocked.at.name)
        except Ice.ConnectionRefusedException:
            self.log.warning("%d", self.arm_proxy.moveAsync([joint], fast=False).result(2.5))
        joints, named = self.arm_proxy.state()
        name: str = joints[0].name + named["a"].side.name
        getattr(self.arm_proxy, "_from")(name, b"")
        self.arm_proxy.ice_oneway().ice_ping()
        self.armevents_proxy.moved(1.5)
        self.parameters.speed = 4
        self.events.go()
        self.communicator.getProperties().getProperty(name)

    def sm_a(self) -> None:
        pass

    def sm_b(self) -> None:
        pass
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return write_tree(tmp_path, {**TREE, "use/src/specificworker.py": RIGHT})


def test_right_code_has_no_findings_even_before_a_compile(workspace: Path, rcyaml: Rcyaml) -> None:
    assert rcyaml("check", "--code").stdout == "3 documents: nothing wrong\n"
    assert not (workspace / "use/generated").exists()


@pytest.mark.parametrize(
    ("right", "wrong", "text", "rule"),
    [
        ('"elbow", 1,', '"elbow", "1",', '"1"', "RC6328"),
        ("True, {", '"True", {', '"True"', "RC6328"),
        ("count: int", "count: str", "self.arm_proxy.move(", "invalid-assignment"),
        ("blocked.at.name", "blocked.at.nmae", "nmae", "RC6325"),
        (".result(2.5)", ".reslut(2.5)", "reslut", "RC6325"),
        (".result(2.5)", ".result(fast=2.5)", "fast=2.5", "unknown-argument"),
        ("getProperties().getProperty", "getProperties().getPropert", None, "missing-attribute"),
        ("joints[0].name", "joints.name", "name", "RC6325"),
        ("speed = 4", "speed = speeed", "speeed", "RC6331"),
        ("moved(1.5)", "moved([1.5])", "[1.5]", "RC6328"),
        ("moved(1.5)", 'moved("1.5 2".split())', '"1.5 2".split()', "invalid-argument-type"),
        ("self.log.info(", "self.log.inform(", "inform", "RC6325"),
    ],
)
def test_wrong_types_are_reported_where_they_are(
    workspace: Path, rcyaml: Rcyaml, right: str, wrong: str, text: str | None, rule: str
) -> None:
    code = workspace / "use/src/specificworker.py"
    assert right in RIGHT
    code.write_text(RIGHT.replace(right, wrong), encoding="utf-8")
    is_always_seen = rule.startswith("RC")
    assert rcyaml("check").exit_code == is_always_seen
    result = rcyaml("check", "--code", "--format", "json")
    assert result.exit_code == 1
    (found,) = json.loads(result.stdout)["diagnostics"]
    assert (found["code"], found["file"]) == (rule if is_always_seen else "RC6318", "use/src/specificworker.py")
    if not is_always_seen:
        assert found["facts"]["rule"] == rule and found["facts"]["tool"] == "ty"
    line = code.read_text(encoding="utf-8").split("\n")[found["line"] - 1]
    if text is not None:
        assert line[found["column"] - 1 :].startswith(text)


def test_types_are_those_of_the_documents_as_they_are_now(workspace: Path, rcyaml: Rcyaml) -> None:
    assert rcyaml("compile").exit_code == 0
    document = workspace / "interfaces/Arm.idsl.yaml"
    text = TREE["interfaces/Arm.idsl.yaml"].replace("angle: float", "angle: string")
    document.write_text(text.replace("returns: int", "returns: string"), encoding="utf-8")
    found = json.loads(rcyaml("check", "--code", "--format", "json").stdout)["diagnostics"]
    assert {one["code"] for one in found} == {"RC6318", "RC6328"}


def test_what_is_reported_without_types_is_not_repeated(workspace: Path, rcyaml: Rcyaml) -> None:
    code = workspace / "use/src/specificworker.py"
    code.write_text(RIGHT.replace("arm_proxy.state()", "arm_proxy.sate()"), encoding="utf-8")
    found = json.loads(rcyaml("check", "--code", "--format", "json").stdout)["diagnostics"]
    assert [one["code"] for one in found] == ["RC6302"]


def test_an_absent_checker_is_named_with_its_command(
    workspace: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.setattr(shutil, "which", lambda *_, **__: None)
    result = rcyaml("check", "--code")
    assert result.exit_code == 2
    assert (
        "--code` needs the type checker ty, which is not installed: run `pip install 'rcyaml[code]'`" in result.output
    )
    (workspace / "use/use.cdsl.yaml").unlink()
    (workspace / "use/use.pdsl.yaml").unlink()
    assert rcyaml("check", "--code").stdout == "1 document: nothing wrong\n"


@pytest.mark.parametrize("name", ["jointmotor", "talkinghead"])
def test_the_examples_have_no_findings(tmp_path: Path, rcyaml: Rcyaml, name: str) -> None:
    shutil.copytree(ROOT / "examples" / name, tmp_path / name)
    assert rcyaml("migrate", ".").exit_code == 0
    result = rcyaml("check", "--code")
    assert result.exit_code == 0 and "nothing wrong" in result.stdout, result.stdout


def ty(folder: Path, *paths: str) -> str:
    words = ["check", "--output-format", "concise", "--python", sys.prefix]
    for path in ("generated/typings", ".", "src"):
        words += ["--extra-search-path", path]
    program = os.path.join(os.path.dirname(sys.executable), "ty")
    return subprocess.run([program, *words, *paths], cwd=folder, capture_output=True, text=True, check=False).stdout


def test_the_run_time_and_generated_code_have_no_findings(workspace: Path, rcyaml: Rcyaml) -> None:
    pytest.importorskip("PySide6")
    assert rcyaml("compile", "--standalone").exit_code == 0
    shutil.copytree(ROOT / "robocomp_yaml/languages/python/templates/qt", workspace / "use/generated/qt")
    shutil.copytree(ROOT / "robocomp_yaml/languages/python/templates/robocomp", workspace / "use/generated/robocomp")
    assert ty(workspace / "use", "generated", "src") == "All checks passed!\n"
    mypy = [sys.executable, "-m", "mypy", "--python-version", "3.11", "--strict", "src", "generated/genericworker.py"]
    environment = {**os.environ, "MYPYPATH": "generated/typings:."}
    done = subprocess.run(
        [*mypy, "generated/interfaces.pyi", "--follow-imports", "silent", "--explicit-package-bases"],
        cwd=workspace / "use", capture_output=True, text=True, check=False, env=environment,
    )  # fmt: skip
    assert done.stdout.startswith("Success"), done.stdout
