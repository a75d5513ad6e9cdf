"""The legacy table: each entry names a parameter, and can spell what that parameter holds."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.program import LinkedParameters, Program
from robocomp_yaml.parameters.spelling.templates import fault
from robocomp_yaml.parameters.types import RecordType, Type


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.parameter_documents():
        if not linked.broken:
            yield from _spellings(linked)


def _spellings(linked: LinkedParameters) -> Iterator[Diagnostic]:
    known = dict(_paths(linked.parameters.root))
    for spelling in linked.parameters.spellings:
        type_ = known.get(spelling.path)
        if type_ is None:
            given = {other.path for other in linked.parameters.spellings}
            yield codes.BAD_SPELLING.at(
                spelling.span,
                path=spelling.path,
                problem="names no parameter",
                hint=did_you_mean(spelling.path, known, given),
            )
        elif problem := fault(spelling, type_):
            yield codes.BAD_SPELLING.at(spelling.span, path=spelling.path, problem=problem)


def _paths(record: RecordType, prefix: str = "") -> Iterator[tuple[str, Type]]:
    """Parameters and groups by their paths."""
    for member in record.members:
        yield f"{prefix}{member.name}", member.type
        if member.is_group and isinstance(member.type, RecordType):
            yield from _paths(member.type, f"{prefix}{member.name}.")
