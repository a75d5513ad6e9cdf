"""A component's ports as C++ spells them: accessors, and the servants with the worker's methods that they call.

All that is here goes to the templates as it is.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from robocomp_yaml.languages.cpp.methods import MethodView, OperationView, call, method_view, operation_view, scoped
from robocomp_yaml.languages.cpp.names import Names, ice_name, proxy, qualified
from robocomp_yaml.languages.cpp.text import IN, comment, quoted
from robocomp_yaml.link.program import LinkedComponent, Port
from robocomp_yaml.model.interface import Method


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
    """All ports of a component, with names that do not clash."""

    def __init__(self, component: LinkedComponent) -> None:
        self._members = Names(("parameters",))
        self._servants = Names()
        self._methods: dict[tuple[int, str, str], MethodView] = {}
        self.requires = [self._required(port) for port in component.requires]
        self.publishes = [self._published(port) for port in component.publishes]
        self.implements = [self._implemented(port) for port in component.implements]
        self.subscribes = [self._subscribed(port) for port in component.subscribes]

    def _required(self, port: Port) -> AccessorView:
        arguments = f"{{{quoted(port.name)}, runtime::Absent::{port.use.absent}}}"
        if port.use.timeout is not None:
            milliseconds = max(1, round(port.use.timeout * 1000))
            arguments = f"{arguments[:-1]}, std::chrono::milliseconds({milliseconds})}}"
        name, class_ = self._members.take(f"{port.name.lower()}_proxy"), proxy(port.scope, port.interface.name)
        return AccessorView(
            name=name,
            proxy=class_,
            comment=_accessor_comment(port, f"{port.name}, at the address that the property {port.name}Proxy gives."),
            summary=f"calls {port.name}",
            statement=call(f"{name} = connections.require<{class_}>", [arguments], IN),
        )

    def _published(self, port: Port) -> AccessorView:
        events = ", ".join(
            f"{ice_name(m.name)}({', '.join(member.name for member in m.inputs)})" for m in _published_methods(port)
        )
        name, class_ = self._members.take(f"{port.name.lower()}_pubproxy"), proxy(port.scope, port.interface.name)
        return AccessorView(
            name=name,
            proxy=class_,
            comment=_accessor_comment(port, f"Publishes {port.name}: {events}."),
            summary=f"publishes {port.name}: {events}",
            statement=call(
                f"{name} = topics.publish<{class_}>", [quoted(port.name), quoted(port.interface.name)], IN
            ),
        )

    def _implemented(self, port: Port) -> ServiceView:
        name = port.interface.name
        arguments = ", ".join(quoted(word) for word in (port.name, name.lower(), name))
        return self._served(
            port,
            title=f"{port.name}: other components call these.",
            methods=port.interface.methods,
            suffix="Servant",
            arguments=arguments,
            function=("services.implement", f"{{{arguments}}}"),
        )

    def _subscribed(self, port: Port) -> ServiceView:
        arguments = f"{quoted(port.name)}, {quoted(port.interface.name)}"
        return self._served(
            port,
            title=f"{port.name}: events that others publish.",
            methods=_published_methods(port),
            suffix="Subscriber",
            arguments=arguments,
            function=("topics.subscribe", f"services, {arguments}"),
        )

    def _served(
        self, port: Port, title: str, methods: Sequence[Method], suffix: str, arguments: str, function: tuple[str, str]
    ) -> ServiceView:
        new, calls = [], {}
        for method in methods:
            key = (id(port.scope), port.interface.name, method.name)
            if key not in self._methods:
                name = self._members.take(f"{port.interface.name}_{method.name}")
                self._methods[key] = method_view(port, method, name)
                new.append(self._methods[key])
            calls[method.name] = self._methods[key].name
        servant = self._servants.take(f"{port.name}{suffix}")
        if any(method.name == servant for method in port.interface.methods):
            servant += "_"
        return ServiceView(
            name=port.name,
            title=title,
            servant=servant,
            base=qualified(port.scope, port.interface.name),
            arguments=arguments,
            declared=[
                f"{{{quoted(method.name)}, {quoted('::' + '::'.join(scoped(ref, port.scope)))}}}"
                for method in methods for ref in method.throws
            ],
            statement=call(function[0], [function[1], f"std::make_shared<{servant}>(*this)"], IN),
            operations=[operation_view(m, port.scope, calls.get(m.name, "")) for m in port.interface.methods],
            new_methods=new,
        )


def _accessor_comment(port: Port, what: str) -> str:
    return comment(f"{what}\n{port.use.doc or port.interface.doc}", IN)


def _published_methods(port: Port) -> list[Method]:
    return [method for method in port.interface.methods if method.can_be_published]
