"""Mock scripts: what is wrong with them, and where."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")

Run = Callable[..., Result]
ARM = """\
module: RoboCompArm
types:
  Side: {enum: [left, right]}
  Pose: {struct: {x: float, side: Side, name: {type: string, default: hand}}}
  Poses: {sequence: Pose}
  Named: {map: {key: string, value: Pose}}
exceptions:
  Stuck: {struct: {where: Pose}}
interfaces:
  Arm:
    methods:
      where: {in: {side: Side}, returns: Pose, throws: [Stuck]}
      all: {out: {poses: Poses, named: Named}}
      stop:
topics:
  Moved:
    methods:
      to: {in: {pose: Pose}}
"""
OTHER = "module: RoboCompOther\ninterfaces:\n  Leg:\n    methods: {where: }\n"


def of_arm(methods: str) -> str:
    return f"interfaces:\n  Arm:\n    methods:\n      {methods}\n"


RIGHT = {
    "a struct": of_arm("where: {returns: {x: 1, side: right}}"),
    "lists and maps": of_arm("all: {out: {poses: [{x: 1, side: left, name: a}], named: {a: {x: 0, side: left}}}}"),
    "an exception": of_arm("where: {throws: {Stuck: {where: {x: 1, side: left}}}}"),
    "nothing": of_arm("stop: "),
    "answers in turn": of_arm("stop: [{delay: 1 s}, {delay: 2}, {delay: .5 h}, {delay: 0}, {}]"),
    "by its module": "interfaces:\n  RoboCompArm.Arm: {endpoint: tcp -p 10005}\n",
    "a topic": "topics:\n  Moved: {rate: 0.5, messages: [{to: {pose: {x: 1, side: left}}}]}\n",
    "keys of one's own": "doc: For Monday.\nx-author: me\ninterfaces: {Arm: }\n",
}
WRONG = {
    "an enumerator": (of_arm("where: {returns: {x: 1, side: lefft}}"), "RC9001", "lefft", "'returns.side' must be one of"),
    "a missing member": (of_arm("where: {returns: {x: 1}}"), "RC9001", "{x: 1}", "'returns.side' is missing"),
    "an unknown member": (of_arm("where: {returns: {x: 1, side: left, y: 2}}"), "RC9001", "y", "'returns.y' is unknown"),
    "a result where there is none": (of_arm("stop: {returns: 1}"), "RC9001", "returns", "stop returns nothing"),
    "an unknown out parameter": (of_arm("all: {out: {pose: []}}"), "RC9001", "pose", "is not an out parameter of all"),
    "in a list": (of_arm("all: {out: {poses: [{x: a, side: left}]}}"), "RC9001", "a", "'poses[0].x' must be a number"),
    "in an exception": (of_arm("where: {throws: {Stuck: {where: 3}}}"), "RC9001", "3", "'Stuck.where' must be a mapping"),
    "an exception without its members": (of_arm("where: {throws: {Stuck: }}"), "RC9001", "", "'Stuck.where' is missing"),
    "an exception of another": (of_arm("stop: {throws: {Stuck: {where: 3}}}"), "RC9004", "Stuck", "stop throws no 'Stuck'"),
    "two exceptions": (of_arm("where: {throws: {A: , B: }}"), "RC0204", "", "'throws' must have at most 1 element"),
    "an unknown method": (of_arm("were: {}"), "RC9003", "were", "Arm has no method 'were'"),
    "an unknown interface": ("interfaces: {Armm: }\n", "RC9002", "Armm", "interface or topic 'Armm'"),
    "a topic among interfaces": ("interfaces: {Moved: }\n", "RC9006", "Moved", "Moved is a topic"),
    "an interface among topics": ("topics: {Arm: }\n", "RC9006", "Arm", "Arm is an interface"),
    "two of a name": ("interfaces: {Leg: }\n", "RC9005", "Leg", "several modules define 'Leg'"),
    "a rate of nothing": ("topics: {Moved: {rate: 0}}\n", "RC0204", "0", "messages per second"),
    "an unknown key": ("interfaces: {Arm: {method: {}}}\n", "RC0202", "method", "'method'"),
    "an odd delay": (of_arm("stop: {delay: soon}"), "RC0204", "soon", "a time is milliseconds"),
    "a delay that is a fraction": (of_arm("stop: {delay: 0.3}"), "RC0204", "0.3", "a time is milliseconds, such as 500, or"),
    "a delay with another unit": (of_arm("stop: {delay: 3 sec}"), "RC0204", "3 sec", "a time is milliseconds"),
    "a delay below zero": (of_arm("stop: {delay: -1}"), "RC0204", "-1", "a time is milliseconds"),
    "a message without its argument": ("topics: {Moved: {messages: [{to: }]}}\n", "RC9001", "", "'pose' is missing"),
}  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    again = OTHER.replace("RoboCompOther", "RoboCompThird")
    write_tree(tmp_path, {"Arm.idsl.yaml": ARM, "Other.idsl.yaml": OTHER, "Third.idsl.yaml": again})
    return tmp_path


@pytest.mark.parametrize("script", RIGHT.values(), ids=RIGHT)
def test_right_scripts(rcyaml: Run, folder: Path, script: str) -> None:
    (folder / "r.mock.yaml").write_text(script)
    run = rcyaml("mock", "--check", "--script", "r.mock.yaml")
    assert (run.exit_code, run.output) == (0, "1 document: nothing wrong\n")


@pytest.mark.parametrize(("script", "code", "at", "message"), WRONG.values(), ids=WRONG)
def test_wrong_scripts(rcyaml: Run, folder: Path, script: str, code: str, at: str, message: str) -> None:
    (folder / "r.mock.yaml").write_text(script)
    run = rcyaml("mock", "--check", "--script", "r.mock.yaml", "--format", "json")
    assert run.exit_code == 1
    (told,) = json.loads(run.stdout)["diagnostics"]
    assert told["code"] == code and message in told["message"], told
    line = script.splitlines()[told["line"] - 1]
    assert line[told["column"] - 1 :].startswith(at), (line, told)


def test_errors_of_the_interface_come_first(rcyaml: Run, folder: Path) -> None:
    (folder / "Arm.idsl.yaml").write_text(ARM.replace("returns: Pose", "returns: Posse"))
    run = rcyaml("mock", "--check", "Arm")
    assert run.exit_code == 1 and "Arm.idsl.yaml:12:" in run.output and "'Posse'" in run.output
