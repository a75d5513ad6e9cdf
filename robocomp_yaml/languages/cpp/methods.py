"""Methods as C++ spells them: the worker's, with their stubs, and the operations of servants that call them."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from robocomp_yaml.emit.lowering.types import scoped
from robocomp_yaml.languages.cpp.names import ice_name, parameter
from robocomp_yaml.languages.cpp.text import IN, comment, declaration, one_line
from robocomp_yaml.languages.cpp.types import input_type, type_name, zero
from robocomp_yaml.link.program import LinkedModule, Port
from robocomp_yaml.model.interface import Member, Method

_NOT_PUBLISHED = (
    "throw Ice::OperationNotExistException(__FILE__, __LINE__, current.id, current.facet, current.operation);"
)


class MethodView(msgspec.Struct, frozen=True):
    """A method of the worker: in GenericWorker, which has it so that a user's class without it still compiles, and in
    the user's class. That says no `override`: a method that an interface has no more would be an error then."""

    name: str
    comment: str
    declaration: str
    fallback: str
    overriding: str
    definition: str
    stub: list[str]


class OperationView(msgspec.Struct, frozen=True):
    """An operation of a servant."""

    declaration: str
    body: str


def method_view(port: Port, method: Method, name: str) -> MethodView:
    """The worker's method of this name, which an operation of the port calls."""
    scope = port.scope
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    inputs = [(input_type(m.type, scope), parameter(m.name)) for m in method.inputs]
    outputs = [(f"{type_name(m.type, scope)}&", parameter(m.name)) for m in method.outputs]
    typed = [f"{type_} {word}" for type_, word in (*inputs, *outputs)]
    unused = [f"{type_} /*{word}*/" for type_, word in inputs] + [f"{type_} {word}" for type_, word in outputs]
    return MethodView(
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


def operation_view(method: Method, scope: LinkedModule, calls: str) -> OperationView:
    """Calls the method of the worker called so; '' where it has none, because it is not published."""
    returns = "void" if method.returns is None else type_name(method.returns, scope)
    types = [(type_name(m.type, scope), m.name) for m in method.inputs]
    types += [(f"{type_name(m.type, scope)}&", m.name) for m in method.outputs]
    typed = [f"{type_} {parameter(name)}" if calls else type_ for type_, name in types]
    current = "const Ice::Current&" if calls else "const Ice::Current& current"
    statement = call(
        f"{'' if method.returns is None else 'return '}worker_.{calls}", [parameter(name) for _, name in types], IN * 2
    )
    return OperationView(
        declaration=declaration(f"{returns} {ice_name(method.name)}", [*typed, current], " override", IN),
        body=statement if calls else _NOT_PUBLISHED,
    )


def call(function: str, arguments: Sequence[str], indent: str) -> str:
    """A statement."""
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
        names = ("::".join(scoped(ref, port.scope)) for ref in method.throws)
        lines.append(f"Throws {', '.join(names)}.")
    return "\n".join(lines)


def _said(member: Member) -> str:
    return " ".join(part for part in (one_line(member.doc), f"[{member.unit}]" if member.unit else "") if part)
