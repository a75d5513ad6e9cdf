"""Parameters: defaults, alone and together, names in code, and the legacy table."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.names import is_identifier
from robocomp_yaml.parameters.defaults import defaults
from robocomp_yaml.parameters.expressions import evaluate
from robocomp_yaml.parameters.types import Parameters, RecordType, ResolvedMember
from robocomp_yaml.parameters.verdict.specification import default_faults, spelling_faults

Languages = tuple[TargetLanguage, ...]


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        assert linked.document is not None
        parameters = linked.parameters
        more = program.plugins_of(linked.document.path).languages
        known = (*languages.table().values(), *more)
        records = [parameters.root, *(type_ for type_ in parameters.types if isinstance(type_, RecordType))]
        faults = [*default_faults(linked), *(fault for record in records for fault in _names(record, known))]
        yield from faults
        if linked.broken:
            continue
        if not faults:
            yield from _defaults_together(parameters)
        yield from spelling_faults(parameters)


def _names(record: RecordType, known: Languages) -> Iterator[Diagnostic]:
    """Of a record, and of the groups in it."""
    names: dict[tuple[str, str], ResolvedMember] = {}
    for member in record.members:
        if member.is_group and isinstance(member.type, RecordType):
            yield from _names(member.type, known)
        if not is_identifier(member.code_name):
            yield codes.NO_IDENTIFIER.at(member.span, name=member.name, hint=f"for instance as: {_free(member.name)}")
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
                    hint="give one of them another name in code with as:",
                    related=[Related(f"'{other.name}' stands here", other.span)],
                )
                break


def _free(name: str) -> str:
    """An identifier that is like it."""
    made = re.sub(r"[^A-Za-z0-9_]", "_", name).lstrip("_")
    return made if made[:1].isalpha() else f"p{made}"


def _take_as_given(record: RecordType, data: dict[str, Any]) -> None:
    """What has to be given has a value, which is not known: as a reference has."""
    for member in record.members:
        if isinstance(member.type, RecordType) and member.is_group:
            inner = data[member.code_name] = dict(data.get(member.code_name, {}))
            _take_as_given(member.type, inner)
        elif member.required:
            data[member.code_name] = {"env": "GIVEN"}


def _defaults_together(parameters: Parameters) -> Iterator[Diagnostic]:
    """Constraints that are broken where nobody gives a value; what has no default is not known here."""
    data = dict(evaluate.by_code_names(parameters.root, defaults(parameters.root)))
    _take_as_given(parameters.root, data)
    for constraint in parameters.constraints:
        if not evaluate.holds(constraint.expression, data):
            yield codes.DEFAULTS_BREAK.at(constraint.span, message=constraint.message)
