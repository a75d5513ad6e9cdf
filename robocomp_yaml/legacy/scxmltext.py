"""SCXML documents to be written: states with their comments, and the text."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.legacy.document import Notes

HEAD = '<?xml version="1.0" encoding="UTF-8"?>'
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
    lines = [HEAD, *_comment(notes.head, ""), *_comment(notes.tail, "")]
    lines.append(f'<scxml xmlns="{NAMESPACE}" version="1.0" name="{name}" initial="{initial}">')
    for state in states:
        lines += _state(state, "  ")
    lines += ["</scxml>", *_comment(notes.foot, "")]
    return "\n".join(lines) + "\n"


def _state(state: ScxmlState, indent: str) -> Iterator[str]:
    element = "final" if state.final else "parallel" if state.parallel else "state"
    initial = f' initial="{state.initial}"' if state.initial else ""
    yield from _comment([*state.notes.head, *state.notes.tail], indent)
    start = f'{indent}<{element} id="{state.name}"{initial}'
    if not state.states and not state.transitions and not state.notes.foot:
        yield f"{start}/>"
        return
    yield f"{start}>"
    inner = indent + "  "
    for target, notes in state.transitions:
        yield from _comment([*notes.head, *notes.tail], inner)
        yield f'{inner}<transition event="t_{state.name}_to_{target}" target="{target}"/>'
        yield from _comment(notes.foot, inner)
    for child in state.states:
        yield from _state(child, inner)
    yield from _comment(state.notes.foot, inner)
    yield f"{indent}</{element}>"


def _comment(lines: list[str], indent: str) -> Iterator[str]:
    """`--` cannot stand in an XML comment."""
    kept = [line.replace("--", "- -").replace("--", "- -").rstrip() for line in lines]
    while kept and not kept[0]:
        del kept[0]
    while kept and not kept[-1]:
        del kept[-1]
    if len(kept) == 1:
        yield f"{indent}<!-- {kept[0].strip()} -->"
    elif kept:
        yield f"{indent}<!--"
        yield from (f"{indent}  {line}".rstrip() for line in kept)
        yield f"{indent}-->"
