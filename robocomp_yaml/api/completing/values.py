"""What can be a value of a parameter: in values documents, under `set:`, and as a default."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from robocomp_yaml.api.completing.places import TypedPlace
from robocomp_yaml.api.completing.proposal import VALUE, Proposal
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, Program
from robocomp_yaml.naming import names
from robocomp_yaml.parameters.hidden import hidden
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    Type,
    is_secret,
)
from robocomp_yaml.parameters.words import for_editors, in_words, label
from robocomp_yaml.source.tree import value_at
from robocomp_yaml.source.yaml_text import flow


def parameters_for(program: Program, path: str, component: str = "") -> LinkedParameters | None:
    """The parameters that a document is about: those of its component, which is a folder or document as written."""
    if linked := components_by_path(program).get(document_at(path, component)) if component else None:
        return linked.parameters
    for real, parameters in program.parameters.items():
        if parameters.document is not None and path in (real, parameters.document.path):
            return parameters
    values = next((one for real, one in program.values.items() if path in (real, one.document.path)), None)
    return values.parameters if values is not None else None


def parameters_at(
    path: str, kind: str, place: TypedPlace, program: Program
) -> tuple[LinkedParameters, tuple[str, ...]] | None:  # fmt: skip
    """The parameters of which a document gives values at a place, and the keys below them; None at any other place."""
    match kind, place.keys:
        case "config", ("parameters", *steps):
            linked = parameters_for(program, path, named_by(place))
        case "ddsl", ("components", entry, "set", *steps) if named := named_by(place, "components", entry):
            linked = parameters_for(program, path, named)
        case _:
            return None
    return (linked, tuple(steps)) if linked is not None else None


def named_by(place: TypedPlace, *keys: str) -> str:
    """The path of the component that a document, or the entry at these keys, names; '' if it has none."""
    component = value_at(place.root, *keys, "component")
    return str(component.data) if component is not None else ""


def components_by_path(program: Program) -> dict[str, LinkedComponent]:
    """The components by the paths, as written and real, of their documents and folders."""
    found: dict[str, LinkedComponent] = {}
    for real, linked in program.components.items():
        written = linked.component.path
        for path in (written, real, os.path.dirname(written), os.path.dirname(real)):
            found.setdefault(path, linked)
    return found


def document_at(path: str, component: str) -> str:
    """A path that a document names, as a path from here."""
    return os.path.normpath(os.path.join(os.path.dirname(path), component))


def member_at(root: RecordType, steps: Sequence[str]) -> ResolvedMember | None:
    """The parameter, or member of a record, at a path whose steps are keys, '' for an element of a list."""
    now: Type = root
    found: ResolvedMember | None = None
    for step in (part for key in steps for part in (key.split(".") if key else [""])):
        name, _, index = step.partition("[")
        match now:
            case RecordType():
                found = now.member(name)
                if found is None:
                    return None
                now = found.type
                for _ in range(index.count("]")):
                    now = now.element if isinstance(now, ListType) else now
            case ListType(element=element) | MapType(element=element):
                now = element
            case _:
                return None
    if found is None:
        return None
    return ResolvedMember(found.name, now, found.doc, found.default if now is found.type else None, span=found.span)


def values_of(member: ResolvedMember) -> Iterator[Proposal]:
    """Values that fit: the default first, then enumerators, or the bounds of a range."""
    type_, about = member.type, in_words(member.type)
    if is_secret(type_):
        return
    if member.default is not None:
        yield Proposal(flow(hidden(type_, member.default.data)), VALUE, f"default; {about}", member.doc)
    match type_:
        case EnumType(enumerators=enumerators, allowed=allowed):
            docs = dict(enumerators)
            for name in allowed:
                yield Proposal(flow(name), VALUE, about, docs.get(name, ""))
        case BasicType(name="bool", values=()):
            for text in ("true", "false"):
                yield Proposal(text, VALUE, about, member.doc)
        case BasicType(values=values, range=limits):
            for literal in values:
                yield Proposal(flow(literal.value), VALUE, about, member.doc)
            for bound, what in ((limits.low, "least"), (limits.high, "greatest")) if limits is not None else ():
                if bound is not None and not bound.is_open:
                    yield Proposal(flow(bound.value), VALUE, f"the {what}; {about}", member.doc)


def at_parameter(linked: LinkedParameters, place: TypedPlace, steps: tuple[str, ...]) -> Iterator[Proposal]:
    """The values of the parameter at a path, or the names of the parameters or members there. Behind a dot, those of
    groups with their path."""
    root = linked.parameters.root
    head = place.word.rpartition(".")[0] if place.is_key else ""
    inner = member_at(root, (*steps, head) if head else steps) if steps or head else None
    if not place.is_key:
        yield from values_of(inner) if inner is not None else ()
        if steps[-1:] != ("",):  # else a record may be begun
            return
    record = inner.type if inner is not None else root if not (steps or head) else None
    for one in record.members if isinstance(record, RecordType) else ():
        name = f"{head}.{one.name}" if head else one.name
        yield Proposal(name, names.PARAMETER, label(one.type), one.doc, snippet=f"{name}: ")


def about_value(path: str, kind: str, place: TypedPlace, program: Program) -> str:
    """What a value in a values document, or under `set:`, is: of which parameter, and what the enumerator means. '' at
    any other place."""
    found = parameters_at(path, kind, place, program) if not place.is_key else None
    member = member_at(found[0].parameters.root, found[1]) if found is not None else None
    if found is None or member is None:
        return ""
    steps = found[1]
    title = f"```\nparameter {'.'.join(filter(None, steps))}: {label(member.type)}\n```"
    return "\n\n".join(part for part in (title, member.doc, for_editors(member)) if part)
