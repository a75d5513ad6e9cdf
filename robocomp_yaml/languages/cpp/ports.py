"""The ports of a component in C++: accessors, servants, and the worker's methods that servants call.

Templates show these views unchanged.
"""

from __future__ import annotations

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.types import scoped
from robocomp_yaml.emit.render import View
from robocomp_yaml.languages._shared.text import IN, declaration
from robocomp_yaml.languages._shared.views import PortViews
from robocomp_yaml.languages.cpp.names import PORTS, ice_name, names, parameter, proxy, qualified
from robocomp_yaml.languages.cpp.text import comment, literal, one_line
from robocomp_yaml.languages.cpp.types import input_type, type_name, zero
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import Member, Method

_NOT_PUBLISHED = (
    "throw Ice::OperationNotExistException(__FILE__, __LINE__, current.id, current.facet, current.operation);"
)


def port_views(component: LinkedComponent) -> PortViews:
    lowered, servants = lowering.lower(component, PORTS), names()
    return PortViews(
        [_required(accessor) for accessor in lowered.requires],
        [_published(accessor) for accessor in lowered.publishes],
        [_implemented(service, servants) for service in lowered.implements],
        [_subscribed(service, servants) for service in lowered.subscribes],
    )


def _required(accessor: lowering.Accessor) -> View:
    words = [literal(accessor.port.name), f"runtime::Absent::{accessor.port.use.absent}"]
    if accessor.milliseconds is not None:
        words.append(f"std::chrono::milliseconds({accessor.milliseconds})")
    return _accessor(accessor, accessor.summary, "connections.require", [f"{{{', '.join(words)}}}"])


def _published(accessor: lowering.Accessor) -> View:
    words = [literal(accessor.port.name), literal(accessor.port.interface.name)]
    return _accessor(accessor, f"{accessor.summary}: {accessor.events}", "topics.publish", words)


def _accessor(accessor: lowering.Accessor, summary: str, function: str, arguments: list[str]) -> View:
    """A proxy of the worker, and the statement that creates it."""
    class_ = proxy(accessor.port.scope, accessor.port.interface.name)
    return View(
        name=accessor.name,
        proxy=class_,
        comment=comment(f"{accessor.about}\n{accessor.doc}", IN),
        summary=summary,
        statement=declaration(f"{accessor.name} = {function}<{class_}>", arguments, ";", IN),
    )


def _implemented(service: lowering.Service, servants: NameAllocator) -> View:
    words = (service.port.name, service.identity, service.port.interface.name)
    arguments = ", ".join(map(literal, words))
    return _served(service, servants, "GeneratedServant", arguments, ("services.implement", f"{{{arguments}}}"))


def _subscribed(service: lowering.Service, servants: NameAllocator) -> View:
    arguments = f"{literal(service.port.name)}, {literal(service.port.interface.name)}"
    return _served(service, servants, "GeneratedSubscriber", arguments, ("topics.subscribe", f"services, {arguments}"))


def _served(
    service: lowering.Service, servants: NameAllocator, suffix: str, arguments: str, function: tuple[str, str]
) -> View:
    """An implemented or subscribed port; `new_methods` are the methods that no earlier port has. `declared` are pairs
    of an operation and an exception that it declares, in braces; `statement` serves a port without any."""
    port, calls = service.port, {called.method.name: called.name for called in service.methods}
    # "Generated", since the user's header is read after it, in the same translation unit.
    servant = servants.allocate(f"{port.name}{suffix}")
    if any(method.name == servant for method in port.interface.methods):
        servant += "_"
    return View(
        name=port.name,
        title=service.title,
        servant=servant,
        base=qualified(port.scope, port.interface.name),
        arguments=arguments,
        declared=[
            f"{{{literal(called.method.name)}, {literal('::' + '::'.join(scoped(ref, port.scope)))}}}"
            for called in service.methods for ref in called.method.throws
        ],
        statement=declaration(function[0], [function[1], f"std::make_shared<{servant}>(*this)"], ";", IN),
        operations=[operation_view(m, port.scope, calls.get(m.name, "")) for m in port.interface.methods],
        new_methods=[method_view(called.port, called.method, called.name) for called in service.new],
    )  # fmt: skip


def method_view(port: Port, method: Method, name: str) -> View:
    """The worker's method `name`, which an operation of the port calls: in GenericWorker and in the user's class.
    GenericWorker defines it too, so that a user's class without it compiles. The user's class does not declare it
    `override`: a method that an interface no longer has would be an error."""
    scope = port.scope
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    inputs = [(input_type(m.type, scope), parameter(m.name)) for m in method.inputs]
    outputs = [(f"{type_name(m.type, scope)}&", parameter(m.name)) for m in method.outputs]
    typed = [f"{type_} {word}" for type_, word in (*inputs, *outputs)]
    unused = [f"{type_} /*{word}*/" for type_, word in inputs] + [f"{type_} {word}" for type_, word in outputs]
    return View(
        name=name,
        comment=comment(described, IN) if (described := _described(port, method)) else "",
        declaration=declaration(f"virtual {returns} {name}", typed, ";", IN),
        fallback=declaration(
            f"{returns} GenericWorker::{name}", [f"{type_} /*{word}*/" for type_, word in (*inputs, *outputs)]
        ),
        overriding=declaration(f"{returns} {name}", typed, ";", IN),
        definition=declaration(f"{returns} SpecificWorker::{name}", unused),
        stub=_stub(method, name, scope),
    )


def operation_view(method: Method, scope: LinkedModule, calls: str) -> View:
    """The operation that calls the worker's method `calls` with `arguments`; '' for an operation that cannot be
    published."""
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    types = [(type_name(m.type, scope), m.name) for m in method.inputs]
    types += [(f"{type_name(m.type, scope)}&", m.name) for m in method.outputs]
    typed = [f"{type_} {parameter(name)}" if calls else type_ for type_, name in types]
    current = "const Ice::Current&" if calls else "const Ice::Current& current"
    start = f"{'' if method.returns is None else 'return '}worker_.{calls}"
    statement = declaration(start, [parameter(name) for _, name in types], ";", IN * 2)
    return View(
        declaration=declaration(f"{returns} {ice_name(method.name)}", [*typed, current], " override", IN),
        body=statement if calls else _NOT_PUBLISHED,
        calls=calls,
        arguments=", ".join(parameter(name) for _, name in types),
    )


def _stub(method: Method, name: str, scope: LinkedModule) -> list[str]:
    """The statements of a method until the user writes it."""
    hidden = "this->" if any(member.name == "log" for member in method.outputs) else ""
    lines = [f'{hidden}log.info("{name}() is still to be written");']
    lines += [f"{parameter(member.name)} = {zero(member.type, scope)};" for member in method.outputs]
    return lines if method.returns is None else [*lines, f"return {zero(method.returns, scope)};"]


def _described(port: Port, method: Method) -> str:
    """What the signature does not show."""
    lines = [method.doc.strip()] if method.doc.strip() else []
    for member in (*method.inputs, *method.outputs):
        if note := _note(member):
            lines.append(f"{parameter(member.name)}: {note}")
    if method.throws:
        names = ("::".join(scoped(ref, port.scope)) for ref in method.throws)
        lines.append(f"Throws {', '.join(names)}.")
    return "\n".join(lines)


def _note(member: Member) -> str:
    return " ".join(part for part in (one_line(member.doc), f"[{member.unit}]" if member.unit else "") if part)
