"""Whether a document of parameters is sound enough for values to be completed and written by it."""

from __future__ import annotations

from robocomp_yaml.parameters.documents import ResolvedParameters
from robocomp_yaml.parameters.spelling.references import has_reference
from robocomp_yaml.parameters.spelling.templates import fault
from robocomp_yaml.parameters.types import RecordType, Type, leaves
from robocomp_yaml.parameters.verdict.judge import judge
from robocomp_yaml.source.tree import Node


def is_usable(linked: ResolvedParameters) -> bool:
    """Every parameter has a type, every default fits its own, and the legacy table can spell what it names. What is
    wrong has been told at the document's lines; values are then judged each by itself, and no further."""
    if linked.broken:
        return False
    if "usable" not in linked.compiled:
        parameters = linked.parameters
        types = {path: member.type for path, member in leaves(parameters.root)}
        records = [parameters.root, *(type_ for type_ in parameters.types if isinstance(type_, RecordType))]
        spellings = ((spelling, types.get(spelling.path)) for spelling in parameters.spellings)
        linked.compiled["usable"] = all(map(_defaults_fit, records)) and all(
            type_ is None or not fault(spelling, type_) for spelling, type_ in spellings
        )
    usable: bool = linked.compiled["usable"]
    return usable


def _defaults_fit(record: RecordType) -> bool:
    for member in record.members:
        if isinstance(member.type, RecordType) and member.is_group:
            if not _defaults_fit(member.type):
                return False
        elif member.default is not None and member.default.node is not None:
            if not _fits(member.type, member.default.node):
                return False
    return True


def _fits(type_: Type, node: Node) -> bool:
    return not has_reference(node) and not any(judge(type_, node, (), complete=True))
