"""RC702x: deploying with IceGrid. What keeps its registry and nodes from doing their work."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_PROGRAM = 'components:\n  base: {{program: "true"{}}}\n'
_FINE = {"robot.ddsl.yaml": "deployment: Robot\n" + _PROGRAM.format("")}
_UP = "deploy up robot.ddsl.yaml --engine icegrid --attach"

NOT_INSTALLED = Code(
    "RC7020",
    "error",
    "the engine icegrid needs {what}, which is not installed here",
    "A deployment on several hosts is run by IceGrid, which is a part of Ice. The machine from which it is deployed "
    "needs IceGrid's programs and Ice for Python; the other hosts only `icegridnode`. A deployment on one machine needs "
    "nothing of it: `--engine local`.",
    {"robot.ddsl.yaml": "deployment: Robot\n" + _PROGRAM.format("")},
    _FINE,
    _UP,
)
NO_NODE = Code(
    "RC7021",
    "error",
    "the host '{name}' ({address}) has no IceGrid node for this deployment: {reason}",
    "Each host runs a small daemon of IceGrid, the node, which starts the processes there. rcyaml starts it on this "
    "machine, and on others over SSH, with your own keys, where asyncssh is installed. The command that is shown does "
    "the same by hand, once: the node stays until `rcyaml deploy down`, or until it is ended where it was started by "
    "hand.",
    {"robot.ddsl.yaml": "deployment: Robot\nhosts:\n  arm: {address: 192.0.2.7}\n" + _PROGRAM.format(", host: arm")},
    _FINE,
    _UP,
)
NO_REGISTRY = Code(
    "RC7022",
    "error",
    "the IceGrid registry of this deployment does not start: {reason}",
    "Each deployment has a registry of its own on the machine from which it is brought up. Its files stand in the "
    "deployment's folder, below `state/icegrid/registry`; its `log` says more.",
    {**_FINE, ".rcyaml/deployments/Robot/state/icegrid": "a file where a folder must be\n"},
    _FINE,
    _UP,
)
