"""The content of a node with its locations, as plain data that can be compared."""

from __future__ import annotations

from msgspec.structs import astuple

from robocomp_yaml.source.tree import Mapping, Node, Scalar


def content(node: Node) -> tuple[object, ...]:
    """All that a node says, and where: two nodes with the same content give the same results."""
    own = node.file, astuple(node.span)
    if isinstance(node, Scalar):
        return *own, node.lexeme, node.quoted
    if isinstance(node, Mapping):
        return *own, *((content(key), content(value)) for key, value in node.items())
    return *own, None, *map(content, node.children())
