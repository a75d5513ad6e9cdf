"""What the JSON Schemas say about a place: keys, values, snippets and documentation. Only for editors without a
server of schemas, which says the same."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from typing import Any

from robocomp_yaml.api.completing.proposal import VALUE, Proposal
from robocomp_yaml.source.schema import schema
from robocomp_yaml.source.schema_names import MARK
from robocomp_yaml.source.yaml_text import flow

KEY, SNIPPET = "key", "snippet"
_JOINED = ("allOf", "anyOf", "oneOf")
_MOST = 40  # steps: schemas refer to themselves


def keys_at(kind: str, keys: Sequence[str], present: Sequence[str]) -> Iterator[Proposal]:
    """The keys that can stand at a path, except those that are present, and the snippets of the place."""
    for node in _at(kind, keys):
        for name, inner in node.get("properties", {}).items():
            if name not in present and isinstance(inner, dict):
                about = next(_whole(schema(kind), inner), {})
                yield Proposal(f"{name}: ", KEY, about.get("title", ""), _doc(kind, inner))
        yield from _snippets(node)


def values_at(kind: str, keys: Sequence[str]) -> Iterator[Proposal]:
    """The values that the schema lists for a place."""
    for node in _at(kind, keys):
        values = [*node.get("enum", ()), *([node["const"]] if "const" in node else [])]
        yield from (Proposal(flow(one), VALUE, node.get("title", "")) for one in values)
        if node.get("type") == "boolean":
            yield from (Proposal(one, VALUE) for one in ("true", "false"))
        yield from _snippets(node)


def about(kind: str, keys: Sequence[str]) -> str:
    """The title and the documentation of the key at the end of a path, as a server of schemas shows them; '' if the
    schema does not say more than a title."""
    nodes = list(_at(kind, keys))
    doc = next((_text_of(node) for node in nodes if _text_of(node)), "")
    title = next((str(node["title"]) for node in nodes if node.get("title")), "")
    return "\n\n".join(filter(None, (f"#### {title}" if title else "", doc))) if doc else ""


def has_names(kind: str, keys: Sequence[str]) -> bool:
    """Whether a workspace's schema has names for the value at a path."""
    return any(MARK in node for node in _at(kind, keys))


def is_list(kind: str, keys: Sequence[str]) -> bool:
    """Whether the value at a path has to be a list."""
    return any("array" in (node.get("type"), node.get("else", {}).get("type")) for node in _at(kind, keys))


def _text_of(node: dict[str, Any]) -> str:
    return str(node.get("markdownDescription") or node.get("description") or "")


def _doc(kind: str, node: dict[str, Any]) -> str:
    return next((text for one in _whole(schema(kind), node) if (text := _text_of(one))), "")


def _at(kind: str, keys: Sequence[str]) -> Iterator[dict[str, Any]]:
    """The schemas that apply to the value at a path, in which '' is an element of a list."""
    root = schema(kind)
    now = [root]
    for key in keys:
        now = [inner for node in now for whole in _whole(root, node) for inner in _inside(whole, key)]
    seen: list[dict[str, Any]] = []
    for node in now:
        for whole in _whole(root, node):
            if whole not in seen:
                seen.append(whole)
                yield whole


def _whole(root: dict[str, Any], node: Any, depth: int = 0) -> Iterator[dict[str, Any]]:
    """A schema and all that it is joined from."""
    if not isinstance(node, dict) or depth > _MOST:
        return
    yield node
    if isinstance(reference := node.get("$ref"), str):
        target: Any = root
        for step in reference.removeprefix("#/").split("/"):
            target = target.get(step, {})
        yield from _whole(root, target, depth + 1)
    for name in _JOINED:
        for part in node.get(name, ()):
            yield from _whole(root, part, depth + 1)
    yield from _whole(root, node.get("then"), depth + 1)


def _inside(node: dict[str, Any], key: str) -> Iterator[Any]:
    if not key:
        items = node.get("items")
        yield from items if isinstance(items, list) else [items]
        return
    found = node.get("properties", {}).get(key)
    if found is not None:
        yield found
        return
    for pattern, inner in node.get("patternProperties", {}).items():
        if re.search(pattern, key):
            yield inner
            return
    if isinstance(more := node.get("additionalProperties"), dict):
        yield more


def _snippets(node: dict[str, Any]) -> Iterator[Proposal]:
    for one in node.get("defaultSnippets", ()):
        if text := "\n".join(_lines(one.get("body"))):
            yield Proposal(one.get("label", text), SNIPPET, one.get("description", ""), snippet=text)


def _lines(body: Any, indent: str = "") -> Iterator[str]:
    if isinstance(body, dict):
        for key, value in body.items():
            if isinstance(value, (dict, list)):
                yield f"{indent}{key}:"
                yield from _lines(value, f"{indent}  ")
            else:
                yield f"{indent}{key}: {value if isinstance(value, str) else json.dumps(value)}".rstrip()
    elif isinstance(body, list):
        for item in body:
            first, *rest = _lines(item, f"{indent}  ")
            yield f"{indent}- {first.strip()}"
            yield from rest
    elif body is not None:
        yield f"{indent}{body if isinstance(body, str) else json.dumps(body)}"
