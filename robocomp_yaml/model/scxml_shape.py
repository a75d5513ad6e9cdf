"""The shape of SCXML: which element may stand where, with which attributes. What a schema is for YAML."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean, suggest
from robocomp_yaml.semantics.events import seconds
from robocomp_yaml.source.xml import Element

SCXML = "http://www.w3.org/2005/07/scxml"
ROBOCOMP = "urn:robocomp:statemachine"


class Shape(msgspec.Struct, frozen=True):
    """`one` are groups of attributes of which at most one is given; a group that starts with '!' needs one."""

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
    """Everything that is not as SCXML wants it. Elements of other namespaces are notes of other tools."""
    if root.name != "scxml" or root.namespace not in (SCXML, ""):
        yield codes.NOT_SCXML.at(root.span, name=root.name)
    else:
        if root.namespace == "":
            yield codes.NO_NAMESPACE.at(root.span, hint=f'write <scxml xmlns="{SCXML}" …>')
        yield from _element_faults(root)


def scxml_children(parent: Element) -> Iterator[Element]:
    """The children that are SCXML's."""
    return (child for child in parent.children if child.namespace in (SCXML, ""))


def _element_faults(element: Element) -> Iterator[Diagnostic]:
    shape = SHAPES[element.name]
    known = shape.attributes.split()
    for name in element.attributes:
        if name not in known and " " not in name:
            hint = did_you_mean(name, known, element.attributes, otherwise=f"it has {', '.join(known) or 'none'}")
            yield codes.UNKNOWN_ATTRIBUTE.at(element.place(name), name=name, element=element.name, hint=hint)
    for name in shape.required.split():
        if not (element.get(name) or "").strip():
            yield codes.MISSING_ATTRIBUTE.at(element.span, name=name, element=element.name)
    for group in shape.one:
        names = group.lstrip("!").split()
        given = [name for name in names if element.get(name) is not None]
        if len(given) > 1:
            yield codes.TWO_ATTRIBUTES.at(element.place(given[1]), first=given[0], second=given[1])
        elif not given and group.startswith("!"):
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
            holds = f"it holds {', '.join(allowed)}" if allowed else ""
            yield codes.UNKNOWN_ELEMENT.at(
                child.span, name=child.name, parent=element.name, hint=f"did you mean <{close}>?" if close else holds
            )
        else:
            yield from _element_faults(child)
    if stray := element.text.strip():
        yield codes.STRAY_TEXT.at(element.span, text=stray.split()[0][:40], element=element.name)
    yield from _counts(element)


def _values(element: Element) -> Iterator[Diagnostic]:
    for name, value in element.attributes.items():
        wanted = _VALUES.get((element.name, name))
        if wanted and value not in wanted:
            yield codes.BAD_VALUE.at(element.place(name), name=name, value=value, hint=f"write {' or '.join(wanted)}")
    delay = element.get("delay")
    if element.name == "send" and delay is not None and seconds(delay) is None:
        yield codes.BAD_VALUE.at(element.place("delay"), name="delay", value=delay, hint="write 100ms or 1.5s")
    if element.name == "send" and delay is not None and element.get("target") == "#_internal":
        yield codes.BAD_VALUE.at(
            element.place("delay"), name="delay", value=delay, hint="what goes to #_internal goes at once"
        )


def _counts(element: Element) -> Iterator[Diagnostic]:
    """What may stand there once."""
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
