"""A component's ports as C++ spells them: accessors, and the servants with the worker's methods that they call.

All that is here goes to the templates as it is.
"""

from __future__ import annotations

import msgspec

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.types import scoped
from robocomp_yaml.languages.cpp.methods import MethodView, OperationView, call, method_view, operation_view
from robocomp_yaml.languages.cpp.names import PORTS, names, proxy, qualified
from robocomp_yaml.languages.cpp.text import IN, comment, quoted
from robocomp_yaml.link.program import LinkedComponent


class ServiceView(msgspec.Struct, frozen=True):
    """An implemented or subscribed port; `new_methods` are those that no earlier port has brought. `declared` are pairs
    of an operation and an exception that it declares, in braces; `statement` serves a port that has none."""

    name: str
    title: str
    servant: str
    base: str
    arguments: str
    declared: list[str]
    statement: str
    operations: list[OperationView]
    new_methods: list[MethodView]


class AccessorView(msgspec.Struct, frozen=True):
    """A proxy that the worker has, and the statement that makes it."""

    name: str
    proxy: str
    comment: str
    summary: str
    statement: str


class Ports:
    """All ports of a component, as C++ has them."""

    def __init__(self, component: LinkedComponent) -> None:
        found, servants = lowering.lower(component, PORTS), names()
        self.requires = [_required(accessor) for accessor in found.requires]
        self.publishes = [_published(accessor) for accessor in found.publishes]
        self.implements = [_implemented(service, servants) for service in found.implements]
        self.subscribes = [_subscribed(service, servants) for service in found.subscribes]


def _required(accessor: lowering.Accessor) -> AccessorView:
    words = [quoted(accessor.port.name), f"runtime::Absent::{accessor.port.use.absent}"]
    if accessor.milliseconds is not None:
        words.append(f"std::chrono::milliseconds({accessor.milliseconds})")
    return _accessor(accessor, accessor.summary, "connections.require", [f"{{{', '.join(words)}}}"])


def _published(accessor: lowering.Accessor) -> AccessorView:
    words = [quoted(accessor.port.name), quoted(accessor.port.interface.name)]
    return _accessor(accessor, f"{accessor.summary}: {accessor.events}", "topics.publish", words)


def _accessor(accessor: lowering.Accessor, summary: str, function: str, arguments: list[str]) -> AccessorView:
    class_ = proxy(accessor.port.scope, accessor.port.interface.name)
    return AccessorView(
        name=accessor.name,
        proxy=class_,
        comment=comment(f"{accessor.about}\n{accessor.doc}", IN),
        summary=summary,
        statement=call(f"{accessor.name} = {function}<{class_}>", arguments, IN),
    )


def _implemented(service: lowering.Service, servants: NameAllocator) -> ServiceView:
    words = (service.port.name, service.identity, service.port.interface.name)
    arguments = ", ".join(map(quoted, words))
    return _served(service, servants, "Servant", arguments, ("services.implement", f"{{{arguments}}}"))


def _subscribed(service: lowering.Service, servants: NameAllocator) -> ServiceView:
    arguments = f"{quoted(service.port.name)}, {quoted(service.port.interface.name)}"
    return _served(service, servants, "Subscriber", arguments, ("topics.subscribe", f"services, {arguments}"))


def _served(
    service: lowering.Service, servants: NameAllocator, suffix: str, arguments: str, function: tuple[str, str]
) -> ServiceView:
    port, calls = service.port, {called.method.name: called.name for called in service.methods}
    servant = servants.allocate(f"{port.name}{suffix}")
    if any(method.name == servant for method in port.interface.methods):
        servant += "_"
    return ServiceView(
        name=port.name,
        title=service.title,
        servant=servant,
        base=qualified(port.scope, port.interface.name),
        arguments=arguments,
        declared=[
            f"{{{quoted(called.method.name)}, {quoted('::' + '::'.join(scoped(ref, port.scope)))}}}"
            for called in service.methods for ref in called.method.throws
        ],
        statement=call(function[0], [function[1], f"std::make_shared<{servant}>(*this)"], IN),
        operations=[operation_view(m, port.scope, calls.get(m.name, "")) for m in port.interface.methods],
        new_methods=[method_view(called.port, called.method, called.name) for called in service.new],
    )  # fmt: skip
