"""Completion in files beside the documents: mock scripts, and the settings of a workspace."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.api.completing.places import TypedPlace
from robocomp_yaml.api.completing.proposal import CODE, Proposal
from robocomp_yaml.diag.codes import table
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.interface import Method
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import Names


def in_script(place: TypedPlace, known: Names, program: Program | None, present: list[str]) -> Iterator[Proposal]:
    """Interfaces, topics, methods and their arguments, as keys of a mock script."""
    if not place.is_key and place.keys[-1:] != ("",):
        return
    match place.keys:
        case ("interfaces" | "topics" as section,):
            kind = names.INTERFACE if section == "interfaces" else names.TOPIC
            for one in known.of_kinds(kind):
                if one.name not in present:
                    yield Proposal(one.name, kind, one.says, one.doc, snippet=f"{one.name}: ")
        case ("interfaces", name, "methods") | ("topics", name, "messages", ""):
            for method in _methods(program, name):
                if method.name not in present:
                    yield Proposal(method.name, names.METHOD, "", method.doc, snippet=f"{method.name}: ")
        case ("interfaces", name, "methods", called, *_, "out"):
            yield from _arguments(program, name, called, present, is_out=True)
        case ("topics", name, "messages", "", called):
            yield from _arguments(program, name, called, present, is_out=False)


def _arguments(
    program: Program | None, name: str, called: str, present: list[str], *, is_out: bool
) -> Iterator[Proposal]:
    for method in _methods(program, name):
        for one in (method.outputs if is_out else method.inputs) if method.name == called else ():
            if one.name not in present:
                yield Proposal(one.name, names.ARGUMENT, one.type.text, one.doc, snippet=f"{one.name}: ")


def _methods(program: Program | None, name: str) -> Iterator[Method]:
    """The methods of the interfaces and topics with a name, which may be that in a module."""
    for scope in program.modules.values() if program is not None else ():
        for one in scope.module.all_interfaces:
            if name in (one.name, f"{scope.module.name}.{one.name}"):
                yield from one.methods


def in_settings(place: TypedPlace, present: list[str]) -> Iterator[Proposal]:
    """The codes of diagnostics below `lint:`."""
    if place.is_key and place.keys == ("lint",):
        for id_, code in table().items():
            if id_ not in present:
                yield Proposal(id_, CODE, code.message, snippet=f"{id_}: ")
