"""Completion in the constraints of a parameter document: parameters by their names in code, functions, variables, and
behind a dot the members of a group or record (`m.min` of `for m in motors`)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.api.completing import values
from robocomp_yaml.api.completing.places import TypedPlace
from robocomp_yaml.api.completing.proposal import VALUE, Proposal
from robocomp_yaml.link.program import Program
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import Names
from robocomp_yaml.parameters.expressions.types import find_member
from robocomp_yaml.parameters.specification.expression import FUNCTIONS
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type
from robocomp_yaml.parameters.words import label

_LOOP = re.compile(r"\bfor\s+(\w+)\s+in\s+([\w.\[\]]+)")
_STEP = re.compile(r"\[[^\]]*\]|[^.\[\]]+")


def proposals(path: str, place: TypedPlace, known: Names, program: Program | None) -> Iterator[Proposal]:
    if not place.is_in_expression:
        return
    linked = values.parameters_for(program, path) if program is not None else None
    root = linked.parameters.root if linked is not None else RecordType("", ())
    variables = dict(_LOOP.findall(place.text.split("\n")[place.line - 1]))
    head, dot, _ = place.word.rpartition(".")
    if dot:
        type_ = _type_at(root, head, variables)
        if isinstance(type_, RecordType):
            yield from _members(type_, f"{head}.")
        elif type_ is None and not _type_at(root, head.partition(".")[0], {}):  # a variable whose loop is not typed yet
            for one in known.in_document(path):
                if one.kind == names.PARAMETER_MEMBER:
                    yield Proposal(f"{head}.{one.name}", one.kind, one.says, one.doc)
        return
    yield from _members(root, "")
    yield from (Proposal(name, VALUE, "variable") for name in variables)
    yield from (Proposal(name, VALUE, "function", snippet=f"{name}(") for name in FUNCTIONS)


def _members(record: RecordType, head: str) -> Iterator[Proposal]:
    """The members of a record, and those of its groups."""
    for one in record.members:
        yield Proposal(f"{head}{one.code_name}", names.PARAMETER, label(one.type), one.doc)
        if isinstance(one.type, RecordType) and one.type.is_group:
            yield from _members(one.type, f"{head}{one.code_name}.")


def _type_at(root: Type, path: str, variables: dict[str, str]) -> Type | None:
    """The type at a path of names in code, the first of which may be a variable. None if there is none."""
    now: Type | None = root
    for number, step in enumerate(_STEP.findall(path)):
        is_element = step.startswith("[")
        if number == 0 and step in variables:
            inner = {name: of for name, of in variables.items() if name != step}
            now, is_element = _type_at(root, variables[step], inner), True
        if is_element:
            now = now.element if isinstance(now, ListType | MapType) else None
        elif isinstance(now, RecordType):
            now = find_member(now, step)
        else:
            return None
    return now
