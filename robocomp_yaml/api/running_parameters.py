"""The parameters of a running component, which CommonBehavior shows and changes. Nothing is written."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from robocomp_yaml.api.addresses import Addresses
from robocomp_yaml.api.calling import TIMEOUT, MethodCalls, RemoteMethod, Reply
from robocomp_yaml.api.listed_values import (
    Listed,
    RunningValue,
    data_at,
    flat,
    missing_at,
    names_in,
    read,
    same,
    values,
    with_value,
    without_hidden,
)
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.api.values import VALUE, Change, Values, accepted, spells_text
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.errors import Faulty, NoAnswer, Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.network.configuration_base import base_of, base_of_component
from robocomp_yaml.parameters.editing import show
from robocomp_yaml.parameters.hidden import holds_secret
from robocomp_yaml.parameters.layers.effective import broken_constraints
from robocomp_yaml.parameters.types import ListType, MapType, Parameters, RecordType, Type, leaves
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Path, dotted, in_words
from robocomp_yaml.semantics.secrecy import HIDDEN
from robocomp_yaml.source.tree import Mapping as Tree
from robocomp_yaml.source.tree import Node, mapping_at, scalar_at, text_at
from robocomp_yaml.source.yaml_text import flow

_LOGGED = "(see the log of the component) "
_MOST = 8  # names in a message


class RunningParameters:
    """The parameters of somebody with CommonBehavior: `name` is an entry, a component, or the HOST:PORT of its
    CommonBehavior. Raises Refused."""

    def __init__(self, addresses: Addresses, name: str) -> None:
        self.addresses = addresses
        peer = addresses.peer(name)
        if peer.rest:
            raise Refused(f"'{name}' has more than the name of a component; write {peer.name}")
        self.name, self._peer = peer.name, peer
        linked = peer.component.parameters if peer.component is not None else None
        self.defined: Parameters | None = linked.parameters if linked is not None and not linked.broken else None
        self.root: RecordType | None = self.defined.root if self.defined is not None else None

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
            listed = f"known are {some(names, _MOST)}" if names else ""
            raise Refused(f"{self.name} has no parameter '{path}'{meant(path, [*names, *groups], listed)}")
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
            folder = os.path.dirname(component.component.path)
            path_of_own = os.path.join(folder, which.VALUES)
            if os.path.isfile(path_of_own) and has_errors((broken := Values(path_of_own)).diagnostics):
                raise Faulty(broken.diagnostics, broken.documents_read)
            change_it = f"change it there, or write one with `{typed('rcyaml', 'config', 'new', folder or os.curdir)}`"
            raise Refused(f"{self.name} starts with {base.flat.path}, which is not a values document: {change_it}")
        if base.values is None and instance is not None and instance.entry.config is not None:
            raise Faulty(self.addresses.analysis.diagnostics, program.documents)  # the document that it names
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
        """The value at a path, as data: also of a group, a list or a record; None if it has none. Raises Refused and
        NoAnswer."""
        listed = self.listed()
        steps, type_ = self._of._steps(path, listed)
        if type_ is None:
            return next(one.data for one in values(None, listed) if one.path == dotted(steps))
        root = self._of.root
        assert root is not None
        is_there = missing_at(root, steps, listed) is None
        return data_at(type_, tuple(show.typed(root, steps)), listed) if is_there else None

    def set(self, path: str, value: str) -> tuple[Any, Any]:
        """Changes a value in the running component, until it ends. Returns the value before, and now. Raises Refused,
        Faulty if the type or the limits reject the value, and NoAnswer if the component does."""
        listed = self.listed()
        steps, type_ = self._of._steps(path, listed)
        before = self.get(path)
        changes = self._changes(path, steps, type_, value, listed)
        for key in changes:
            if key in listed and not listed[key].editable:
                hint = "it is a property of Ice, which the component reads when it starts"
                if type_ is not None:
                    hint = "`editable: true` in its parameters allows it; `rcyaml config set` sets it for the start"
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
            if read(known, value) is None:
                raise Refused(f"{path} must be {known}, but is '{value}'")
            return {dotted(steps): value}
        root = self._of.root
        assert root is not None
        if value == "null":
            raise Refused("`null` returns to the default in a document; a running component needs the value itself")
        where = tuple(show.typed(root, steps))
        node = accepted(type_, where, value, is_text=spells_text(type_, value), complete=True)
        grown = self._grown(root, steps, listed, node.data)
        self._reject_broken(root, where, node.data, value, listed)
        return {**grown, **dict(flat(type_, node.data, where))}

    def _grown(self, root: RecordType, steps: list[str], listed: Mapping[str, Listed], data: Any) -> dict[str, str]:
        """The new size of a list, or the new keys of a map, if the value is a further element of it. Raises Refused if
        it is in an element that does not exist, and Faulty if there may be no further one."""
        depth = missing_at(root, steps, listed)
        if depth is None:
            return {}
        above = steps[:depth]
        owner, where = show.type_at(root, above), tuple(show.typed(root, above))
        assert isinstance(owner, (ListType, MapType))
        key, names = dotted(where), names_in(owner, dotted(where), listed)
        if depth + 1 < len(steps) or (isinstance(owner, ListType) and int(steps[depth]) != len(names)):
            has = f"{len(names)} element{'' if len(names) == 1 else 's'}"
            has = has if isinstance(owner, ListType) else f"no element '{steps[depth]}', which can be set as a whole"
            what = in_words(show.typed(root, steps))
            raise Refused(f"{self._of.name} cannot set {what}: {in_words(where)} has {has}")
        if not holds_secret(owner):
            whole = data_at(owner, where, listed)
            whole = [*whole, data] if isinstance(owner, ListType) else {**whole, steps[depth]: data}
            accepted(owner, where, flow(whole), is_text=False, complete=True)
        if isinstance(owner, ListType):
            return {f"{key}.size": str(len(names) + 1)}
        return {f"{key}.keys": " ".join(paths.escaped(name) for name in (*map(str, names), steps[depth]))}

    def _reject_broken(self, root: RecordType, path: Path, data: Any, value: str, listed: Mapping[str, Listed]) -> None:
        """Raises Faulty if a constraint between parameters would not hold. Secrets are unknown in it."""
        assert self._of.defined is not None
        whole = with_value(without_hidden(data_at(root, (), listed)), path, data)
        span = Span(VALUE, 1, 1, 1, len(value) + 1)
        if faults := list(broken_constraints(self._of.defined, whole, None, span)):
            raise Faulty(faults, None, {VALUE: value})

    def _verify(self, path: str, changes: Mapping[str, str], after: Mapping[str, Listed]) -> None:
        """Raises NoAnswer if the component did not take the values. A secret cannot be compared."""
        for key, text in changes.items():
            entry = after.get(key)
            if entry is not None and entry.text != HIDDEN and not same(entry.type, entry.text, text):
                hint = "its log has the reason, such as a constraint between parameters"
                root = self._of.root
                shown = text if root is None else show.hidden_text(root, paths.parse(key), text)
                raise NoAnswer(f"{self._of.name} rejected {path} = {shown}", hint)


def _arguments(changes: Mapping[str, tuple[str, str]]) -> Tree:
    """The arguments of setParameterList: texts and types by dotted paths."""
    span = Span(VALUE)

    def mapping(entries: Mapping[str, Node]) -> Tree:
        return mapping_at(span, {key: (text_at(span, key), node) for key, node in entries.items()})

    return mapping({"l": mapping({
        key: mapping({"editable": scalar_at(span, "true"), "value": text_at(span, text), "type": text_at(span, type_)})
        for key, (text, type_) in changes.items()
    })})  # fmt: skip


def _returned(name: str, reply: Reply) -> Any:
    if reply.throws:
        why = str(reply.members.get("unknown", "")).removeprefix(_LOGGED)
        raise NoAnswer(f"{name}: {why}" if why else f"CommonBehavior of {name} raised {reply.throws}")
    return reply.returns


def _set_in(settings: Tree, steps: list[str]) -> Node | None:
    """Where `set:` of a deployment sets a value at a path, above it or below it."""
    for key, value in settings.items():
        own = paths.parse(key.lexeme)
        if own[: len(steps)] == steps[: len(own)]:
            return value if value.span.file else key
    return None
