"""Parameters: defaults, alone and together, and names in code."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.names import is_identifier
from robocomp_yaml.model.parameters import Member, Parameters, RecordType
from robocomp_yaml.source.tree import Mapping, Node, Sequence
from robocomp_yaml.values import evaluate
from robocomp_yaml.values.defaults import defaults
from robocomp_yaml.values.judge import Path, judge
from robocomp_yaml.values.references import is_reference

Languages = tuple[TargetLanguage, ...]


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        assert linked.document is not None
        more = program.plugins_of(linked.document.path).languages
        faults = list(_records(linked.parameters, (*languages.table().values(), *more)))
        yield from faults
        if not faults and not linked.broken:
            yield from _defaults_together(linked.parameters)


def _records(parameters: Parameters, known: Languages) -> Iterator[Diagnostic]:
    """Each struct once, and the groups of the parameters."""
    yield from _members(parameters.root, (), known)
    for type_ in parameters.types:
        if isinstance(type_, RecordType):
            yield from _members(type_, (type_.name,), known)


def _members(record: RecordType, path: Path, known: Languages) -> Iterator[Diagnostic]:
    yield from _names(record, known)
    for member in record.members:
        if member.is_group and isinstance(member.type, RecordType):
            yield from _members(member.type, (*path, member.name), known)
        elif member.default is not None and member.default.node is not None:
            yield from _default(member, member.default.node, (*path, member.name))


def _default(member: Member, node: Node, path: Path) -> Iterator[Diagnostic]:
    for fault in judge(member.type, node, path, complete=True):
        problem = fault.message
        if fault.code == value_codes.UNKNOWN_PARAMETER.id:
            problem = f"{member.name} gives a value to something else: {problem}"
        yield codes.BAD_DEFAULT.at(fault.span, problem=problem, hint=fault.hint, fixes=fault.fixes)
    for reference in _references(node):
        source = "a file" if "file" in reference.entries else "the environment"
        yield codes.BAD_DEFAULT.at(
            reference.span, problem=f"{member.name} comes from {source}", hint="references stand in values documents"
        )


def _references(node: Node) -> Iterator[Mapping]:
    if isinstance(node, Mapping):
        if is_reference(node.data):
            yield node
        for _, value in node.items():
            yield from _references(value)
    elif isinstance(node, Sequence):
        for item in node.items:
            yield from _references(item)


def _names(record: RecordType, known: Languages) -> Iterator[Diagnostic]:
    names: dict[tuple[str, str], Member] = {}
    for member in record.members:
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
