"""RC24xx: `options:`, those of the legacy component generator."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_COMPONENT = "component: AgentComp\nlanguage: cpp\n"

UNKNOWN_OPTION = Code(
    "RC2351",
    "warning",
    "there is no option '{name}': it adds nothing",
    "Options are those of RoboComp's own generator. They stand for imports and interfaces, which are added to those "
    "that the document names; upper and lower case make no difference. New documents need none.",
    {"agent.cdsl.yaml": f"{_COMPONENT}options: [innermodel]\n"},
    {"agent.cdsl.yaml": _COMPONENT},
)
LEFT = Code(
    "RC2352",
    "note",
    "option '{name}' adds no interface; yours to write is {left}",
    "RoboComp's own generator wrote code for this option that belongs to a library, not to a component. The option "
    "is kept in the document, and means no more than that.",
    {"agent.cdsl.yaml": f"{_COMPONENT}options: [dsr]\n"},
    {"agent.cdsl.yaml": _COMPONENT},
)
