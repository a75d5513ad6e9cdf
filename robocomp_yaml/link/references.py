"""The types that definitions refer to, and the identifiers that they introduce."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model import interface as model
from robocomp_yaml.model.interface import Definition

KINDS: dict[type, str] = {
    model.Constant: "constant",
    model.Struct: "struct",
    model.Enum: "enum",
    model.Sequence: "sequence",
    model.Map: "map",
    model.ExceptionType: "exception",
    model.Interface: "interface",
}


class Identifier(msgspec.Struct, frozen=True):
    """An identifier where it is introduced. `kind` is a word for messages; `owner` is set if the owner has no
    definition of its own, as a method has none."""

    kind: str
    text: str
    span: Span
    owner: str = ""


def kind_of(definition: Definition) -> str:
    if isinstance(definition, model.Interface) and definition.is_topic:
        return "topic"
    return KINDS[type(definition)]


def types_of(definition: Definition) -> Iterator[model.TypeRef]:
    """Every type that a definition refers to, in the order of the document, without `throws`."""
    match definition:
        case model.Constant(type=type_):
            yield type_
        case model.Struct(members=members) | model.ExceptionType(members=members):
            yield from (member.type for member in members)
        case model.Sequence(element=element):
            yield element
        case model.Map(key=key, value=value):
            yield from (key, value)
        case model.Interface(methods=methods):
            for method in methods:
                yield from types_of_method(method)


def types_of_method(method: model.Method) -> Iterator[model.TypeRef]:
    if method.returns is not None:
        yield method.returns
    yield from (parameter.type for parameter in (*method.inputs, *method.outputs))


def exceptions_of(definition: Definition) -> Iterator[model.TypeRef]:
    if isinstance(definition, model.Interface):
        for method in definition.methods:
            yield from method.throws


def groups(definition: Definition) -> Iterator[list[Identifier]]:
    """The identifiers inside of a definition, one list for each scope."""
    match definition:
        case model.Struct(members=members) | model.ExceptionType(members=members):
            yield [Identifier("member", member.name, member.span) for member in members]
        case model.Enum(enumerators=enumerators):
            yield [Identifier("enumerator", enumerator.name, enumerator.span) for enumerator in enumerators]
        case model.Interface(methods=methods):
            yield [Identifier("method", method.name, method.span) for method in methods]
            for method in methods:
                parameters = (*method.inputs, *method.outputs)
                owner = f"method {definition.name}.{method.name}"
                yield [Identifier("parameter", parameter.name, parameter.span, owner) for parameter in parameters]


def macro(stem: str) -> str:
    """A document's name as the name of a macro. Two documents with the same macro cannot be in one program."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in stem).upper()
