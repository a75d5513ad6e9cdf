"""RC206x: what a component's language does not have."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_HEAD = "component: SpeechComp\nlanguage: "

NOT_AVAILABLE = Code(
    "RC2060",
    "error",
    "`{key}:` is not available in {language}",
    "Not every language has all that a component can have: a standard is chosen for C++ alone, and some languages have "
    "no state machines, windows or libraries. [The table of languages](languages.md) says which has what. What would "
    "have no effect is refused, since a component that lacks half of what its document says is found out on the robot.",
    {"speech.cdsl.yaml": f"{_HEAD}{{name: python, standard: 20}}\n"},
    {"speech.cdsl.yaml": f"{_HEAD}{{name: cpp, standard: 20}}\n"},
)
