"""Top-level keys of a document, read from its parsed content."""

from __future__ import annotations

from robocomp_yaml.source.text import decode, read_bytes
from robocomp_yaml.source.tree import Mapping, Node, Scalar, parse

COMPONENT = "component"


def text_at_top(root: Node | None, key: str) -> str:
    """The text at a top-level key of a document; '' if absent."""
    node = root.get(key) if isinstance(root, Mapping) else None
    return node.lexeme if isinstance(node, Scalar) else ""


def root_of(path: str) -> Node | None:
    """The tree of the file at a path; None if it cannot be read as YAML."""
    raw, _ = read_bytes(path)
    text = decode(path, raw)[0] if raw is not None else None
    return parse(path, text)[0] if text is not None else None


def component_in(path: str) -> str:
    """The value of `component:` in the file at a path; '' if it is absent or the file cannot be read."""
    return text_at_top(root_of(path), COMPONENT)
