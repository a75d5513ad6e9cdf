"""Problems of parameters themselves: invalid defaults, and legacy spellings that do not fit their parameters."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.spelling.templates import fault
from robocomp_yaml.parameters.types import Parameters, RecordType, ResolvedMember, leaves
from robocomp_yaml.parameters.verdict.judge import judge
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.semantics.references import is_reference
from robocomp_yaml.source.tree import Mapping, Node, Sequence


def is_usable(linked: ResolvedParameters) -> bool:
    """Whether values can be completed and written by these parameters. If not, the problems are reported in the
    parameters document, and values are only judged one by one."""
    return (
        not linked.broken and not default_faults(linked) and linked.once("spelled", lambda: _spells(linked.parameters))
    )


def _spells(parameters: Parameters) -> bool:
    types = {path: member.type for path, member in leaves(parameters.root)}
    return not any(
        spelling.path in types and fault(spelling, types[spelling.path]) for spelling in parameters.spellings
    )


def default_faults(linked: ResolvedParameters) -> list[Diagnostic]:
    """The problems of defaults of parameters and, once for each struct, of its members."""
    return linked.once("default faults", lambda: list(_default_faults(linked.parameters)))


def _default_faults(parameters: Parameters) -> Iterator[Diagnostic]:
    yield from _of_members(parameters.root, ())
    for type_ in parameters.types:
        if isinstance(type_, RecordType):
            yield from _of_members(type_, (type_.name,))


def _of_members(record: RecordType, path: Path) -> Iterator[Diagnostic]:
    for member in record.members:
        if member.is_group and isinstance(member.type, RecordType):
            yield from _of_members(member.type, (*path, member.name))
        elif member.default is not None and member.default.node is not None:
            yield from _of_default(member, member.default.node, (*path, member.name))


def _of_default(member: ResolvedMember, node: Node, path: Path) -> Iterator[Diagnostic]:
    for one in judge(member.type, node, path, complete=True):
        problem = one.message
        if one.code == value_codes.UNKNOWN_PARAMETER.id:
            problem = f"{member.name} does not fit: {problem}"
        yield codes.BAD_DEFAULT.at(one.span, problem=problem, hint=one.hint, fixes=one.fixes)
    for reference in _references(node):
        source = "a file" if "file" in reference.entries else "the environment"
        yield codes.BAD_DEFAULT.at(
            reference.span,
            problem=f"{member.name} is a reference to {source}",
            hint="write references in values documents",
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


def spelling_faults(parameters: Parameters) -> Iterator[Diagnostic]:
    """The problems of the entries of `legacy:`: unknown parameters, and spellings that do not fit their types."""
    known = {path: member.type for path, member in leaves(parameters.root, groups=True)}
    for spelling in parameters.spellings:
        type_ = known.get(spelling.path)
        if type_ is None:
            present = {other.path for other in parameters.spellings}
            hint = did_you_mean(spelling.path, known, present)
            yield codes.BAD_SPELLING.at(
                spelling.span, path=spelling.path, problem="names an unknown parameter", hint=hint
            )
        elif problem := fault(spelling, type_):
            yield codes.BAD_SPELLING.at(spelling.span, path=spelling.path, problem=problem)
