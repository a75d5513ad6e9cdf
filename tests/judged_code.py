"""What is reported about the code of a component, as code and quoted words."""

from __future__ import annotations

from collections.abc import Callable

from robocomp_yaml.emit.usage.judge import judge
from robocomp_yaml.link.program import LinkedComponent

DOCUMENTS = {
    "Mouth.idsl.yaml": """\
module: RoboCompMouth
constants: {WIDEST: {type: float, value: 60}}
types:
  Shape: {enum: [round, wide]}
  Pose: {struct: {opening: float, shape: Shape}}
  Path: {sequence: Pose}
exceptions:
  Blocked: {struct: {why: string}}
interfaces:
  Mouth:
    methods:
      move: {in: {target: Pose, fast: bool}, returns: Pose}
      where: {out: {pose: Pose, age: int}}
      way: {returns: Path}
      close:
  Ear: {methods: {hear: {in: {text: string}}}}
topics:
  News: {methods: {told: {in: {text: string}}}}
""",
    "x.pdsl.yaml": """\
component: x.cdsl.yaml
types:
  Motor: {struct: {name: string, vel: {type: float, range: [0, 2], default: 1}}}
parameters:
  speed: {type: int, range: [1, 400], default: 150, editable: true}
  device: {type: string, default: tty}
  words: {list: string, default: []}
  mode: {type: string, values: [slow, fast], default: slow}
  motors: {list: Motor, default: [{name: left}], editable: true}
  offsets: {map: Motor, default: {}, editable: true}
  camera: {group: {fps: {type: int, default: 30, editable: true}, lens: {type: string, default: a}}}
""",
}
MACHINE = """\
statemachine:
  initial: silent
  states: {silent: {}, talking: {}}
  transitions:
    silent: {to: talking, event: start}
    talking: {to: silent, event: stop}
"""
Link = Callable[[dict[str, str]], LinkedComponent]


def component(language: str, more: str = "") -> dict[str, str]:
    ports = "imports: [Mouth]\nimplements: [Ear]\nrequires: [Mouth]\npublishes: [News]\n"
    return {**DOCUMENTS, "x.cdsl.yaml": f"component: X\nlanguage: {language}\n{ports}{more}"}


def found(linked: LinkedComponent, files: dict[str, str], config: tuple[str, ...] = ()) -> list[tuple[str, str]]:
    """The codes, each with the text at its location."""
    part = linked.component.language.target.part("usage")
    offer = part.offer(linked)
    reported = []
    for one in judge(linked, part.read(files, linked, offer), offer, config):
        lines = files[one.span.file].split("\n")
        reported.append((one.code, lines[one.span.line - 1][one.span.column - 1 : one.span.end_column - 1]))
        for fix in one.fixes:
            assert all(edit.span == one.span and edit.text != reported[-1][1] for edit in fix.edits)
    return reported
