"""An entry of a deployment as one of its instances: `{i}` is the instance's number, in every text."""

from __future__ import annotations

from typing import TypeVar

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import INDEX, Entry
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, mapping_at, sequence_at, text_at

Part = TypeVar("Part")


def instance(entry: Entry, number: int) -> Entry:
    """The entry's texts as its instance has them; ports are as written."""
    return _filled(entry, str(number))


def _filled(part: Part, number: str) -> Part:
    filled: object = part
    if isinstance(part, str):
        filled = part.replace(INDEX, number)
    elif isinstance(part, tuple):
        filled = tuple(_filled(item, number) for item in part)
    elif isinstance(part, Node):
        filled = _tree(part, number)
    elif isinstance(part, msgspec.Struct) and not isinstance(part, Span):
        filled = replace(part, **{name: _filled(getattr(part, name), number) for name in part.__struct_fields__})
    return filled  # type: ignore[return-value]


def _tree(node: Node, number: str) -> Node:
    """In values `{i}` without quotes, which YAML reads as a mapping, is the number itself."""
    if isinstance(node, Mapping):
        if node.data == {"i": None} and node.is_flow:
            counted = text_at(node.span, number)
            counted.data = int(number)
            return counted
        entries = {}
        for name, value in node.items():
            key = name.lexeme.replace(INDEX, number)
            entries[key] = text_at(name.span, key), _tree(value, number)
        return mapping_at(node.span, entries)
    if isinstance(node, Sequence):
        return sequence_at(node.span, [_tree(item, number) for item in node.items])
    assert isinstance(node, Scalar)
    return text_at(node.span, node.lexeme.replace(INDEX, number)) if INDEX in node.lexeme else node
