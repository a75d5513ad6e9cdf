"""Layers of values merged: mappings merge, lists and scalars replace, null returns to the default.

The result remembers for each value its node, and those that it overrode.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type, below
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


class MergedValue(msgspec.Struct, frozen=True):
    """A merged value. `node` is what the last layer says (of a merged mapping: its last one), `key` the key it stands
    behind; `entries` are those of a merged mapping, None for lists and plain values. `overrode` are the nodes of
    earlier layers that it replaces, the latest first."""

    node: Node
    key: Scalar | None
    entries: dict[str, MergedValue] | None = None
    overrode: tuple[Node, ...] = ()


LayerEntry = tuple[Scalar | None, Node]
Origin = MergedValue | Node | None
"""Where a value stands, if anywhere: among merged ones, or inside of one that is not merged."""


def merged(values: LayeredValues) -> MergedValue | None:
    """What the layers say under `parameters:`, merged by the types; None where they say nothing."""
    assert values.parameters is not None
    return merge(values.parameters.parameters.root, [given for layer in values.layers() for given in section(layer)])


def section(values: LayeredValues) -> list[LayerEntry]:
    """What a document itself has under `parameters:`: one entry, or none."""
    entry = values.document.root.entries.get("parameters")
    return [entry] if entry is not None and isinstance(entry[1], Mapping) else []


def merge(type_: Type, given: Iterable[LayerEntry]) -> MergedValue | None:
    """One value of several layers, the most general first."""
    layers = list(given)
    for index in range(len(layers) - 1, -1, -1):
        if layers[index][1].data is None:  # null: nothing before it counts
            layers = layers[index + 1 :]
            break
    if not layers:
        return None
    key, top = layers[-1]
    if not isinstance(type_, RecordType | MapType) or not isinstance(top, Mapping):
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
        if entry_type is not None and (place := merge(entry_type, entry_layers)) is not None:
            entries[name] = place
    return MergedValue(top, key, entries, _overridden(layers[:first]))


def _overridden(layers: list[LayerEntry]) -> tuple[Node, ...]:
    return tuple(node for _, node in reversed(layers))


def data_of(place: MergedValue | None, type_: Type) -> Any:
    """Plain data of merged values, without null."""
    if place is None:
        return {}
    if place.entries is None:
        return _without_null(place.node.data, type_)
    return {
        name: data_of(entry, entry_type)
        for name, entry in place.entries.items()
        if (entry_type := below(type_, name)) is not None
    }


def _without_null(data: Any, type_: Type) -> Any:
    """What stands in a list merges with nothing; null members return to their defaults there too, and keys `x-…` of
    records are no members."""
    if isinstance(type_, ListType) and isinstance(data, list):
        if not isinstance(type_.element, RecordType | MapType | ListType):
            return data
        return [_without_null(item, type_.element) for item in data]
    if isinstance(type_, RecordType | MapType) and isinstance(data, dict):
        kept = data
        if isinstance(type_, RecordType) and any(name.startswith("x-") for name in data):
            kept = {name: value for name, value in data.items() if not name.startswith("x-")}
        if None not in kept.values() and not any(isinstance(value, dict | list) for value in kept.values()):
            return kept
        return {
            name: _without_null(value, below(type_, name) or type_) for name, value in kept.items() if value is not None
        }
    return data


def child(node: Node | None, name: Step) -> LayerEntry | None:
    """Key and node one step further down."""
    if isinstance(node, Mapping) and isinstance(name, str):
        return node.entries.get(name)
    if isinstance(node, Sequence) and isinstance(name, int) and name < len(node.items):
        return None, node.items[name]
    return None


def step(where: Origin, name: Step) -> Origin:
    """One step further down: the merged entry, or the node."""
    if isinstance(where, MergedValue):
        if where.entries is not None:
            return where.entries.get(name) if isinstance(name, str) else None
        where = where.node
    found = child(where, name)
    return None if found is None or found[1].data is None else found[1]


def node_of(where: Origin) -> Node | None:
    return where.node if isinstance(where, MergedValue) else where


def span_of(where: Origin) -> Span | None:
    """A value's place; its key's where it fills many lines."""
    node = node_of(where)
    if node is None:
        return None
    span = node.span
    key = where.key if isinstance(where, MergedValue) else None
    return key.span if key is not None and span.line != span.end_line else span
