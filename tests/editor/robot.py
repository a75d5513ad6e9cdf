"""A small robot: the workspace in which editors are tried."""

from __future__ import annotations

import subprocess
from pathlib import Path

from terminals import COMMAND, environment

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [interfaces/]\n",
    "interfaces/Shapes.idsl.yaml": """
module: RoboCompShapes
doc: What several interfaces use.
types:
  Pose: {doc: Where something is., struct: {x: float, y: float}}
  Poses: {sequence: Pose}
exceptions:
  Blocked: {struct: {by: string}}
""",
    "interfaces/Gripper.idsl.yaml": """
module: RoboCompGripper
imports: [Shapes]
interfaces:
  Gripper:
    doc: Opens and closes.
    methods:
      grasp:
        in:
          where: Shapes.Pose
        returns: bool
        throws: [Shapes.Blocked]
topics:
  GripperEvents: {methods: {closed: {in: {force: float}}}}
""",
    "interfaces/Odometry.idsl.yaml": """
module: RoboCompOdometry
interfaces:
  Odometry: {methods: {moved: {in: {left: float, right: float}}}}
""",
    "components/hand/hand.cdsl.yaml": """
component: HandComp
language: python
imports: [Gripper, Odometry]
implements: [Gripper]
publishes: [GripperEvents]
subscribes: [Odometry]
parameters: hand.pdsl.yaml
""",
    "components/hand/hand.pdsl.yaml": """
component: hand.cdsl.yaml
types:
  Finger: {struct: {length: float}}
parameters:
  force:
    type: float
    range: [0, 40]
    default: 10
    unit: N
    doc: The force of the fingers.
  fingers:
    list: Finger
    default: [{length: 0.1}]
  mode:
    type: string
    values: [soft, firm]
    default: soft
""",
    "components/hand/etc/config.yaml": """
# yaml-language-server: $schema=../generated/config.schema.json
component: ../hand.cdsl.yaml
parameters:
  force: 12
  mode: firm
  fingers:
    - length: 0.2
""",
    "components/wheels/wheels.cdsl.yaml": """
component: WheelsComp
language: python
imports: [Odometry, Gripper]
requires: [Gripper]
publishes: [Odometry]
""",
    "deployments/robot.ddsl.yaml": """
deployment: Robot
hosts:
  torso: {address: 127.0.0.1}
services:
  storm: {icestorm: {host: torso}}
components:
  hand:
    component: ../components/hand
    set:
      force: 12
  wheels:
    component: ../components/wheels
    host: torso
    connect:
      Gripper: hand
    after: [storm]
groups:
  body:
    components: [hand, wheels]
""",
}


def write_robot(folder: Path) -> None:
    """Writes the documents, and compiles them."""
    for name, text in DOCUMENTS.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.lstrip("\n"), encoding="utf-8")
    run("compile", folder=folder)


def run(*arguments: str, folder: Path) -> str:
    """What a command prints, which has to succeed."""
    done = subprocess.run(
        [*COMMAND, *arguments], cwd=folder, capture_output=True, text=True, env=environment(), check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
