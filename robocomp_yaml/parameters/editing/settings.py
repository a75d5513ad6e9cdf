"""The properties of a values document that are no parameters, with their origin: connections, Ice, and others."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.tree import Mapping, Node, Scalar

_SECTIONS = (
    ("endpoints",), ("proxies",), ("topics", "manager"), ("topics", "prefix"), ("topics", "name"), ("ice",),
    ("properties",),
)  # fmt: skip


DEFAULT, DERIVED, SET = "default", "derived", "set"


class Setting(msgspec.Struct, frozen=True):
    """A property by Ice's spelling of its name. `section` and `name` are its keys in the document. `node` is the node
    that sets it, `overrode` are the nodes of earlier layers, the latest first."""

    section: str
    name: str
    key: str
    text: str
    node: Node
    overrode: tuple[Node, ...] = ()


def settings(values: LayeredValues) -> Iterator[Setting]:
    """The properties of a document and its layers. Null in a later layer removes one."""
    for path in _SECTIONS:
        merged: dict[str, list[Node]] = {}
        for layer in values.layers():
            for name, node in _entries(layer, path):
                if node.data is None:
                    merged.pop(name, None)
                else:
                    merged.setdefault(name, []).append(node)
        for name, nodes in merged.items():
            key, *texts = _spelled(path, name, nodes[-1]), *map(_text, reversed(nodes))
            if texts[0] is not None:
                earlier = tuple(node for node in map(_text, reversed(nodes[:-1])) if node is not None)
                yield Setting(path[0], name, key, texts[0].lexeme, texts[0], earlier)


def _entries(layer: LayeredValues, path: tuple[str, ...]) -> Iterator[tuple[str, Node]]:
    if path == ("topics", "manager"):
        topics = layer.document.section("topics")
        entry = topics.entries.get("manager") if topics is not None else None
        if entry is not None:
            yield "manager", entry[1]
        return
    section = layer.document.section(*path)
    for name, node in section.items() if section is not None else ():
        if path[0] in ("ice", "properties") or not name.lexeme.startswith("x-"):
            yield name.lexeme, node


def _spelled(path: tuple[str, ...], name: str, node: Node) -> str:
    match path:
        case ("endpoints",):
            return connections.endpoints(name)[0]
        case ("proxies",):
            key = node.get("key") if isinstance(node, Mapping) else None
            return key.lexeme if isinstance(key, Scalar) else connections.proxy(name)[0]
        case ("topics", "manager"):
            return connections.MANAGER[0]
        case ("topics", "prefix"):
            return connections.prefix(name)
        case ("ice",):
            return f"Ice.{name}"
    return name


def _text(node: Node) -> Scalar | None:
    text = node.get("proxy") if isinstance(node, Mapping) else node
    return text if isinstance(text, Scalar) else None


class OverriddenValue(msgspec.Struct, frozen=True):
    """A value that another one replaces, and its location."""

    value: str
    span: Span


class ShownSetting(msgspec.Struct, frozen=True):
    """One value of a configuration, without secrets. `key` is the path of a parameter, or the name of a
    property. `source` is SET (in the document of `span`), DERIVED (from the deployment), or DEFAULT. `overrode` are the
    replaced values, the latest first. `is_outside`: the proxy of a server that no process of the deployment is.
    `is_notable`: it is derived and replaces what the user chose, or leads outside. `data` is the value of a parameter,
    None for others."""

    key: str
    value: str
    source: str
    span: Span | None = None
    overrode: tuple[OverriddenValue, ...] = ()
    is_outside: bool = False
    is_notable: bool = False
    data: Any = None


def run_time_defaults() -> list[ShownSetting]:
    """What the run time of every component sets, unless its configuration does."""
    return [ShownSetting(key, value, DEFAULT) for key, value in connections.ICE_DEFAULTS.items()]
