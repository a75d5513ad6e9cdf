"""The parameters of a running component, which CommonBehavior shows and changes. Nothing is written."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import msgspec

from robocomp_yaml.api.addresses import Addresses
from robocomp_yaml.api.calling import TIMEOUT, MethodCalls, RemoteMethod, Reply
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.api.values import VALUE, Change, Values, accepted, spells_text
from robocomp_yaml.diag.errors import NoAnswer, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.configuration_base import base_of, base_of_component
from robocomp_yaml.parameters.editing import show
from robocomp_yaml.parameters.types import (
    BasicType,
    ListType,
    MapType,
    RecordType,
    Type,
    is_secret,
    leaves,
    unit_of,
)
from robocomp_yaml.semantics import paths, secrecy, texts
from robocomp_yaml.semantics.paths import Path, Step, dotted, in_words
from robocomp_yaml.semantics.secrecy import HIDDEN
from robocomp_yaml.source.tree import Mapping as Tree
from robocomp_yaml.source.tree import Node, mapping_at, scalar_at, text_at
from robocomp_yaml.source.yaml_text import flow

_LOGGED = "(see the log of the component) "
_ROUNDING = 1e-6  # relative: what a `float` changes in a number


class RunningValue(msgspec.Struct, frozen=True):
    """A plain value of a running component, or an empty list or map. Secrets are hidden."""

    path: str
    data: Any
    type: str
    unit: str = ""
    editable: bool = False


class Listed(msgspec.Struct, frozen=True):
    """One entry of CommonBehavior's list."""

    text: str
    type: str
    editable: bool


class RunningParameters:
    """The parameters of somebody with CommonBehavior: `name` is an entry, a component, or the HOST:PORT of its
    CommonBehavior. Raises Refused."""

    def __init__(self, addresses: Addresses, name: str) -> None:
        self.addresses = addresses
        peer = addresses.peer(name)
        if peer.rest:
            raise Refused(f"'{name}' has more than the name of a component; write {peer.name}")
        self.name, self._peer = peer.name, peer
        component = peer.component
        linked = component.parameters if component is not None else None
        self.root: RecordType | None = linked.parameters.root if linked is not None and not linked.broken else None

    @contextmanager
    def connected(self, config: str = "", timeout: float = TIMEOUT) -> Iterator[Session]:
        """A connection to the component while the context lasts."""
        behavior = f"{self.name}.CommonBehavior"
        get = RemoteMethod(self.addresses, f"{behavior}.getParameterList")
        put = RemoteMethod(self.addresses, f"{behavior}.setParameterList")
        with get.connected(config, timeout) as calls:
            yield Session(self, calls, MethodCalls(put, calls.client, timeout))

    def _steps(self, path: str, known: Mapping[str, Listed]) -> tuple[list[str], Type | None]:
        """The steps of a path, and its type; None if only the component knows it. Raises Refused."""
        steps = paths.parse(path)
        type_ = show.type_at(self.root, steps) if self.root is not None and steps else None
        if type_ is None and (not steps or dotted(steps) not in known):
            names = [row.path for row in values(self.root, known)]
            groups = [name for name, _ in leaves(self.root, groups=True)] if self.root is not None else []
            raise Refused(f"{self.name} has no parameter '{path}'{meant(path, [*names, *groups])}")
        return steps, type_

    def saving(self, path: str, value: str) -> Change:
        """The change of the values document with which the component starts. Raises Refused and Faulty."""
        from robocomp_yaml.api import which

        instance, component = self._peer.instance, self._peer.component
        if component is None:
            raise Refused(f"{self.name} is not a component of these documents: there is no document to write")
        settings = instance.entry.settings if instance is not None else None
        if settings is not None and (node := _set_in(settings, paths.parse(path))) is not None:
            where = f"{node.span.file}:{node.span.line}"
            raise Refused(f"{where} sets {path} for {self.name}: change it there, or leave --save out")
        program = self.addresses.program
        base = base_of(instance, program.disk) if instance is not None else base_of_component(component, program)
        if base.flat is not None:
            raise Refused(f"{self.name} starts with {base.flat.path}, which is not a values document: change it there")
        own = base.values.document.path if base.values is not None else which.values(component.component.path)
        document = Values(own)
        if kept := document.kept_reference(path, value):
            raise Refused(f"{kept}: change it there, or leave --save out")
        return document.set(path, value)


class Session:
    """A connection to a running component."""

    def __init__(self, parameters: RunningParameters, getting: MethodCalls, setting: MethodCalls) -> None:
        self._of, self._get, self._put = parameters, getting, setting

    def listed(self) -> dict[str, Listed]:
        """The component's own list, by dotted paths. Raises NoAnswer."""
        found = _returned(self._of.name, self._get.call(()))
        return {key: Listed(one["value"], one["type"], one["editable"]) for key, one in sorted(found.items())}

    def values(self) -> list[RunningValue]:
        """All values: those of the parameters in the order of their document, then what else the component lists."""
        return values(self._of.root, self.listed())

    def get(self, path: str) -> Any:
        """The value at a path, as data: also of a group, a list or a record. Raises Refused and NoAnswer."""
        listed = self.listed()
        steps, type_ = self._of._steps(path, listed)
        if type_ is None:
            return next(one.data for one in values(None, listed) if one.path == dotted(steps))
        assert self._of.root is not None
        return _data(type_, tuple(show.typed(self._of.root, steps)), listed)

    def set(self, path: str, value: str) -> tuple[Any, Any]:
        """Changes a value in the running component, until it ends. Returns the value before, and now. Raises Refused,
        Faulty if the type or the limits reject the value, and NoAnswer if the component does."""
        listed = self.listed()
        steps, type_ = self._of._steps(path, listed)
        before = self.get(path)
        changes = self._changes(path, steps, type_, value, listed)
        for key in changes:
            if key in listed and not listed[key].editable:
                hint = "`editable: true` in its parameters allows it; `rcyaml config set` changes it for the next start"
                raise NoAnswer(f"{path} of {self._of.name} cannot be changed while it runs: it is not editable", hint)
        types = {key: listed[key].type if key in listed else "string" for key in changes}
        root = _arguments({key: (text, types[key]) for key, text in changes.items()})
        arguments = self._put.method.operation.arguments(root, lambda fault: None)
        _returned(self._of.name, self._put.call(arguments))
        self._verify(path, changes, self.listed())
        return before, self.get(path)

    def _changes(
        self, path: str, steps: list[str], type_: Type | None, value: str, listed: Mapping[str, Listed]
    ) -> dict[str, str]:
        """The texts to set, by dotted paths."""
        if type_ is None:
            known = listed[dotted(steps)].type
            if _read(known, value) is None:
                raise Refused(f"{path} must be {known}, but is '{value}'")
            return {dotted(steps): value}
        root = self._of.root
        assert root is not None
        if value == "null":
            raise Refused("`null` returns to the default in a document; a running component needs the value itself")
        typed = tuple(show.typed(root, steps))
        node = accepted(type_, typed, value, is_text=spells_text(type_, value), complete=True)
        return dict(_flat(type_, node.data, typed))

    def _verify(self, path: str, changes: Mapping[str, str], after: Mapping[str, Listed]) -> None:
        """Raises NoAnswer if the component did not take the values. A secret cannot be compared."""
        for key, text in changes.items():
            entry = after.get(key)
            if entry is not None and entry.text != HIDDEN and not _same(entry.type, entry.text, text):
                hint = "its log has the reason, such as a constraint between parameters"
                raise NoAnswer(f"{self._of.name} rejected {path} = {text}", hint)


def _arguments(changes: Mapping[str, tuple[str, str]]) -> Tree:
    """The arguments of setParameterList: texts and types by dotted paths."""
    span = Span(VALUE)

    def mapping(entries: Mapping[str, Node]) -> Tree:
        return mapping_at(span, {key: (text_at(span, key), node) for key, node in entries.items()})

    return mapping({"l": mapping({
        key: mapping({"editable": scalar_at(span, "true"), "value": text_at(span, text), "type": text_at(span, type_)})
        for key, (text, type_) in changes.items()
    })})  # fmt: skip


def in_line(data: Any) -> str:
    """A value as text in one line."""
    return HIDDEN if data == HIDDEN else flow(data)


def _returned(name: str, reply: Reply) -> Any:
    if reply.throws:
        why = str(reply.members.get("unknown", "")).removeprefix(_LOGGED)
        raise NoAnswer(f"{name}: {why}" if why else f"CommonBehavior of {name} raised {reply.throws}")
    return reply.returns


def _read(type_: str, text: str) -> Any:
    return text if text == HIDDEN else texts.read(type_, text)


def _same(type_: str, left: str, right: str) -> bool:
    first, second = texts.read(type_, left), texts.read(type_, right)
    if isinstance(first, float) and isinstance(second, (int, float)):
        return math.isclose(first, second, rel_tol=_ROUNDING)
    return first == second


def values(root: RecordType | None, listed: Mapping[str, Listed]) -> list[RunningValue]:
    """The values of a list of CommonBehavior. `root` is None if no document defines the parameters."""
    used = set[str]()
    rows = list(_rows(root, (), listed, used)) if root is not None else []
    for key, entry in listed.items():
        if key not in used:
            data = _read(entry.type, entry.text)
            shown = data if not isinstance(data, str) else secrecy.shown(key.rpartition(".")[2], data)
            rows.append(RunningValue(key, shown, entry.type, editable=entry.editable))
    return rows


def _rows(type_: Type, path: Path, listed: Mapping[str, Listed], used: set[str]) -> Iterator[RunningValue]:
    key = dotted(path)
    if isinstance(type_, RecordType):
        for member in type_.members:
            yield from _rows(member.type, (*path, member.name), listed, used)
    elif isinstance(type_, (ListType, MapType)):
        sizes = f"{key}.{'size' if isinstance(type_, ListType) else 'keys'}"
        used.add(sizes)
        names = _names(type_, key, listed)
        for name in names:
            yield from _rows(type_.element, (*path, name), listed, used)
        if not names and sizes in listed:
            empty: Any = [] if isinstance(type_, ListType) else {}
            yield RunningValue(in_words(path), empty, "", editable=listed[sizes].editable)
    elif key in listed:
        used.add(key)
        data = _shown(type_, path, listed[key].text)
        yield RunningValue(in_words(path), data, type_.name, unit_of(type_), listed[key].editable)


def _names(type_: ListType | MapType, key: str, listed: Mapping[str, Listed]) -> list[Step]:
    if isinstance(type_, ListType):
        entry = listed.get(f"{key}.size")
        return list(range(texts.count(entry.text, 1_000_000) or 0)) if entry else []
    entry = listed.get(f"{key}.keys")
    return [paths.unescaped(name) for name in entry.text.split()] if entry else []


def _data(type_: Type, path: Path, listed: Mapping[str, Listed]) -> Any:
    """The values at a path; None if there is none."""
    key = dotted(path)
    if isinstance(type_, RecordType):
        inner = {member.name: _data(member.type, (*path, member.name), listed) for member in type_.members}
        return {name: value for name, value in inner.items() if value is not None}
    if isinstance(type_, ListType):
        return [_data(type_.element, (*path, name), listed) for name in _names(type_, key, listed)]
    if isinstance(type_, MapType):
        return {str(name): _data(type_.element, (*path, name), listed) for name in _names(type_, key, listed)}
    return _shown(type_, path, listed[key].text) if key in listed else None


def _shown(type_: Type, path: Path, text: str) -> Any:
    """A plain value as it may be shown, also by a component that does not hide its secrets."""
    if is_secret(type_):
        return HIDDEN if text else text
    data = _read(type_.name, text) if isinstance(type_, BasicType) else text
    name = path[-1]
    return secrecy.shown(name if isinstance(name, str) else "", data) if isinstance(data, str) else data


def _flat(type_: Type, data: Any, path: Path) -> Iterator[tuple[str, str]]:
    """Data as texts by dotted paths, as CommonBehavior lists them. What a record omits has its default."""
    if isinstance(type_, RecordType):
        for member in type_.members:
            default = member.default.data if member.default is not None else None
            value = data.get(member.name, default)
            if value is not None:
                yield from _flat(member.type, value, (*path, member.name))
    elif isinstance(type_, ListType):
        yield f"{dotted(path)}.size", str(len(data))
        for at, item in enumerate(data):
            yield from _flat(type_.element, item, (*path, at))
    elif isinstance(type_, MapType):
        yield f"{dotted(path)}.keys", " ".join(paths.escaped(name) for name in data)
        for name, item in data.items():
            yield from _flat(type_.element, item, (*path, name))
    else:
        yield dotted(path), texts.spelled(data)


def _set_in(settings: Tree, steps: list[str]) -> Node | None:
    """Where `set:` of a deployment sets a value at a path, above it or below it."""
    for key, value in settings.items():
        own = paths.parse(key.lexeme)
        if own[: len(steps)] == steps[: len(own)]:
            return value if value.span.file else key
    return None
