"""Small deployments over one interface document, as networks: what tests of the network start from."""

from __future__ import annotations

import os

from conftest import Tree, unsaved
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, Process
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source import properties

FACE = """\
module: RoboCompFace
types:
  Pose: {struct: {x: {type: float, unit: mm}, y: float}}
interfaces:
  Speech: {methods: {say: {in: {text: string}}}}
  Mouth: {methods: {moveTo: {in: {pose: Pose}, returns: bool}}}
topics:
  Heard: {methods: {word: {in: {text: string}}}}
"""

SPEECH = "implements: [Speech]\nrequires: [Mouth]\n"
MOUTH = "implements: [Mouth]\n"


def component(name: str, lists: str, interfaces: str = "Face") -> str:
    return f"component: {name}\nlanguage: python\nimports: [../{interfaces}]\n{lists}"


def deployed(text: str, **others: str) -> Tree:
    """The deployment `robot`, beside the components `speech` (which requires Mouth) and `mouth`. Other names are
    folders of components (their lists), or documents by their full names."""
    folders = {"speech": SPEECH, "mouth": MOUTH} | {name: text for name, text in others.items() if name.isalpha()}
    return {
        "robot.ddsl.yaml": f"deployment: Robot\n{text}",
        "Face.idsl.yaml": FACE,
        **{f"{name}/{name}.cdsl.yaml": component(f"{name.title()}Comp", lists) for name, lists in folders.items()},
        **{name: text for name, text in others.items() if not name.isalpha()},
    }


def analysed(files: Tree, *, folder: bool = False) -> Analysis:
    """Everything about the deployment `robot` (or, with `folder`, about all documents), in the working folder."""
    return analyse(["." if folder else "robot.ddsl.yaml"], overlay=unsaved(files))


def network(files: Tree) -> Network:
    """The network of a deployment of which nothing may be wrong."""
    analysis = analysed(files)
    assert not analysis.diagnostics, analysis.diagnostics
    return analysis.networks[os.path.realpath("robot.ddsl.yaml")]


def faults(files: Tree) -> list[Diagnostic]:
    return analysed(files).diagnostics


def said(diagnostic: Diagnostic) -> tuple[str, str, int, int]:
    span = diagnostic.span
    return diagnostic.code, span.file, span.line, span.column


def config(process: Process) -> dict[str, str]:
    """What Ice makes of a process's configuration."""
    assert process.config is not None
    return properties.read(process.config.text).values
