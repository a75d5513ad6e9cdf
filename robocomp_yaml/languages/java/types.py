"""Types of the documents as Java sees them through Ice's mapping."""

from __future__ import annotations

from robocomp_yaml.emit.lowering.types import found, results
from robocomp_yaml.languages.java.names import ice_name, qualified
from robocomp_yaml.link.program import LinkedModule, Port
from robocomp_yaml.model.interface import Enum, Map, Method, Sequence, TypeRef

_BASIC = {
    "bool": "boolean", "byte": "byte", "short": "short", "int": "int", "long": "long", "float": "float",
    "double": "double", "string": "String",
}  # fmt: skip
_BOXED = {
    "bool": "Boolean", "byte": "Byte", "short": "Short", "int": "Integer", "long": "Long", "float": "Float",
    "double": "Double", "string": "String",
}  # fmt: skip
_ZEROS = {"bool": "false", "string": '""', "float": "0.0f", "double": "0.0", "byte": "(byte) 0", "short": "(short) 0"}


def type_name(ref: TypeRef, scope: LinkedModule, *, boxed: bool = False) -> str:
    """The type of a value; `boxed` where a map holds it."""
    if ref.is_basic:
        return (_BOXED if boxed else _BASIC)[ref.text]
    home, definition = found(ref, scope)
    match definition:
        case Sequence(element=element):
            return f"{type_name(element, home)}[]"
        case Map(key=key, value=value):
            return f"java.util.Map<{type_name(key, home, boxed=True)}, {type_name(value, home, boxed=True)}>"
        case _:
            return qualified(home, definition.name)


def result_type(method: Method, port: Port) -> str:
    """What a method gives back: several values come in an object of their own."""
    given = results(method)
    if len(given) > 1:
        return f"{qualified(port.scope, port.interface.name)}.{method.name[:1].upper()}{method.name[1:]}Result"
    return type_name(given[0], port.scope) if given else "void"


def zero(ref: TypeRef, scope: LinkedModule) -> str:
    """The plainest value: zero, empty, the first enumerator, a struct of its defaults."""
    if ref.is_basic:
        return _ZEROS.get(ref.text, "0")
    home, definition = found(ref, scope)
    match definition:
        case Sequence():
            of = type_name(ref, scope)
            at = of.index("[]")
            return f"new {of[:at]}[0]{of[at + 2 :]}" if "<" not in of[:at] else "null"
        case Map():
            return "new java.util.HashMap<>()"
        case Enum(enumerators=(first, *_)):
            return f"{qualified(home, definition.name)}.{ice_name(first.name)}"
        case _:
            return f"new {qualified(home, definition.name)}()"
