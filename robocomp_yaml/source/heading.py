"""What a document says at its top, by its parsed content: the one place where that is known, however it is written."""

from __future__ import annotations

from robocomp_yaml.source.text import decode, read_bytes
from robocomp_yaml.source.tree import Mapping, Node, Scalar, parse

COMPONENT = "component"


def text_at_top(root: Node | None, key: str) -> str:
    """The text of a key of the document's own mapping; '' where there is none."""
    node = root.get(key) if isinstance(root, Mapping) else None
    return node.lexeme if isinstance(node, Scalar) else ""


def root_of(path: str) -> Node | None:
    """The tree of the file at a path; None where it cannot be read as YAML."""
    raw, _ = read_bytes(path)
    text = decode(path, raw)[0] if raw is not None else None
    return parse(path, text)[0] if text is not None else None


def component_in(path: str) -> str:
    """What `component:` says in the file at a path; '' where it says nothing, or cannot be read."""
    return text_at_top(root_of(path), COMPONENT)
