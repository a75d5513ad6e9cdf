"""The shape of SCXML: which elements may contain which, with which attributes. It is what a schema is for YAML."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix, Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, suggest
from robocomp_yaml.semantics.events import seconds
from robocomp_yaml.source.xml import Element

SCXML = "http://www.w3.org/2005/07/scxml"
ROBOCOMP = "urn:robocomp:statemachine"


class Shape(msgspec.Struct, frozen=True):
    """Each group in `one` has attributes that exclude each other; if it starts with '!', one of them is required."""

    attributes: str = ""
    children: str = ""
    required: str = ""
    one: tuple[str, ...] = ()


_ACTIONS = "raise send cancel log if foreach assign script"
_INSIDE = "onentry onexit transition state parallel history datamodel invoke"
SHAPES: dict[str, Shape] = {
    "scxml": Shape("initial name version datamodel binding", "state parallel final datamodel script"),
    "state": Shape("id initial", f"{_INSIDE} initial final"),
    "parallel": Shape("id", _INSIDE),
    "final": Shape("id", "onentry onexit donedata"),
    "initial": Shape("", "transition"),
    "history": Shape("id type", "transition"),
    "transition": Shape("event cond target type", _ACTIONS),
    "onentry": Shape("", _ACTIONS),
    "onexit": Shape("", _ACTIONS),
    "finalize": Shape("", _ACTIONS),
    "datamodel": Shape("", "data"),
    "data": Shape("id src expr", "*", "id", ("src expr",)),
    "donedata": Shape("", "param content"),
    "param": Shape("name expr location", "", "name", ("!expr location",)),
    "content": Shape("expr", "*"),
    "invoke": Shape(
        "type typeexpr src srcexpr id idlocation namelist autoforward", "param content finalize",
        one=("type typeexpr", "src srcexpr", "id idlocation"),
    ),
    "raise": Shape("event", "", "event"),
    "send": Shape(
        "event eventexpr target targetexpr type typeexpr id idlocation delay delayexpr namelist", "param content",
        one=("event eventexpr", "target targetexpr", "type typeexpr", "id idlocation", "delay delayexpr"),
    ),
    "cancel": Shape("sendid sendidexpr", one=("!sendid sendidexpr",)),
    "log": Shape("label expr"),
    "if": Shape("cond", f"{_ACTIONS} elseif else", "cond"),
    "elseif": Shape("cond", "", "cond"),
    "else": Shape(),
    "foreach": Shape("array item index", _ACTIONS, "array item"),
    "assign": Shape("location expr", "*", "location"),
    "script": Shape("src", "*"),
}  # fmt: skip

_VALUES: dict[tuple[str, str], tuple[str, ...]] = {
    ("transition", "type"): ("external", "internal"),
    ("history", "type"): ("shallow", "deep"),
    ("scxml", "binding"): ("early", "late"),
    ("scxml", "version"): ("1.0",),
    ("invoke", "autoforward"): ("true", "false"),
}


def shape_faults(root: Element) -> Iterator[Diagnostic]:
    """Reports all that SCXML 1.0 does not allow. Elements of other namespaces are skipped."""
    if root.name != "scxml" or root.namespace not in (SCXML, ""):
        yield codes.NOT_SCXML.at(root.span, name=root.name)
    else:
        if root.namespace == "":
            at = root.tags[0]
            behind = Span(at.file, at.end_line, at.end_column, at.end_line, at.end_column)
            fix = Fix("add the namespace", (Edit(behind, f' xmlns="{SCXML}"'),), safe=True)
            yield codes.NO_NAMESPACE.at(root.span, hint=f'write <scxml xmlns="{SCXML}" …>', fixes=[fix])
        yield from _element_faults(root)


def scxml_children(parent: Element) -> Iterator[Element]:
    """The children in the namespace of SCXML."""
    return (child for child in parent.children if child.namespace in (SCXML, ""))


def _element_faults(element: Element) -> Iterator[Diagnostic]:
    shape = SHAPES[element.name]
    known = shape.attributes.split()
    for name in element.attributes:
        if name not in known and " " not in name:
            hint = did_you_mean(
                name, known, element.attributes, otherwise=f"it has {', '.join(known) or 'no attributes'}"
            )
            where = element.names.get(name, element.span)
            yield codes.UNKNOWN_ATTRIBUTE.at(where, name=name, element=element.name, hint=hint)
    for name in shape.required.split():
        if not (element.get(name) or "").strip():
            yield codes.MISSING_ATTRIBUTE.at(element.span, name=name, element=element.name)
    for group in shape.one:
        names = group.lstrip("!").split()
        present = [name for name in names if element.get(name) is not None]
        if len(present) > 1:
            yield codes.TWO_ATTRIBUTES.at(element.place(present[1]), first=present[0], second=present[1])
        elif not present and group.startswith("!"):
            yield codes.MISSING_ATTRIBUTE.at(element.span, name="' or '".join(names), element=element.name)
    yield from _values(element)
    allowed = shape.children.split()
    if allowed == ["*"]:
        for child in scxml_children(element):
            if child.name == "scxml":
                yield from _element_faults(child)
        return
    for child in scxml_children(element):
        if child.name not in allowed:
            close = suggest(child.name, allowed)
            otherwise = f"it may contain {', '.join(allowed)}" if allowed else ""
            yield codes.UNKNOWN_ELEMENT.at(
                child.span,
                name=child.name,
                parent=element.name,
                hint=f"did you mean <{close}>?" if close else otherwise,
                fixes=[Fix(f"write <{close}>", tuple(Edit(tag, close) for tag in child.tags))] if close else [],
            )
        else:
            yield from _element_faults(child)
    if stray := element.text.strip():
        yield codes.STRAY_TEXT.at(element.span, text=stray.split()[0][:40], element=element.name)
    yield from _counts(element)


def _values(element: Element) -> Iterator[Diagnostic]:
    for name, value in element.attributes.items():
        allowed = _VALUES.get((element.name, name))
        if allowed and value not in allowed:
            otherwise = f"write {' or '.join(allowed)}"
            hint = did_you_mean(value, allowed, otherwise=otherwise)
            if len(allowed) == 1:
                hint = Hint(otherwise, value, allowed[0], safe=True)
            yield codes.BAD_VALUE.at(element.place(name), name=name, value=value, hint=hint)
    delay = element.get("delay")
    if element.name == "send" and delay is not None and seconds(delay) is None:
        yield codes.BAD_VALUE.at(element.place("delay"), name="delay", value=delay, hint="write 100ms or 1.5s")
    if element.name == "send" and delay is not None and element.get("target") == "#_internal":
        yield codes.BAD_VALUE.at(
            element.place("delay"),
            name="delay",
            value=delay,
            hint="an event to #_internal is sent at once: remove the delay, or the target",
        )


def _counts(element: Element) -> Iterator[Diagnostic]:
    """Elements that may occur once only."""
    names = [child.name for child in scxml_children(element)]
    if element.name in ("initial", "history") and names.count("transition") != 1:
        yield codes.ONE_TRANSITION.at(element.span, element=element.name)
    for name in ("initial", "donedata", "datamodel", "finalize", "content"):
        if names.count(name) > 1:
            second = [child for child in scxml_children(element) if child.name == name][1]
            yield codes.TWICE.at(second.span, name=name, element=element.name)
    if "content" in names and "param" in names and element.name != "invoke":
        content = next(child for child in scxml_children(element) if child.name == "content")
        yield codes.TWO_ATTRIBUTES.at(content.span, first="param", second="content")
