"""A flat config as a values document, with the locations of its lines, so that both are judged and shown alike.

Parameters are read as the component reads them. What is neither a parameter nor a connection stays a property.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.flat_configs import FlatConfig
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, LinkedValues
from robocomp_yaml.parameters.kinds import recording
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.parameters.types import RecordType
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.composite import Kind, ListKind, MapKind, RecordKind
from robocomp_yaml.semantics.plain import PlainKind
from robocomp_yaml.semantics.reading import ROBOCOMP, PropertyReader
from robocomp_yaml.semantics.references import Unresolved, unresolved
from robocomp_yaml.semantics.spellings import Spelling
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.properties import IceProperty
from robocomp_yaml.source.tree import Mapping as Tree
from robocomp_yaml.source.tree import Node, Scalar, mapping_at, scalar_at, sequence_at, text_at

Entries = dict[str, tuple[Scalar, Node]]
COMMON_BEHAVIOR = "CommonBehavior"
_SPELLED = ("Endpoints.", "Proxies.")


class _TextAt(str):
    """A text of a property, with its location."""

    key: Span = Span("")
    span: Span = Span("")


class _ReferenceAt(Unresolved):
    """A reference in a property, with its location."""

    key: Span = Span("")
    span: Span = Span("")


class FlatValues:
    """The values of a flat config, as the layer `layer`. `unread` are the properties that neither the component nor Ice
    reads, with the locations of their names; `connections` are the section and the name of each property that connects
    the component, under all of its spellings. `unknown_ports` are properties that look like these, with the kind and
    the name of the port."""

    def __init__(self, flat: FlatConfig, linked: LinkedParameters, component: LinkedComponent | None) -> None:
        self._path, self._component, self._text_of_file = flat.path, component, flat.text
        self._linked = linked
        self._entries = flat.entries
        self.connections = self._connections()
        self.unknown_ports: dict[str, tuple[str, str, Span]] = {}
        reader = self._reader()
        kind = recording(linked.parameters.root)
        texts = reader.read(kind)
        top = Span(flat.path, 1, 1, 1, 1)
        parameters = _record(kind, texts, top)
        sections, self.unread = self._sections(self._keys(reader))
        root: Entries = {"component": (text_at(top, "component"), text_at(top, ""))}
        for name, entries in (("parameters", parameters.entries), *sections.items()):
            if entries:
                root[name] = (text_at(top, name), mapping_at(top, entries))
        self.layer = LinkedValues(ValuesDocument(flat.path, mapping_at(top, root)), parameters=linked)

    def keys_of(self, record: RecordType) -> set[str]:
        """The properties with the values of a part of the parameters."""
        reader = self._reader()
        reader.read(recording(record))
        return self._keys(reader)

    def _keys(self, reader: _Reader) -> set[str]:
        """The properties that a reader has read, by their own names."""
        return {key if key in self._entries else ROBOCOMP.get(key, key) for key in reader.used}

    def _reader(self) -> _Reader:
        return _Reader({key: self._text(entry) for key, entry in self._entries.items()}, self._linked)

    def _text(self, entry: IceProperty) -> _TextAt:
        made = _TextAt(entry.value)
        made.key, made.span = self._spans(entry)
        return made

    def _spans(self, entry: IceProperty) -> tuple[Span, Span]:
        first, line, text = entry.column, entry.line, self._text_of_file
        key = Span(self._path, line, first, line, first + len(entry.key))
        written = text[entry.at : text.find("\n", entry.at) % (len(text) + 1)]
        start = entry.at - text.rfind("\n", 0, entry.at) + len(written) - len(written.lstrip())
        return key, Span(self._path, line, start, line, start + max(len(entry.value), 1))

    def _sections(self, read: set[str]) -> tuple[dict[str, Entries], dict[str, Span]]:
        """The entries of the sections of connections, and of other properties."""
        made: dict[str, Entries] = {name: {} for name in ("endpoints", "proxies", "topics", "ice", "properties")}
        unread: dict[str, Span] = {}
        for key, entry in self._entries.items():
            if key in read:
                continue
            span, where = self._spans(entry)
            other = ("ice", key.removeprefix("Ice.")) if key.startswith("Ice.") else ("properties", key)
            section, name = self.connections.get(key, other)
            text = unquoted(entry.value) if section != "properties" else entry.value
            made[section].setdefault(name, (text_at(span, name), text_at(where, text)))
            if section == "properties" and (port := self._port(key)):
                self.unknown_ports[key] = (*port, span)
            elif section == "properties" and not self._is_of_ice(key):
                unread[key] = span
        return made, unread

    def _connections(self) -> dict[str, tuple[str, str]]:
        linked, found = self._component, dict[str, tuple[str, str]]()
        found |= dict.fromkeys(connections.MANAGER, ("topics", "manager"))
        served = [port.name for port in linked.implements] if linked else []
        for name in (*served, COMMON_BEHAVIOR):
            found |= dict.fromkeys(connections.endpoints(name), ("endpoints", name))
        for port in linked.subscribes if linked else ():
            found |= dict.fromkeys(connections.topic_endpoints(port.name), ("endpoints", f"{port.name}Topic"))
        for port in linked.requires if linked else ():
            found |= dict.fromkeys(connections.proxy(port.name), ("proxies", port.name))
        return found

    @staticmethod
    def _port(key: str) -> tuple[str, str] | None:
        """What a property would connect: the kind of a port, and its name."""
        if key.startswith("Endpoints.") or key.endswith(".Endpoints"):
            return "interface", key.removeprefix("Endpoints.").removesuffix(".Endpoints")
        if key.startswith("Proxies.") and not key.endswith("Prefix"):
            return "proxy", key.removeprefix("Proxies.")
        return ("proxy", key.removesuffix("Proxy")) if key.endswith("Proxy") and "." not in key else None

    def _is_of_ice(self, key: str) -> bool:
        """Whether Ice, or the part of a component that connects it, may read a property."""
        if key.startswith((*_SPELLED, "Ice", "TopicManager")) or key.endswith((".Endpoints", "Proxy")):
            return True
        names = [port.name for port in self._component.ports] if self._component else []
        names = [*names, COMMON_BEHAVIOR]
        return any(key == name or key.startswith((f"{name}.", f"{name}Proxy.", f"{name}Topic.")) for name in names)


def flat_values(flat: FlatConfig, linked: LinkedParameters, component: LinkedComponent | None) -> FlatValues:
    """The values of a flat config, which are read once for its parameters."""
    ports = tuple(port.name for port in component.ports) if component is not None else None
    return linked.once((flat.path, flat.text, ports), lambda: FlatValues(flat, linked, component))


class _Reader(PropertyReader):
    """Keeps the locations of texts, also of those that are parts of a row."""

    def __init__(self, texts: Mapping[str, _TextAt], linked: LinkedParameters) -> None:
        spellings = {each.path: each for each in linked.parameters.spellings}
        super().__init__(texts, spellings, self._located)
        self._last: _TextAt | None = None

    def _get(self, key: str) -> str | None:
        text = super()._get(key)
        if isinstance(text, _TextAt):
            self._last = text
        return text

    def _row(self, spelling: Spelling, kind: Kind, text: str, separator: str) -> Any:
        if isinstance(text, _TextAt):
            self._last = text
        return super()._row(spelling, kind, text, separator)

    def _located(self, text: str) -> Any:
        found = unresolved(text)
        made: Any = _ReferenceAt(found.data) if isinstance(found, Unresolved) else _TextAt(found)
        if self._last is not None:
            made.key, made.span = self._last.key, self._last.span
        return made


def _record(kind: RecordKind, texts: Mapping[str, Any], top: Span) -> Tree:
    """The node of a record. `top` is the location of what has none of its own."""
    found: Entries = {}
    kinds = {member.key: member.kind for member in kind.members.values()}
    for name, value in texts.items():
        node = _node(kinds[name], value, top)
        if isinstance(kinds[name], RecordKind) and isinstance(node, Tree) and not node.entries:
            continue
        found[name] = (text_at(_key(value, top), name), node)
    return mapping_at(next((key.span for key, _ in found.values()), top), found)


def _node(kind: Kind, value: Any, top: Span) -> Node:
    if isinstance(value, _ReferenceAt):
        span = value.span
        entries = {name: (text_at(span, name), text_at(span, text)) for name, text in value.data.items()}
        return mapping_at(span, dict(entries))
    if isinstance(kind, RecordKind) and isinstance(value, dict):
        return _record(kind, value, top)
    if isinstance(kind, MapKind) and isinstance(value, dict):
        nodes = {name: (text_at(_key(one, top), name), _node(kind.element, one, top)) for name, one in value.items()}
        return mapping_at(_key(value, top), dict(nodes))
    if isinstance(kind, ListKind) and isinstance(value, list):
        return sequence_at(_key(value, top), [_node(kind.element, one, top) for one in value])
    return _plain(kind, value, top)


def _plain(kind: Kind, text: Any, top: Span) -> Node:
    """A plain value, with the data that the component makes of its text."""
    span = text.span if isinstance(text, _TextAt) else top
    made = text_at(span, str(text))
    if isinstance(kind, PlainKind):
        data = kind.read(str(text))
        if data is not None:
            made.data = data
        elif not kind.accepts_any_text:
            guess = scalar_at(span, str(text)).data
            # Only to say what it is instead: documents have more ways to write a number than components read.
            is_other = isinstance(guess, (bool, int, float)) and kind.read(str(guess)) is None
            made.data = guess if is_other else str(text)
    return made


def _key(value: Any, top: Span) -> Span:
    """The location of the first property of a value."""
    return next(_keys(value), top)


def _keys(value: Any) -> Iterator[Span]:
    if isinstance(value, (_TextAt, _ReferenceAt)):
        yield value.key
    elif isinstance(value, dict):
        for one in value.values():
            yield from _keys(one)
    elif isinstance(value, list):
        for one in value:
            yield from _keys(one)
