"""The effective values of a document and its layers, and their problems."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.documents import LayeredValues, ResolvedParameters
from robocomp_yaml.parameters.json_schema import DOCUMENT, EFFECTIVE, fits
from robocomp_yaml.parameters.layers.completion import complete_at_once, completed
from robocomp_yaml.parameters.layers.merge import MergedValue, data_of, merged, section
from robocomp_yaml.parameters.types import MapType, Parameters, RecordType, Type
from robocomp_yaml.parameters.verdict.judge import judge, missing, wrong_size
from robocomp_yaml.parameters.verdict.specification import is_usable
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.source.tree import Mapping, Node, mapping_at, sequence_at
from robocomp_yaml.source.tree import Sequence as List

if TYPE_CHECKING:
    from robocomp_yaml.parameters.specification.expression import Expression


class Effective(msgspec.Struct, frozen=True):
    """`data` are the values with all defaults, and references as `{"env": NAME}`. `merged` are the merged values with
    their nodes. Callers share `data`, and do not change it."""

    data: dict[str, Any]
    merged: MergedValue | None
    parameters: Parameters


def document_faults(values: LayeredValues, linked: ResolvedParameters) -> Sequence[Diagnostic]:
    """The problems of the values that a document itself sets. Missing values are no problem."""
    if values not in linked.faults:
        linked.faults[values] = tuple(_document_faults(values, linked))
    return linked.faults[values]


def _document_faults(values: LayeredValues, linked: ResolvedParameters) -> Iterator[Diagnostic]:
    for key, node in section(values):
        if not fits(linked, DOCUMENT, node.data):
            yield from judge(linked.parameters.root, node, (), complete=False, key=key)


def effective(values: LayeredValues) -> tuple[Effective | None, Sequence[Diagnostic]]:
    """The effective values of a document and its layers, and their problems. The values are None if there are problems.
    A program computes them once for each document."""
    linked, found = values.parameters, list[Diagnostic]()
    assert linked is not None
    root, merged_value, head = linked.parameters.root, merged(values), values.head
    data = _of_single_layer(values)
    whole = complete_at_once(linked, data) if data is not None else None
    # A single layer that is valid as effective values is also valid as a layer: one validation is enough.
    if data is None or (whole is None and not fits(linked, EFFECTIVE, data)):
        data = data_of(merged_value, root)
        found += [fault for layer in values.layers() for fault in document_faults(layer, linked)]
        if not values.broken and not fits(linked, EFFECTIVE, data):
            found += _without_misspelled(found, _incomplete(root, merged_value, (), head))
    if found or values.broken or not is_usable(linked):
        return None, found
    whole = completed(linked, data) if whole is None else whole
    found += broken_constraints(linked.parameters, whole, merged_value, head)
    return (None if found else Effective(whole, merged_value, linked.parameters)), found


def _of_single_layer(values: LayeredValues) -> dict[str, Any] | None:
    own = section(values)
    data = own[0][1].data if own and not values.extends else None
    return data if isinstance(data, dict) else None


def _without_misspelled(found: list[Diagnostic], missing_ones: Iterable[Diagnostic]) -> list[Diagnostic]:
    """The missing values, without those that are present with a misspelled name: these have one cause, not two."""
    meant = set()
    for fault in found:
        if fault.code == codes.UNKNOWN_PARAMETER.id and (name := fault.fact("meant")):
            outer = str(fault.fact("path")).rpartition(".")[0]
            meant.add(f"{outer}.{name}" if outer else name)
    return [fault for fault in missing_ones if fault.fact("path") not in meant]


def _incomplete(type_: Type, merged_value: MergedValue | None, path: Path, head: Span) -> Iterator[Diagnostic]:
    """The missing values, and the maps whose size is wrong after merging."""
    if merged_value is not None and merged_value.key is not None:
        head = merged_value.key.span
    if merged_value is not None and merged_value.entries is None:
        if path:
            yield from _incomplete_node(type_, merged_value, path, head)
        return
    entries = merged_value.entries if merged_value is not None else None
    if isinstance(type_, RecordType):
        yield from missing(type_, set(entries or ()), path, head)
        for name, entry in (entries or {}).items():
            member = type_.member(name)
            assert member is not None
            yield from _incomplete(member.type, entry, (*path, name), head)
    elif isinstance(type_, MapType) and merged_value is not None:
        yield from wrong_size(type_, len(entries or ()), merged_value.node, path, merged_value.key)
        for name, entry in (entries or {}).items():
            yield from _incomplete(type_.element, entry, (*path, name), head)


def _incomplete_node(type_: Type, merged_value: MergedValue, path: Path, head: Span) -> Iterator[Diagnostic]:
    """The same in a list, whose elements do not merge: each is judged, without null."""
    for fault in judge(type_, _without_null(merged_value.node), path, complete=True, key=merged_value.key):
        if fault.code in (codes.MISSING.id, codes.WRONG_SIZE.id):
            yield fault


def _without_null(node: Node) -> Node:
    """The node without null in mappings, which is the same as a missing value."""
    if isinstance(node, Mapping):
        entries = {
            name: (key, _without_null(value)) for name, (key, value) in node.entries.items() if value.data is not None
        }
        return mapping_at(node.span, entries)
    return sequence_at(node.span, [_without_null(item) for item in node.items]) if isinstance(node, List) else node


def broken_constraints(
    parameters: Parameters, data: dict[str, Any], merged_value: MergedValue | None, head: Span
) -> Iterator[Diagnostic]:
    """The constraints that complete values break, at the value that one of them names, else at `head`."""
    if not parameters.constraints:
        return
    from robocomp_yaml.parameters.expressions import evaluate

    named = evaluate.by_code_names(parameters.root, data)
    for constraint in parameters.constraints:
        if not evaluate.holds(constraint.expression, named):
            span = _concerned(parameters.root, constraint.expression, merged_value) or head
            yield codes.CONSTRAINT.at(
                span, message=constraint.message, hint="" if not constraint.otherwise else constraint.text
            )


def _concerned(root: RecordType, expression: Expression, merged_value: MergedValue | None) -> Span | None:
    """The location of the first value that a constraint names and a document sets; None if there is none."""
    from robocomp_yaml.parameters.expressions import evaluate

    for steps in evaluate.paths(expression):
        value, record = merged_value, root
        found: Span | None = None
        for step in steps:
            member = next((m for m in record.members if m.code_name == step), None)
            entry = value.entries.get(member.name) if value and value.entries and member else None
            if entry is None or member is None:
                break
            value, found = entry, entry.key.span if entry.key else entry.node.span
            if not isinstance(member.type, RecordType):
                break
            record = member.type
        if found is not None:
            return found
    return None
