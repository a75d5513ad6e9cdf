"""A component with one of everything, for the tests of the C++ target: its text, and that the text compiles."""

from __future__ import annotations

MOUTH = {
    "Types.idsl.yaml": """\
module: RoboCompTypes
types:
  Pose: {struct: {x: float, y: float}}
""",
    "Mouth.idsl.yaml": """\
module: RoboCompMouth
imports: [Types]
types:
  Shape: {enum: [closed, open]}
  Shapes: {sequence: Shape}
  Samples: {sequence: byte}
exceptions:
  Jammed: {doc: It does not move., struct: {where: Types.Pose}}
interfaces:
  Mouth:
    doc: Lips that move.
    methods:
      open:
        doc: |
          Opens the mouth.

          Waits until it is open.
        in: {width: {type: float, unit: mm, doc: Between the lips.}, shape: Shape}
        returns: bool
        throws: [Jammed]
      status: {out: {pose: Types.Pose, shapes: Shapes}, returns: Shape, idempotent: true}
      stop:
      sing: {in: {text: string, samples: Samples, this: long, register: byte}}
      whereIsTheMouthThatSaysAllThis:
        in: {relativeToThisPose: Types.Pose, shapesOfTheLips: Shapes}
        out: {poseOfTheMouthInTheImage: Types.Pose, found: bool}
topics:
  MouthEvents:
    methods:
      moved: {doc: The lips have moved., in: {shape: Shape, at: Types.Pose}}
""",
    "mouth.cdsl.yaml": """\
component: MouthComp
doc: Moves the lips.
language: {name: cpp, standard: 20}
imports: [Mouth]
implements: [Mouth]
requires:
  - {Twin: Mouth}
  - {Backup: {interface: Mouth, absent: ignore, timeout: 1.5 s, doc: Who moves when we cannot.}}
publishes: [MouthEvents]
subscribes: [MouthEvents, Mouth]
period: 50 ms
""",
}
