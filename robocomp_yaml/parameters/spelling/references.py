"""Values by reference: `{env: NAME}` and `{file: PATH}`, which are read when a component starts, where it runs.

In properties they are `${env:NAME}` and `${file:PATH}`. A relative path is one from the folder of the document that
gives it; what is written says it from the folder of the file that is written, from which the component takes it.
"""

from __future__ import annotations

import os
import re
from typing import Any

from robocomp_yaml.source.tree import Mapping, Node, Sequence

ENV, FILE = "env", "file"
KINDS = (ENV, FILE)
_VARIABLE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_TEXT = re.compile(r"\$\{(?:env:([A-Za-z_][A-Za-z0-9_]*)|file:([^\r\n\0]+))\}\Z")


def is_reference(data: object) -> bool:
    """Whether plain data, where a plain value is expected, refers to one that is not known yet."""
    return isinstance(data, dict) and len(data) == 1 and next(iter(data)) in KINDS


def is_sound(data: object) -> bool:
    """Whether it is a reference that can be followed."""
    if not isinstance(data, dict) or not is_reference(data):
        return False
    kind, name = next(iter(data.items()))
    return isinstance(name, str) and not problem(kind, name)


def problem(kind: str, name: object) -> str:
    """What is wrong with the name or path of a reference, or ''."""
    if kind == ENV:
        good = isinstance(name, str) and _VARIABLE.match(name)
        return "" if good else "names no variable of the environment"
    if not isinstance(name, str) or not name or name[-1] in " \t/":
        return "names no file"
    return "has a path that no file has" if any(char in name for char in "\r\n\0") else ""


def node_is_reference(node: Node) -> bool:
    """Whether a node is meant as one, sound or not."""
    return isinstance(node, Mapping) and any(kind in node.entries for kind in KINDS)


def has_reference(node: Node) -> bool:
    """Whether a reference stands anywhere below."""
    if isinstance(node, Mapping):
        return is_reference(node.data) or any(has_reference(value) for _, value in node.items())
    return isinstance(node, Sequence) and any(map(has_reference, node.items))


def text(data: dict[str, Any], node: Node | None, folder: str | None) -> str:
    """The reference as properties have it. `node` stands in the document that gives it, `folder` is that of the file
    that is written, None for one that may be put anywhere."""
    kind, name = next(iter(data.items()))
    return f"${{{kind}:{_path(name, node, folder) if kind == FILE else name}}}"


def _path(path: str, node: Node | None, folder: str | None) -> str:
    if path.startswith(("/", "~/")) or node is None:
        return path
    whole = os.path.join(os.path.dirname(os.path.abspath(node.file)), path)
    if folder is None:
        return os.path.normpath(whole)
    written = os.path.abspath(folder)
    return path if written == os.path.dirname(os.path.abspath(node.file)) else os.path.relpath(whole, written)


def read(text: str) -> dict[str, str] | None:
    """The reference that the text of a property is, or None."""
    found = _TEXT.match(text) if text.startswith("${") else None
    if found is None:
        return None
    return {ENV: found[1]} if found[1] else {FILE: found[2]}


def in_text(text: str) -> bool:
    """Whether a reference stands anywhere in the text."""
    return "${env:" in text or "${file:" in text
