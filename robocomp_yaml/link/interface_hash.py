"""Hashes of interfaces' contents: equal for two documents if what travels is the same.

Hashed are the names, order and types of parameters and members, enumerators with their values, exceptions, and which
methods are idempotent, of the interface and of all types that it uses. Documentation, defaults and units are ignored.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import msgspec

from robocomp_yaml.link.program import LinkedModule, Port
from robocomp_yaml.model.interface import (
    Definition,
    Enum,
    ExceptionType,
    Map,
    Member,
    Method,
    Sequence,
    Struct,
    TypeRef,
)
from robocomp_yaml.source.digest import digest

DIGITS = 16


def interface_hash(port: Port) -> str:
    """The hash of a port's interface."""
    content = _Content()
    methods = [content.method(method, port.scope) for method in port.interface.methods]
    data = [f"{port.scope.module.name}.{port.interface.name}", sorted(methods), sorted(content.types.items())]
    return digest(msgspec.json.encode(data))[:DIGITS]


class _Content(msgspec.Struct):
    """The contents of the types that were used, by their qualified names."""

    types: dict[str, Any] = {}

    def method(self, method: Method, scope: LinkedModule) -> list[Any]:
        return [
            method.name,
            method.idempotent,
            self._members(method.inputs, scope),
            self._members(method.outputs, scope),
            self._type(method.returns, scope) if method.returns else "",
            sorted(self._type(ref, scope) for ref in method.throws),
        ]

    def _members(self, members: Iterable[Member], scope: LinkedModule) -> list[list[str]]:
        return [[member.name, self._type(member.type, scope)] for member in members]

    def _type(self, ref: TypeRef, scope: LinkedModule) -> str:
        """The qualified name of a type, whose content is added."""
        found = None if ref.is_basic else scope.find(ref)
        if found is None:
            return ref.text
        home, definition = found
        name = f"{home.module.name}.{definition.name}"
        if name not in self.types:
            self.types[name] = []  # a type may contain itself
            self.types[name] = self._definition(definition, home)
        return name

    def _definition(self, definition: Definition, home: LinkedModule) -> list[Any]:
        match definition:
            case Struct(members=members) | ExceptionType(members=members):
                return [type(definition).__name__, *self._members(members, home)]
            case Enum():
                return ["Enum", *definition.numbered()]
            case Sequence(element=element):
                return ["Sequence", self._type(element, home)]
            case Map(key=key, value=value):
                return ["Map", self._type(key, home), self._type(value, home)]
        return []
