"""Documents of each kind with all keys: the models that are built from them, and the spans of all parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from in_memory import ROOT, analysed, outline

IDSL = """\
module: RoboCompArm
doc: Arms.
imports: [Other]
constants:
  MOST: {type: int, value: 7, doc: How many., unit: joints}
  NAME: {type: string, value: "left"}
types:
  Pose:
    doc: A place.
    struct: {x: {type: float, unit: mm, doc: Ahead., default: 1.5}, y: float, other: Other.Other}
  Mode: {enum: [off, slow], doc: How fast.}
  Level: {enum: {low: 1, high: {value: 5, doc: Very.}, next: }}
  Poses: {sequence: Pose, doc: Many.}
  Named: {map: {key: string, value: Pose}, doc: By name.}
exceptions:
  Stuck: {struct: {reason: string}, doc: It is.}
interfaces:
  Arm:
    doc: It moves.
    methods:
      move:
        doc: To a place.
        in: {pose: {type: Pose, doc: Where.}, speed: float}
        out: {left: {type: float, unit: mm}}
        returns: {type: bool, doc: Whether., unit: s}
        throws: [Stuck]
        idempotent: true
      stop: {x-legacy-name: halt}
      rest:
topics:
  Moved: {methods: {to: {in: {pose: Pose}}}}
x-note: {ignored: 1}
"""
OTHER = "module: RoboCompOther\ntypes: {Other: {struct: {a: int}}}\ninterfaces: {Eye: {methods: {look: }}}\n"

CDSL = """\
component: ArmComp
doc: Moves an arm.
language: {name: cpp, standard: 20}
imports: [Arm, Other]
implements: [Arm, Eye: RoboCompOther.Eye]
requires:
  - Eye: {interface: Eye, absent: ignore, timeout: 2 s, doc: To see.}
  - Second: Arm
publishes: [Moved]
subscribes: [RoboCompArm.Moved]
parameters: arm.pdsl.yaml
period: 20 ms
gui: {toolkit: qt, base: QDialog}
options: []
uses:
  sources: [src/extra.cpp]
  classes: [src/helper]
  libraries: [{cmake: Eigen3, version: "3.4"}, {link: m}]
"""

MACHINE = """\
component: Door
language: python
statemachine:
  initial: closed
  final: broken
  events: [knock, ring]
  states:
    closed:
      doc: Nobody comes in.
      initial: locked
      entry: [lock, {raise: shut}, {send: tired, after: 1.5 s, id: nap}, {send: late}]
      exit: {cancel: nap}
      states:
        locked: {}
        unlocked: {transitions: {unlocked: {to: locked, event: key}}}
        last: {history: deep}
      transitions:
        locked: {to: unlocked, event: key, if: has_key, do: [turn, {raise: click}]}
        last: locked
    opened: {parallel: true, states: {left: {initial: l}, right: {initial: r}}}
  transitions:
    closed: [opened, {to: [left, right], event: "kick knock.*", internal: true}, {if: worn, to: broken}]
    opened: {to: last, event: ring}
    locked: {event: shut tired late click, do: beep}
"""

PDSL = """\
component: arm.cdsl.yaml
types:
  Mode: {enum: {slow: {doc: Careful.}, fast: }, doc: How fast.}
  Joint: {doc: One of many., struct: {name: {type: string, doc: Its name.}, most: {type: float, unit: rad, range: [0, 3]}}}
  Some: {list: {type: int, range: {above: 0}}, size: [1, 3], unique: true}
parameters:
  mode: {type: Mode, default: slow, doc: How it moves.}
  joints: {list: Joint, default: [{name: a, most: 1}], editable: true}
  some: {type: Some, optional: true}
  gripper: {doc: Its hand., editable: true, group: {force: {type: double, unit: N, values: [1, 2.5]}, "on": {type: bool, as: is_on, editable: false}}}
  key: {type: string, secret: true, pattern: "[a-z]+", optional: true}
  names: {map: string, size: 2, optional: true}
constraints:
  - gripper.force < 3
  - {that: "len(joints) > 0", else: an arm has joints, doc: As it says.}
legacy:
  mode: Arm.Mode
  joints: {key: "J{i}", first: 1, columns: [name, most], separator: ";", count: Arm.Count}
"""

DDSL = """\
deployment: Robot
doc: All of it.
hosts: {onboard: 10.0.0.2, head: {address: 10.0.0.3, user: pi, doc: Above.}, boot: {address: b, systemd: user, listen: any, python: py, ssh: {user: me, port: 22, identity: key, known-hosts: known, jump: gate}}}
services:
  storm: {icestorm: {host: head, port: 9999}, doc: Topics.}
components:
  arm{i}:
    component: arm
    doc: Two of them.
    instances: 2
    host: onboard
    ports: {Arm: 10001, CommonBehavior: 11001}
    executable: bin/arm
    args: [--fast, "{config}"]
    env: {A: b, C: {env: D}, E: {file: f}}
    config: my.config.yaml
    connect: {Eye: viewer.Eye, Second: "arm:tcp -h 10.0.0.9 -p 1"}
    topics: {Moved: moved}
    set: {gripper.force: 2.5}
    restart: {policy: always, delay: 2 s, tries: 3, within: 1 min}
    ready: {within: 5 s, port: 10001}
    after: [storm, viewer]
    enabled: false
    x-rcmanager: {x: 1.50, y: [a, 2]}
  viewer:
    program: ./viewer
    cwd: tools
    host: head
    config: view.conf
    config-as: --Ice.Config
    endpoints: {Eye: tcp -p 12000}
    restart: "no"
    ready: {command: ask --it "all of it", within: 300}
  second: {process: viewer, endpoints: {Arm: tcp -p 12001}}
  third: {program: sh, host: head,  ready: {log: "^up$"}, restart: {tries: 1}}
  fourth: {program: sh, host: head, ready: 7 s}
  fifth: {component: arm, port: 12001, host: onboard}
groups:
  both: {components: [viewer, third], host: head, doc: Together., expose: {Eye: {member: viewer, rate: 2.5, allow: [look]}, Arm: second}}
  whole: {include: part.ddsl.yaml, host: head, as: arm}
include: {more: part.ddsl.yaml}
x-rcmanager: {general: {editor: vim}}
"""
PART = "deployment: Part\ncomponents: {eye: {program: sh}}\n"

FILES = {
    "Arm.idsl.yaml": IDSL, "Other.idsl.yaml": OTHER, "arm/arm.cdsl.yaml": CDSL.replace("[Arm, Other]", "[../Arm, ../Other]"),
    "arm/arm.pdsl.yaml": PDSL, "door/door.cdsl.yaml": MACHINE, "robot.ddsl.yaml": DDSL, "part.ddsl.yaml": PART,
    "arm/my.config.yaml": "parameters: {gripper: {on: true}}\n",
}  # fmt: skip


@pytest.mark.parametrize("kind", ["idsl", "cdsl", "machine", "ddsl"])
def test_the_model_of_a_document(kind: str, golden: Callable[[str, Mapping[str, str]], None]) -> None:
    found = analysed(FILES).program
    arm = found.components[f"{ROOT}/arm/arm.cdsl.yaml"]
    read = {
        "idsl": found.modules[f"{ROOT}/Arm.idsl.yaml"].module,
        "cdsl": arm.component,
        "machine": found.components[f"{ROOT}/door/door.cdsl.yaml"].component.machine,
        "ddsl": found.deployments[f"{ROOT}/robot.ddsl.yaml"].deployment,
    }[kind]
    golden(f"read/{kind}", {f"{kind}.txt": "\n".join(outline(kind, read, FILES)) + "\n"})
