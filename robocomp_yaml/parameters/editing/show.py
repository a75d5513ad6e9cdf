"""Effective values with their origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.parameters.hidden import hidden, holds_secret
from robocomp_yaml.parameters.layers.effective import Effective
from robocomp_yaml.parameters.layers.merge import MergedValue, Origin, node_of, step
from robocomp_yaml.parameters.types import (
    BasicType,
    ListType,
    MapType,
    RecordType,
    Type,
    below,
    unit_of,
)
from robocomp_yaml.secrets import HIDDEN
from robocomp_yaml.semantics.paths import Path, Step, in_words
from robocomp_yaml.source.tree import Node, Scalar, child, parse
from robocomp_yaml.source.yaml_text import flow


class Value(msgspec.Struct, frozen=True):
    """A plain value, or an empty list or map. `node` is the node that sets it; None for a default, whose node is
    `default` if a document defines it. `overrode` are the nodes of earlier layers, the latest first."""

    path: str
    data: Any
    text: str
    unit: str
    editable: bool
    node: Node | None
    default: Node | None
    overrode: tuple[Node, ...]
    type: Type = RecordType("", ())
    steps: Path = ()
    reveal: bool = True

    def hide(self, data: Any) -> Any:
        """The value of another layer, as it may be shown."""
        return data if self.reveal else _hidden(self.type, self.steps, data)


def shown(effective: Effective, *, reveal: bool) -> Iterator[Value]:
    """All effective values, in order. Secrets are hidden unless `reveal`."""
    for row in _record(effective.parameters.root, effective.data, effective.merged, None, (), False):
        data = row.data if reveal else _hidden(row.type, row.steps, row.data)
        text = row.text if data == row.data else flow(data) if data != HIDDEN else HIDDEN
        yield replace(row, data=data, text=text, reveal=reveal)


def _hidden(type_: Type, steps: Path, data: Any) -> Any:
    """Data at a path, as it may be shown. An element of a map can be secret by its name."""
    name = steps[-1] if steps else 0
    named = isinstance(data, str) and data != "" and isinstance(name, str) and secrets.is_secret(name)
    return HIDDEN if named and isinstance(type_, BasicType) else hidden(type_, data)


def hidden_at(root: RecordType, steps: list[str], data: Any) -> Any:
    """Data at a path, with its secrets hidden."""
    type_ = type_at(root, steps)
    return data if type_ is None else _hidden(type_, tuple(steps), data)


def hidden_text(root: RecordType, steps: list[str], text: str) -> str:
    """The text of a value in a document, as it may be shown."""
    type_ = type_at(root, steps)
    if type_ is None or not text or text == "null":
        return text
    node = parse("", text)[0] if text.isprintable() else None
    if node is None:
        return HIDDEN if holds_secret(type_) or secrets.is_secret(steps[-1]) else secrets.url(text)
    data = hidden_at(root, steps, node.data)
    if data == node.data:
        return text
    return HIDDEN if data == HIDDEN else flow(data)


def _record(
    type_: RecordType, data: dict[str, Any], where: Origin, default: Node | None, path: Path, editable: bool
) -> Iterator[Value]:
    for member in type_.members:
        if member.name in data:
            inner_origin = step(where, member.name)
            own = step(default, member.name) if default is not None else None
            fallback = own if own is not None else member.default.node if member.default else None
            inner, is_editable = (*path, member.name), editable or member.editable
            yield from _value(member.type, data[member.name], inner_origin, node_of(fallback), inner, is_editable)


def _value(type_: Type, data: Any, where: Origin, default: Node | None, path: Path, editable: bool) -> Iterator[Value]:
    if isinstance(type_, RecordType) and isinstance(data, dict):
        yield from _record(type_, data, where, default, path, editable)
    elif isinstance(type_, (ListType, MapType)) and data:
        entries: list[tuple[Step, Any]] = list(data.items() if isinstance(type_, MapType) else enumerate(data))
        for name, item in entries:
            own = step(default, name) if default is not None and where is None else None
            yield from _value(type_.element, item, _below(where, name), node_of(own), (*path, name), editable)
    else:
        node = node_of(where)
        spelled = default if node is None else node
        as_spelled = isinstance(spelled, Scalar) and spelled.data == data and not isinstance(data, str)
        text = spelled.lexeme if as_spelled else flow(data)  # type: ignore[union-attr]
        overrode = where.overrode if isinstance(where, MergedValue) else ()
        yield Value(in_words(path), data, text, unit_of(type_), editable, node, default, overrode, type_, path)


def _below(where: Origin, name: Step) -> Origin:
    """The origin one step below, with the elements of overridden lists at the same position."""
    inner = step(where, name)
    if isinstance(where, MergedValue) and inner is not None and not isinstance(inner, MergedValue) and where.overrode:
        earlier = tuple(found[1] for node in where.overrode if (found := child(node, name)) is not None)
        return MergedValue(inner, None, None, earlier)
    return inner


def find(effective: Effective, steps: list[str]) -> Any:
    """The effective value at a path; None if it has none."""
    data: Any = effective.data
    for name in typed(effective.parameters.root, steps):
        try:
            data = data[name]
        except LookupError:
            return None
    return data


def type_at(root: RecordType, steps: Sequence[str]) -> Type | None:
    """The type at a path, whether or not it has a value; None if the path is unknown."""
    type_: Type | None = root
    for name in steps:
        type_ = below(type_, name)
    return type_


def typed(root: RecordType, steps: list[str]) -> list[Step]:
    """The steps of a known path, with indexes of lists as numbers."""
    types = (type_at(root, steps[:depth]) for depth in range(len(steps)))
    return [int(step) if isinstance(type_, ListType) else step for step, type_ in zip(steps, types, strict=True)]
