"""SCXML documents to be written: states with their comments, and the text."""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.xml_text import HEAD, comment, element
from robocomp_yaml.legacy.document import Notes

NAMESPACE = "http://www.w3.org/2005/07/scxml"


class ScxmlState(msgspec.Struct, eq=False):
    """`transitions` are names of states, with comments."""

    name: str
    final: bool = False
    parallel: bool = False
    initial: str = ""
    states: list[ScxmlState] = []
    transitions: list[tuple[str, Notes]] = []
    notes: Notes = msgspec.field(default_factory=Notes)


def document(name: str, initial: str, states: list[ScxmlState], notes: Notes) -> str:
    """The text of a machine. Names are plain identifiers."""
    attributes = {"xmlns": NAMESPACE, "version": "1.0", "name": name, "initial": initial}
    machine = element("scxml", attributes, [line for state in states for line in _state(state)])
    return HEAD + "\n".join([*comment(notes.head), *comment(notes.tail), *machine, *comment(notes.foot)]) + "\n"


def _state(state: ScxmlState) -> list[str]:
    name = "final" if state.final else "parallel" if state.parallel else "state"
    attributes = {"id": state.name, **({"initial": state.initial} if state.initial else {})}
    inside: list[str] = []
    for target, notes in state.transitions:
        transition = {"event": f"t_{state.name}_to_{target}", "target": target}
        inside += [*comment([*notes.head, *notes.tail]), *element("transition", transition), *comment(notes.foot)]
    inside += [line for child in state.states for line in _state(child)]
    inside += comment(state.notes.foot)
    return [*comment([*state.notes.head, *state.notes.tail]), *element(name, attributes, inside)]
