"""RC702x: deploying with IceGrid. What keeps its registry and nodes from doing their work."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_PROGRAM = 'components:\n  base: {{program: "true"{}}}\n'
_FINE = {"robot.ddsl.yaml": "deployment: Robot\n" + _PROGRAM.format("")}
_UP = "deploy up robot.ddsl.yaml --engine icegrid --attach"

NO_REGISTRY = Code(
    "RC7020",
    "error",
    "the IceGrid registry of this deployment cannot be started: {reason}",
    "A deployment on several hosts is run by IceGrid, which is a part of Ice. The machine from which it is deployed "
    "needs IceGrid's programs and Ice for Python; the other hosts need only `icegridnode`. Each deployment has a "
    "registry of its own, whose files stand in the deployment's folder, below `state/icegrid/registry`; its `log` says "
    "more. A deployment on one machine needs nothing of it: `--engine local`.",
    {**_FINE, ".rcyaml/deployments/Robot/state/icegrid": "a file where a folder must be\n"},
    _FINE,
    _UP,
)
NO_NODE = Code(
    "RC7021",
    "error",
    "the host '{name}' ({address}) has no IceGrid node for this deployment: {reason}",
    "Each host runs a small daemon of IceGrid, the node, which starts the processes there. rcyaml starts it on this "
    "machine, and on others over SSH, with your own keys, where asyncssh is installed; those end with `rcyaml deploy "
    "down`. The command that is shown does the same by hand, once: that node stays.",
    {"robot.ddsl.yaml": "deployment: Robot\nhosts:\n  arm: {address: 192.0.2.7}\n" + _PROGRAM.format(", host: arm")},
    _FINE,
    _UP,
)
