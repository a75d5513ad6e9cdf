"""Parameters: defaults, constraints on defaults, names in code, and the legacy table."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import Any

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import LinkedParameters, Program
from robocomp_yaml.parameters.defaults import defaults
from robocomp_yaml.parameters.expressions import evaluate
from robocomp_yaml.parameters.types import Parameters, RecordType, ResolvedMember
from robocomp_yaml.parameters.verdict.specification import default_faults, spelling_faults


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        assert linked.document is not None
        known = (*languages.table().values(), *program.plugins_of(linked.document.path).languages)
        owner = linked.component.component.path if linked.component is not None else ""
        part, causes = ("parameters", linked.document.path, owner), (linked.parameters, linked.broken, *known)
        yield from program.memory.result(part, causes, partial(_faults, linked, known))


def _faults(linked: LinkedParameters, known: Sequence[TargetLanguage]) -> Sequence[Diagnostic]:
    parameters = linked.parameters
    records = [parameters.root, *(type_ for type_ in parameters.types if isinstance(type_, RecordType))]
    faults = [*default_faults(linked), *(fault for record in records for fault in _names(record, known))]
    if linked.broken:
        return faults
    together = () if faults else _defaults_together(parameters)
    return [*faults, *together, *spelling_faults(parameters)]


def _names(record: RecordType, known: Iterable[TargetLanguage]) -> Iterator[Diagnostic]:
    """Checks the names of a struct's members, and of those in its groups."""
    names: dict[tuple[str, str], ResolvedMember] = {}
    for member in record.members:
        if member.is_group and isinstance(member.type, RecordType):
            yield from _names(member.type, known)
        name = member.code_name
        if not (name.isascii() and name.isidentifier() and not name.startswith("__")):
            yield codes.NO_IDENTIFIER.at(
                member.span, name=member.name, hint=f"for instance as: {_as_identifier(member.name)}"
            )
            continue
        for language in known:
            code = language.in_code(member.code_name)
            other = names.setdefault((language.name, code), member)
            if other is not member:
                yield codes.CODE_CLASH.at(
                    member.span,
                    name=member.name,
                    other=other.name,
                    code=code,
                    language=language.title,
                    hint="set another name in code for one of them with as:",
                    related=[Related(f"'{other.name}'", other.span)],
                )
                break


def _as_identifier(name: str) -> str:
    """A legal identifier similar to a name."""
    identifier = re.sub(r"[^A-Za-z0-9_]", "_", name).lstrip("_")
    return identifier if identifier[:1].isalpha() else f"p{identifier}"


def _add_unknown_values(record: RecordType, data: dict[str, Any]) -> None:
    """Adds required parameters with an unknown value: a reference to the environment."""
    for member in record.members:
        if isinstance(member.type, RecordType) and member.is_group:
            inner = data[member.code_name] = dict(data.get(member.code_name, {}))
            _add_unknown_values(member.type, inner)
        elif member.required:
            data[member.code_name] = {"env": "GIVEN"}


def _defaults_together(parameters: Parameters) -> Iterator[Diagnostic]:
    """Reports constraints that the defaults violate. Values of required parameters are unknown."""
    data = dict(evaluate.by_code_names(parameters.root, defaults(parameters.root)))
    _add_unknown_values(parameters.root, data)
    for constraint in parameters.constraints:
        if not evaluate.holds(constraint.expression, data):
            yield codes.DEFAULTS_BREAK.at(constraint.span, message=constraint.message)
