"""The comments of a document, which a parsed tree does not have."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.source.tree import Mapping, Node, Scalar, below

_COMMENT = re.compile(r"(?:(?<=[ \t\r\n])|(?<=\A)|(?<=\ufeff))#[^\r\n]*")


def comments(text: str, root: Node) -> Iterator[tuple[int, str]]:
    """The comments of a document, each with its index."""
    possible = list(_COMMENT.finditer(text))
    texts = sorted((one.start, one.end) for one in _scalars(root)) if possible else []
    at = 0
    for found in possible:
        while at < len(texts) and texts[at][1] <= found.start():
            at += 1
        if at == len(texts) or not texts[at][0] <= found.start() < texts[at][1]:
            yield found.start(), found[0].rstrip()


def _scalars(root: Node) -> Iterator[Scalar]:
    for node in below(root):
        if isinstance(node, Scalar):
            yield node
        elif isinstance(node, Mapping):
            yield from (key for key, _ in node.items())
