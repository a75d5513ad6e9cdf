"""Values by reference in documents: `{env: NAME}` and `{file: PATH}`, as `semantics.references` defines them.

A relative path in a document starts at the folder of the document. A written path starts at the folder of the written
file, where the component reads it.
"""

from __future__ import annotations

import os
from typing import Any

from robocomp_yaml.semantics.references import FILE, KINDS, spelled
from robocomp_yaml.source.tree import Mapping, Node


def node_is_reference(node: Node) -> bool:
    """Whether a node is a reference, valid or not."""
    return isinstance(node, Mapping) and any(kind in node.entries for kind in KINDS)


def text(data: dict[str, Any], node: Node | None, folder: str | None) -> str:
    """The reference as properties spell it. `node` is the reference in its document. `folder` is the folder of the
    written file; None if it is unknown."""
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
    """Whether a text contains a reference."""
    return any(f"${{{kind}:" in text for kind in KINDS)
