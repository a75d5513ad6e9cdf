"""Lowers ports: the proxies of the worker, and its methods that other components call."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec

from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.component import WAIT
from robocomp_yaml.model.interface import Method


class PortSpelling(msgspec.Struct, frozen=True):
    """How a language spells names. `taken` are the names of every worker. `published` are the candidates for the proxy
    of a topic, with {name} for the port's name in lower case. `called` makes the name of an operation for callers, and
    `property` is the name of a property in documentation."""

    taken: frozenset[str]
    published: tuple[str, ...]
    called: Callable[[str], str]
    property: str = "{name}"


class Accessor(msgspec.Struct, frozen=True):
    """The proxy `name` of the worker. `about` is one sentence, `summary` a few words, and `doc` the documentation in
    the document. `events` are those that it publishes. `absent` is '' for the default of the run time. `milliseconds`
    is the time limit of calls, None for the default of Ice."""

    port: Port
    name: str
    about: str
    summary: str
    doc: str
    events: str = ""
    absent: str = ""
    milliseconds: int | None = None


class CalledMethod(msgspec.Struct, frozen=True):
    """The method `name` of the worker, which an operation of a port calls."""

    port: Port
    method: Method
    name: str


class Service(msgspec.Struct, frozen=True):
    """An implemented or subscribed port. `new` are its methods that no earlier port has."""

    port: Port
    title: str
    identity: str
    methods: tuple[CalledMethod, ...]
    new: tuple[CalledMethod, ...]


class LoweredPorts(msgspec.Struct, frozen=True):
    requires: tuple[Accessor, ...]
    publishes: tuple[Accessor, ...]
    implements: tuple[Service, ...]
    subscribes: tuple[Service, ...]


def lower(component: LinkedComponent, spelling: PortSpelling) -> LoweredPorts:
    """All ports of a component, with names that do not clash."""
    names = NameAllocator(spelling.taken)
    requires = tuple(_required(port, names, spelling) for port in component.requires)
    publishes = tuple(_published(port, names, spelling) for port in component.publishes)
    known: dict[tuple[LinkedModule, str, str], CalledMethod] = {}
    implements = tuple(
        _service(port, "other components call these.", port.interface.methods, names, known)
        for port in component.implements
    )
    subscribes = tuple(
        _service(port, "events that others publish.", can_be_published(port), names, known)
        for port in component.subscribes
    )
    return LoweredPorts(requires, publishes, implements, subscribes)


def can_be_published(port: Port) -> list[Method]:
    """The methods of an interface that a topic can carry."""
    return [method for method in port.interface.methods if method.can_be_published]


def _required(port: Port, names: NameAllocator, spelling: PortSpelling) -> Accessor:
    property_ = spelling.property.format(name=f"{port.name}Proxy")
    timeout = port.use.timeout
    return Accessor(
        port=port,
        name=names.allocate(f"{port.name.lower()}_proxy"),
        about=f"{port.name}, at the address that the property {property_} gives.",
        summary=f"calls {port.name}",
        doc=port.use.doc or port.interface.doc,
        absent="" if port.use.absent == WAIT else port.use.absent,
        milliseconds=None if timeout is None else max(1, round(timeout * 1000)),
    )


def _published(port: Port, names: NameAllocator, spelling: PortSpelling) -> Accessor:
    methods = can_be_published(port)
    events = ", ".join(f"{spelling.called(m.name)}({', '.join(one.name for one in m.inputs)})" for m in methods)
    return Accessor(
        port=port,
        name=names.allocate(*(candidate.format(name=port.name.lower()) for candidate in spelling.published)),
        about=f"Publishes {port.name}: {events}.",
        summary=f"publishes {port.name}",
        doc=port.use.doc or port.interface.doc,
        events=events,
    )


def _service(
    port: Port,
    about: str,
    methods: Sequence[Method],
    names: NameAllocator,
    known: dict[tuple[LinkedModule, str, str], CalledMethod],
) -> Service:
    every, new = [], []
    for method in methods:
        key = (port.scope, port.interface.name, method.name)
        if key not in known:
            known[key] = CalledMethod(port, method, names.allocate(f"{port.interface.name}_{method.name}"))
            new.append(known[key])
        every.append(known[key])
    return Service(port, f"{port.name}: {about}", port.interface.name.lower(), tuple(every), tuple(new))
