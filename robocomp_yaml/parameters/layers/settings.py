"""The properties of a values document that are no parameters, over all its layers: connections, Ice, and others."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.tree import Mapping, Node, Scalar

_OF_PORTS = ("endpoints", "proxies", "topics")
MANAGER, PREFIX = ("topics", "manager"), ("topics", "prefix")
_SECTIONS = (("endpoints",), ("proxies",), MANAGER, PREFIX, ("topics", "name"), ("ice",), ("properties",))


class Setting(msgspec.Struct, frozen=True):
    """A property by the spelling of its name in a dialect. `path` and `name` are its keys in the document. `node` is
    the node that sets it, `overrode` are the nodes of earlier layers, the latest first."""

    path: tuple[str, ...]
    name: str
    key: str
    node: Scalar
    overrode: tuple[Scalar, ...] = ()

    @property
    def section(self) -> str:
        return self.path[0]


def settings(values: LayeredValues, *, in_toml: bool = False) -> Iterator[Setting]:
    """The properties of a document and its layers, by Ice's names, or by those of RoboComp's TOML."""
    for path in _SECTIONS:
        is_manager = path == MANAGER
        for name, nodes in _merged(values, path[:1] if is_manager else path).items():
            if is_manager and name != "manager":
                continue
            text, *earlier = map(_text, reversed(nodes))
            if text is not None:
                overrode = tuple(node for node in earlier if node is not None)
                yield Setting(path, name, _key(path, name, nodes[-1], in_toml), text, overrode)


def merged_entries(values: LayeredValues, *keys: str) -> dict[str, Node]:
    """The entries of a section over all layers: later layers replace entries, and null removes them. In sections of
    ports, names that begin with `x-` are extensions of the user, and are skipped."""
    return {name: nodes[-1] for name, nodes in _merged(values, keys).items()}


def _merged(values: LayeredValues, keys: tuple[str, ...]) -> dict[str, list[Node]]:
    """The same, with the nodes of all layers that count, the most general first."""
    merged: dict[str, list[Node]] = {}
    for layer in values.layers():
        section = layer.document.section(*keys)
        for key, node in section.items() if section is not None else ():
            if keys[0] in _OF_PORTS and key.lexeme.startswith("x-"):
                continue
            if node.data is None:
                merged.pop(key.lexeme, None)
            else:
                merged.setdefault(key.lexeme, []).append(node)
    return merged


def _key(path: tuple[str, ...], name: str, node: Node, in_toml: bool) -> str:
    match path:
        case ("endpoints",):
            return connections.endpoints(name)[in_toml]
        case ("proxies",):
            key = node.get("key") if isinstance(node, Mapping) else None
            return key.lexeme if isinstance(key, Scalar) else connections.proxy(name)[in_toml]
        case ("topics", "manager"):
            return connections.MANAGER[in_toml]
        case ("topics", "prefix"):
            return connections.prefix(name)
        case ("ice",):
            return f"Ice.{name}"
    return name


def _text(node: Node) -> Scalar | None:
    text = node.get("proxy") if isinstance(node, Mapping) else node
    return text if isinstance(text, Scalar) else None
