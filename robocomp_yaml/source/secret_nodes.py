"""Secrets in a document whose types are unknown: the names of keys decide."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from robocomp_yaml import secrets
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.references import is_sound
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


def named_nodes(node: Node, names: Collection[str] = ()) -> Iterator[Scalar]:
    """Every plain value below a key that has the name of a secret, or is one of `names`."""
    if isinstance(node, Mapping) and not is_sound(node.data):
        for key, value in node.items():
            yield from plain_below(value) if is_named(key, names) else named_nodes(value, names)
    elif isinstance(node, Sequence):
        for item in node.items:
            yield from named_nodes(item, names)


def is_named(key: Scalar, names: Collection[str]) -> bool:
    """Whether a key, or the last step of its path, is the name of a secret."""
    last = (paths.parse(key.lexeme) or [key.lexeme])[-1] if names else ""
    return secrets.is_secret(key.lexeme) or last in names


def plain_below(node: Node) -> Iterator[Scalar]:
    """Every plain value in a node, without references."""
    if isinstance(node, Scalar):
        if node.data is not None and node.data != "":
            yield node
    elif isinstance(node, Mapping):
        if not is_sound(node.data):
            for _, value in node.items():
                yield from plain_below(value)
    elif isinstance(node, Sequence):
        for item in node.items:
            yield from plain_below(item)
