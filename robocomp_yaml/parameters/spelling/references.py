"""Values by reference in documents: `{env: NAME}` and `{file: PATH}`; `semantics.references` says what is one.

A relative path is one from the folder of the document that gives it; what is written says it from the folder of the
file that is written, from which the component takes it.
"""

from __future__ import annotations

import os
from typing import Any

from robocomp_yaml.semantics.references import FILE, KINDS, spelled
from robocomp_yaml.source.tree import Mapping, Node


def node_is_reference(node: Node) -> bool:
    """Whether a node is meant as one, sound or not."""
    return isinstance(node, Mapping) and any(kind in node.entries for kind in KINDS)


def text(data: dict[str, Any], node: Node | None, folder: str | None) -> str:
    """The reference as properties have it. `node` stands in the document that gives it, `folder` is that of the file
    that is written, None for one that may be put anywhere."""
    kind, name = next(iter(data.items()))
    return spelled(kind, _path(name, node, folder) if kind == FILE else name)


def _path(path: str, node: Node | None, folder: str | None) -> str:
    if path.startswith(("/", "~/")) or node is None:
        return path
    whole = os.path.join(os.path.dirname(os.path.abspath(node.file)), path)
    if folder is None:
        return os.path.normpath(whole)
    written = os.path.abspath(folder)
    return path if written == os.path.dirname(os.path.abspath(node.file)) else os.path.relpath(whole, written)


def in_text(text: str) -> bool:
    """Whether a reference stands anywhere in the text."""
    return any(f"${{{kind}:" in text for kind in KINDS)
