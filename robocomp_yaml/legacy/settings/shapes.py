"""Shapes of values: the smallest type that all values of a parameter fit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.legacy.document import List, Map, Raw, Value
from robocomp_yaml.legacy.settings.entries import DOUBLE, FLOAT, INT, LONG, STRING, Leaf, Tree

_NUMBERS = (INT, LONG, FLOAT, DOUBLE)


class ScalarShape(msgspec.Struct, frozen=True):
    kind: str


class ListShape(msgspec.Struct, frozen=True):
    element: Shape


class MemberShape(msgspec.Struct, frozen=True):
    name: str
    shape: Shape
    optional: bool = False


class RecordShape(msgspec.Struct, frozen=True):
    fields: tuple[MemberShape, ...]


Shape = ScalarShape | ListShape | RecordShape


def least(kinds: Iterable[str]) -> str:
    """Return the smallest type of plain values: numbers widen, other combinations are text."""
    known = set(kinds)
    if len(known) == 1:
        return known.pop()
    if not known or not known <= set(_NUMBERS):
        return STRING
    return DOUBLE if {LONG, FLOAT} <= known else max(known, key=_NUMBERS.index)


def shape_of(trees: Sequence[Tree]) -> Shape | None:
    """Return the common shape of values; None where only some are lists or records."""
    if all(isinstance(tree, Leaf) for tree in trees):
        return ScalarShape(least(tree.kind for tree in trees if isinstance(tree, Leaf)))
    if all(isinstance(tree, list) for tree in trees):
        inner = [item.value for tree in trees if isinstance(tree, list) for item in tree]
        element = shape_of(inner)
        return ListShape(element) if element is not None else None
    records = [tree for tree in trees if isinstance(tree, dict)]
    if len(records) < len(trees):
        return None
    fields = []
    for name in dict.fromkeys(name for record in records for name in record):
        values = [record[name].value for record in records if name in record]
        shape = shape_of(values)
        if shape is None:
            return None
        fields.append(MemberShape(name, shape, len(values) < len(records)))
    return RecordShape(tuple(fields)) if fields else None


def retyped(shape: Shape, path: str, types: Mapping[str, str]) -> Shape:
    """Return a shape with the wider types that the user requests, by path: `Motors.zero`."""
    if isinstance(shape, ListShape):
        return ListShape(retyped(shape.element, path, types))
    if isinstance(shape, RecordShape):
        return RecordShape(tuple(replace(f, shape=retyped(f.shape, f"{path}.{f.name}", types)) for f in shape.fields))
    requested = types.get(path)
    return ScalarShape(requested) if requested is not None and least((requested, shape.kind)) == requested else shape


def written(shape: Shape, tree: Tree) -> Value:
    """Return a value for a document, by the type of its parameter."""
    if isinstance(tree, Leaf):
        return plain(tree, shape.kind if isinstance(shape, ScalarShape) else STRING)
    if isinstance(tree, list):
        assert isinstance(shape, ListShape)
        listed = List(block=isinstance(shape.element, RecordShape))
        for item in tree:
            listed.put(written(shape.element, item.value), item.notes)
        return listed
    assert isinstance(shape, RecordShape)
    shapes = {field.name: field.shape for field in shape.fields}
    body = Map()
    for name, item in tree.items():
        body.put(name, written(shapes[name], item.value), item.notes)
    return body


def plain(leaf: Leaf, kind: str) -> Value:
    return leaf.text if kind == STRING else Raw(leaf.text)


def becomes_text(shape: Shape, tree: Tree) -> bool:
    """Whether a value has a number or boolean where its parameter has text, so that it becomes text."""
    if isinstance(tree, Leaf):
        return shape == ScalarShape(STRING) and tree.kind != STRING
    if isinstance(tree, list):
        return isinstance(shape, ListShape) and any(becomes_text(shape.element, item.value) for item in tree)
    shapes = {field.name: field.shape for field in shape.fields} if isinstance(shape, RecordShape) else {}
    return any(name in shapes and becomes_text(shapes[name], item.value) for name, item in tree.items())


def leaves(tree: Tree) -> list[Leaf]:
    if isinstance(tree, Leaf):
        return [tree]
    items = tree if isinstance(tree, list) else tree.values()
    return [leaf for item in items for leaf in leaves(item.value)]
