"""Types of documents in Python, after Ice's mapping: type hints, and the value that a stub returns."""

from __future__ import annotations

from robocomp_yaml.emit.lowering.types import resolve, results
from robocomp_yaml.languages.python.names import module_variable, python_name
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Definition, Enum, Map, Method, Sequence, TypeRef

_BASIC_HINTS = {
    "bool": "bool",
    "byte": "int",
    "short": "int",
    "int": "int",
    "long": "int",
    "float": "float",
    "double": "float",
    "string": "str",
}
_ZEROS = {"bool": "False", "int": "0", "float": "0.0", "str": '""'}


def hint(ref: TypeRef, scope: LinkedModule) -> str:
    """The type hint for a value of this type, as `scope` names it."""
    if ref.is_basic:
        return _BASIC_HINTS[ref.text]
    home, definition = resolve(ref, scope)
    return hint_of(definition, home)


def hint_of(definition: Definition, home: LinkedModule) -> str:
    """The type hint for a value of a type that a module defines."""
    match definition:
        case Sequence(element=element):
            return "bytes" if element.text == "byte" else f"list[{hint(element, home)}]"
        case Map(key=key, value=value):
            return f"dict[{hint(key, home)}, {hint(value, home)}]"
        case _:
            return qualified(home, definition.name)


def argument_hint(ref: TypeRef, scope: LinkedModule) -> str:
    """The type hint for an argument: Ice accepts any iterable as a sequence."""
    if ref.is_basic:
        return _BASIC_HINTS[ref.text]
    home, definition = resolve(ref, scope)
    match definition:
        case Sequence(element=element):
            return f"Iterable[{argument_hint(element, home)}]"
        case _:
            return hint(ref, scope)


def result_hint(method: Method, scope: LinkedModule) -> str:
    """The type hint for the result of a method: several results are a tuple."""
    types = [hint(ref, scope) for ref in results(method)]
    return "None" if not types else types[0] if len(types) == 1 else f"tuple[{', '.join(types)}]"


def zero(ref: TypeRef, scope: LinkedModule) -> str:
    """An expression for the default value: zero, empty, the first enumerator, a struct of its defaults."""
    if ref.is_basic:
        return _ZEROS[_BASIC_HINTS[ref.text]]
    home, definition = resolve(ref, scope)
    match definition:
        case Sequence(element=element):
            return 'b""' if element.text == "byte" else "[]"
        case Map():
            return "{}"
        case Enum(enumerators=(first, *_)):
            return f"{qualified(home, definition.name)}.{python_name(first.name)}"
        case _:
            return f"{qualified(home, definition.name)}()"


def qualified(scope: LinkedModule, name: str) -> str:
    """A definition as generated code refers to it."""
    return f"{module_variable(scope.module.name)}.{python_name(name)}"
