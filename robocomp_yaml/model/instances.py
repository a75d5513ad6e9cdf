"""An entry of a deployment as one of its instances: `{i}` is the instance's number, in every text."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import TypeVar

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
    elif is_dataclass(part) and not isinstance(part, type | Span):
        filled = replace(part, **{f.name: _filled(getattr(part, f.name), number) for f in fields(part)})
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
