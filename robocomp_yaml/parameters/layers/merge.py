"""Layers of values merged: mappings merge, lists and scalars replace, null resets to the default.

The result has, for each value, its node and the nodes that it overrides.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type, below
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.tree import Mapping, Node, Scalar, child


class MergedValue(msgspec.Struct, frozen=True):
    """A merged value. `node` is its node in the last layer that sets it, `key` the key of that node. `entries` are the
    entries of a merged mapping; None for lists and plain values. `overrode` are the nodes of earlier layers that it
    replaces, the latest first."""

    node: Node
    key: Scalar | None
    entries: dict[str, MergedValue] | None = None
    overrode: tuple[Node, ...] = ()


LayerEntry = tuple[Scalar | None, Node]
Origin = MergedValue | Node | None
"""The origin of a value: a merged value, a node inside an unmerged value, or None for a default."""


def merged(values: LayeredValues) -> MergedValue | None:
    """The values under `parameters:` of all layers, merged by their types; None if there are none."""
    assert values.parameters is not None
    return merge(values.parameters.parameters.root, [entry for layer in values.layers() for entry in section(layer)])


def section(values: LayeredValues) -> list[LayerEntry]:
    """The entry `parameters:` of the document itself: a list of one entry, or an empty list."""
    entry = values.document.root.entries.get("parameters")
    return [entry] if entry is not None and isinstance(entry[1], Mapping) else []


def merge(type_: Type, entries_of_layers: Iterable[LayerEntry]) -> MergedValue | None:
    """One value merged from its layers, the most general first; None if no layer sets it."""
    layers = list(entries_of_layers)
    for index in range(len(layers) - 1, -1, -1):
        if layers[index][1].data is None:  # null discards all earlier layers
            layers = layers[index + 1 :]
            break
    if not layers:
        return None
    key, top = layers[-1]
    if not isinstance(type_, (RecordType, MapType)) or not isinstance(top, Mapping):
        return MergedValue(top, key, None, _overridden(layers[:-1]))
    first = len(layers) - 1
    while first > 0 and isinstance(layers[first - 1][1], Mapping):
        first -= 1
    by_name: dict[str, list[LayerEntry]] = {}
    for _, node in layers[first:]:
        assert isinstance(node, Mapping)
        for name, entry in node.entries.items():
            by_name.setdefault(name, []).append(entry)
    entries = {}
    for name, entry_layers in by_name.items():
        entry_type = below(type_, name)
        if entry_type is not None and (merged_value := merge(entry_type, entry_layers)) is not None:
            entries[name] = merged_value
    return MergedValue(top, key, entries, _overridden(layers[:first]))


def _overridden(layers: list[LayerEntry]) -> tuple[Node, ...]:
    return tuple(node for _, node in reversed(layers))


def data_of(merged_value: MergedValue | None, type_: Type) -> Any:
    """The plain data of merged values, without null."""
    if merged_value is None:
        return {}
    if merged_value.entries is None:
        return _without_null(merged_value.node.data, type_)
    return {
        name: data_of(entry, entry_type)
        for name, entry in merged_value.entries.items()
        if (entry_type := below(type_, name)) is not None
    }


def _without_null(data: Any, type_: Type) -> Any:
    """Data in a list, which does not merge, without null members, which reset to their defaults, and without the keys
    `x-…` of records, which are not members."""
    if isinstance(type_, ListType) and isinstance(data, list):
        if not isinstance(type_.element, (RecordType, MapType, ListType)):
            return data
        return [_without_null(item, type_.element) for item in data]
    if isinstance(type_, (RecordType, MapType)) and isinstance(data, dict):
        kept = data
        if isinstance(type_, RecordType) and any(name.startswith("x-") for name in data):
            kept = {name: value for name, value in data.items() if not name.startswith("x-")}
        if None not in kept.values() and not any(isinstance(value, (dict, list)) for value in kept.values()):
            return kept
        return {
            name: _without_null(value, below(type_, name) or type_) for name, value in kept.items() if value is not None
        }
    return data


def step(where: Origin, name: Step) -> Origin:
    """The origin one step below: the merged entry, or the node."""
    if isinstance(where, MergedValue):
        if where.entries is not None:
            return where.entries.get(name) if isinstance(name, str) else None
        where = where.node
    found = child(where, name)
    return None if found is None or found[1].data is None else found[1]


def node_of(where: Origin) -> Node | None:
    return where.node if isinstance(where, MergedValue) else where


def span_of(where: Origin) -> Span | None:
    """The location of a value; of its key if the value spans several lines."""
    node = node_of(where)
    if node is None:
        return None
    span = node.span
    key = where.key if isinstance(where, MergedValue) else None
    return key.span if key is not None and span.line != span.end_line else span
