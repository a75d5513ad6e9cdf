"""A component's ports as C++ spells them: accessors, the worker's methods, and the servants that call them.

All that is here goes to the templates as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from robocomp_yaml.emit.targets.cpp_names import Names, ice_name, parameter, proxy, qualified
from robocomp_yaml.emit.targets.cpp_text import IN, comment, declaration, one_line, quoted
from robocomp_yaml.emit.targets.cpp_types import found, input_type, type_name, zero
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Member, Method, TypeRef

_NOT_PUBLISHED = (
    "throw Ice::OperationNotExistException(__FILE__, __LINE__, current.id, current.facet, current.operation);"
)


@dataclass(frozen=True, slots=True)
class MethodView:
    """A method of the worker: in GenericWorker, and in the user's class."""

    name: str
    comment: str
    declaration: str
    overriding: str
    definition: str
    stub: list[str]


@dataclass(frozen=True, slots=True)
class OperationView:
    """An operation of a servant."""

    declaration: str
    body: str


@dataclass(frozen=True, slots=True)
class ServiceView:
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


@dataclass(frozen=True, slots=True)
class AccessorView:
    """A proxy that the worker has, and the statement that makes it."""

    name: str
    proxy: str
    comment: str
    summary: str
    statement: str


class Ports:
    """All ports of a component, with names that do not clash."""

    def __init__(self, component: LinkedComponent) -> None:
        self._members = Names()
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
            statement=_call(f"{name} = connections.require<{class_}>", [arguments], IN),
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
            statement=_call(
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
            call=("services.implement", f"{{{arguments}}}"),
        )

    def _subscribed(self, port: Port) -> ServiceView:
        arguments = f"{quoted(port.name)}, {quoted(port.interface.name)}"
        return self._served(
            port,
            title=f"{port.name}: events that others publish.",
            methods=_published_methods(port),
            suffix="Subscriber",
            arguments=arguments,
            call=("topics.subscribe", f"services, {arguments}"),
        )

    def _served(
        self, port: Port, title: str, methods: Sequence[Method], suffix: str, arguments: str, call: tuple[str, str]
    ) -> ServiceView:
        new, calls = [], {}
        for method in methods:
            key = (id(port.scope), port.interface.name, method.name)
            if key not in self._methods:
                self._methods[key] = self._method(port, method)
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
                f"{{{quoted(method.name)}, {quoted('::' + '::'.join(_names(ref, port.scope)))}}}"
                for method in methods for ref in method.throws
            ],
            statement=_call(call[0], [call[1], f"std::make_shared<{servant}>(*this)"], IN),
            operations=[_operation(m, port.scope, calls.get(m.name, "")) for m in port.interface.methods],
            new_methods=new,
        )

    def _method(self, port: Port, method: Method) -> MethodView:
        scope = port.scope
        name = self._members.take(f"{port.interface.name}_{method.name}")
        returns = "void" if method.returns is None else type_name(method.returns, scope)
        inputs = [(input_type(m.type, scope), parameter(m.name)) for m in method.inputs]
        outputs = [(f"{type_name(m.type, scope)}&", parameter(m.name)) for m in method.outputs]
        typed = [f"{type_} {word}" for type_, word in (*inputs, *outputs)]
        unused = [f"{type_} /*{word}*/" for type_, word in inputs] + [f"{type_} {word}" for type_, word in outputs]
        return MethodView(
            name=name,
            comment=comment(described, IN) if (described := _described(port, method)) else "",
            declaration=declaration(f"virtual {returns} {name}", typed, " = 0;", IN),
            overriding=declaration(f"{returns} {name}", typed, " override;", IN),
            definition=declaration(f"{returns} SpecificWorker::{name}", unused),
            stub=_stub(method, name, scope),
        )


def _operation(method: Method, scope: LinkedModule, calls: str) -> OperationView:
    """Calls the method of the worker called so; '' where it has none, because it is not published."""
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    types = [(type_name(m.type, scope), m.name) for m in method.inputs]
    types += [(f"{type_name(m.type, scope)}&", m.name) for m in method.outputs]
    typed = [f"{type_} {parameter(name)}" if calls else type_ for type_, name in types]
    current = "const Ice::Current&" if calls else "const Ice::Current& current"
    call = _call(
        f"{'' if method.returns is None else 'return '}worker_.{calls}", [parameter(name) for _, name in types], IN * 2
    )
    return OperationView(
        declaration=declaration(f"{returns} {ice_name(method.name)}", [*typed, current], " override", IN),
        body=call if calls else _NOT_PUBLISHED,
    )


def _call(function: str, arguments: Sequence[str], indent: str) -> str:
    return declaration(function, arguments, ";", indent)


def _stub(method: Method, name: str, scope: LinkedModule) -> list[str]:
    """What a method does until the user writes it."""
    hidden = "this->" if any(member.name == "log" for member in method.outputs) else ""
    lines = [f'{hidden}log.info("{name}() is still to be written");']
    lines += [f"{parameter(member.name)} = {zero(member.type, scope)};" for member in method.outputs]
    return lines if method.returns is None else [*lines, f"return {zero(method.returns, scope)};"]


def _described(port: Port, method: Method) -> str:
    """What the signature does not say."""
    lines = [method.doc.strip()] if method.doc.strip() else []
    for member in (*method.inputs, *method.outputs):
        if said := _said(member):
            lines.append(f"{parameter(member.name)}: {said}")
    if method.throws:
        names = ("::".join(_names(ref, port.scope)) for ref in method.throws)
        lines.append(f"Throws {', '.join(names)}.")
    return "\n".join(lines)


def _said(member: Member) -> str:
    return " ".join(part for part in (one_line(member.doc), f"[{member.unit}]" if member.unit else "") if part)


def _names(ref: TypeRef, scope: LinkedModule) -> tuple[str, str]:
    home, definition = found(ref, scope)
    return home.module.name, definition.name


def _accessor_comment(port: Port, what: str) -> str:
    return comment(f"{what}\n{port.use.doc or port.interface.doc}", IN)


def _published_methods(port: Port) -> list[Method]:
    return [method for method in port.interface.methods if method.can_be_published]
