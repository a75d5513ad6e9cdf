"""Types of documents in C++, after Ice's mapping."""

from __future__ import annotations

from robocomp_yaml.emit.lowering.types import resolve
from robocomp_yaml.languages.cpp.names import ice_name, qualified
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Enum, TypeRef

_BASIC = {
    "bool": "bool",
    "byte": "Ice::Byte",
    "short": "short",
    "int": "int",
    "long": "long long int",
    "float": "float",
    "double": "double",
    "string": "std::string",
}


def type_name(ref: TypeRef, scope: LinkedModule) -> str:
    """The type of a value."""
    if ref.is_basic:
        return _BASIC[ref.text]
    home, definition = resolve(ref, scope)
    return qualified(home, definition.name)


def input_type(ref: TypeRef, scope: LinkedModule) -> str:
    """The type of an input parameter: small values by value, others by reference."""
    name = type_name(ref, scope)
    is_small = ref.text != "string" if ref.is_basic else isinstance(resolve(ref, scope)[1], Enum)
    return name if is_small else f"const {name}&"


def zero(ref: TypeRef, scope: LinkedModule) -> str:
    """The default value: zero, empty, the first enumerator, a struct of its defaults."""
    if not ref.is_basic:
        home, definition = resolve(ref, scope)
        if isinstance(definition, Enum):
            return f"{qualified(home, definition.name)}::{ice_name(definition.enumerators[0].name)}"
    return "{}"
