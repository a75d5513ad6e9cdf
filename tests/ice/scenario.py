"""The interfaces that the components of these tests speak, and their CDSL documents."""

from __future__ import annotations

import json

INTERFACES = {
    "Types.idsl.yaml": """\
module: RoboCompTypes
types:
  Side: {enum: [left, right]}
  Pose: {struct: {x: float, y: {type: float, default: 2.5}, side: Side}}
  Path: {sequence: Pose}
  Image: {sequence: byte}
  Named: {map: {key: string, value: Pose}}
""",
    "Arm.idsl.yaml": """\
module: RoboCompArm
imports: [Types]
exceptions:
  Blocked: {struct: {where: Types.Pose, force: float}}
  Broken: {struct: {}}
interfaces:
  Arm:
    doc: An arm that moves.
    methods:
      move: {in: {path: Types.Path, fast: bool}, returns: int, throws: [Blocked]}
      state: {out: {pose: Types.Pose, named: Types.Named}, returns: Types.Side, idempotent: true}
      breakDown: {throws: [Broken]}
      betray: {}
      block: {in: {seconds: float}}
  Hand:
    methods:
      grasp: {in: {image: Types.Image}, returns: Types.Image}
topics:
  ArmEvents:
    methods:
      moved: {in: {pose: Types.Pose}}
      count: {in: {n: int}}
""",
}


def cdsl(name: str, language: str = "python", **keys: object) -> str:
    """A CDSL document that imports it all."""
    return json.dumps({"component": name, "language": language, "imports": ["Types", "Arm"], **keys}) + "\n"
