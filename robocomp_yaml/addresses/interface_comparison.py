"""Interfaces compared by content, whatever their documents.

Compared are names, order and types of parameters and members, enumerators with their values, exceptions, and units that
both sides have. Documentation and defaults are ignored.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from collections.abc import Sequence as Items
from typing import Protocol

import msgspec

from robocomp_yaml.diag.diagnostic import Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.interface import (
    Definition,
    Enum,
    ExceptionType,
    Interface,
    Map,
    Member,
    Method,
    Sequence,
    Struct,
    TypeRef,
)
from robocomp_yaml.model.located import Spanned


class InterfaceDifference(msgspec.Struct, frozen=True):
    """`message` names the first side before the second. The spans are in the documents of the two interfaces."""

    message: str
    first: Span
    second: Span

    def sides(self, first: str, second: str) -> list[Related]:
        """The two definitions, with the names of the processes that use them."""
        return [Related(f"as '{first}' knows it", self.first), Related(f"as '{second}' knows it", self.second)]


class HasInterface(Protocol):
    """A port, or anything else with an interface. `scope` is the module that defines the interface."""

    @property
    def scope(self) -> LinkedModule: ...

    @property
    def interface(self) -> Interface: ...


class InterfaceComparison(msgspec.Struct):
    """Compares interfaces, and caches the result of each pair."""

    _known: dict[tuple[LinkedModule, str, LinkedModule, str], InterfaceDifference | None] = {}

    def difference(self, first: HasInterface, second: HasInterface) -> InterfaceDifference | None:
        """The first difference of two interfaces, None if they are equal."""
        if first.scope is second.scope and first.interface is second.interface:
            return None
        key = (first.scope, first.interface.name, second.scope, second.interface.name)
        if key not in self._known:
            found = _ModulePair(first.scope, second.scope).interfaces(first.interface, second.interface)
            self._known[key] = next(found, None)
        return self._known[key]

    def is_equal(self, first: HasInterface, second: HasInterface) -> bool:
        """Whether two ports have the same interface, by name and content."""
        return name_of(first) == name_of(second) and self.difference(first, second) is None


class Implementers(msgspec.Struct):
    """The components that implement an interface. It may come from different documents with the same content. `real`
    returns the real path of a document."""

    comparison: InterfaceComparison = msgspec.field(default_factory=InterfaceComparison)
    real: Callable[[str], str] = os.path.realpath
    _by_name: dict[tuple[str, str], list[tuple[LinkedComponent, Port]]] = {}

    def add(self, linked: LinkedComponent) -> None:
        for port in linked.implements:
            self._by_name.setdefault(name_of(port), []).append((linked, port))

    def of(self, port: HasInterface, besides: LinkedComponent | None = None) -> list[tuple[LinkedComponent, Port]]:
        """The components that implement the interface of a port, each with its own port, in the order in which they
        were added; without the component of the document that `besides` has."""
        own = self.real(besides.component.path) if besides is not None else ""
        return [
            (linked, other)
            for linked, other in self._by_name.get(name_of(port), ())
            if self.real(linked.component.path) != own and self.comparison.is_equal(port, other)
        ]


def name_of(port: HasInterface) -> tuple[str, str]:
    """The module and the name of a port's interface."""
    return port.scope.module.name, port.interface.name


class _ModulePair(msgspec.Struct):
    """Two modules whose definitions are compared. `seen` are the pairs of types that have been compared."""

    first: LinkedModule
    second: LinkedModule
    seen: set[tuple[str, str]] = set()

    def interfaces(self, first: Interface, second: Interface) -> Iterator[InterfaceDifference]:
        names = self.first.module.name, self.second.module.name
        if names[0] != names[1]:
            yield _difference(f"its module is {names[0]} in one, and {names[1]} in the other", first, second)
        others = {method.name: method for method in second.methods}
        for method in first.methods:
            if method.name in others:
                yield from self.methods(method, others[method.name])
            else:
                yield _difference(f"'{method.name}' is in one only", method, second)
        names_of_first = {method.name for method in first.methods}
        for method in second.methods:
            if method.name not in names_of_first:
                yield _difference(f"'{method.name}' is in one only", first, method)

    def methods(self, first: Method, second: Method) -> Iterator[InterfaceDifference]:
        what = f"'{first.name}'"
        if first.idempotent != second.idempotent:
            yield _difference(f"{what} is idempotent in one only", first, second)
        yield from self.members(what, first.inputs, second.inputs, first, second)
        yield from self.members(f"`out` of {what}", first.outputs, second.outputs, first, second)
        if first.returns is None or second.returns is None:
            if first.returns is not second.returns:
                yield _difference(f"{what} returns something in one only", first, second)
        else:
            yield from self.types(f"what {what} returns", first.returns, second.returns)
        yield from _units(f"what {what} returns", first.returns_unit, second.returns_unit, first, second)
        thrown = {ref.name: ref for ref in first.throws}, {ref.name: ref for ref in second.throws}
        for name in sorted(thrown[0].keys() ^ thrown[1].keys()):
            yield _difference(f"{what} throws {name} in one only", first, second)
        for name in sorted(thrown[0].keys() & thrown[1].keys()):
            yield from self.types(f"what {what} throws", thrown[0][name], thrown[1][name])

    def members(
        self, what: str, first: Items[Member], second: Items[Member], here: Spanned, there: Spanned
    ) -> Iterator[InterfaceDifference]:
        for one, other in zip(first, second, strict=False):
            if one.name != other.name:
                yield _difference(f"{what} has '{one.name}' where the other has '{other.name}'", one, other)
            yield from self.types(f"'{one.name}' of {what}", one.type, other.type)
            yield from _units(f"'{one.name}' of {what}", one.unit, other.unit, one, other)
        if len(first) != len(second):
            longer = max(first, second, key=len)
            yield _difference(f"'{longer[min(len(first), len(second))].name}' of {what} is in one only", here, there)

    def types(self, what: str, first: TypeRef, second: TypeRef) -> Iterator[InterfaceDifference]:
        if first.is_basic or second.is_basic:
            if first.text != second.text:
                yield _difference(f"{what} is {first.text} in one, and {second.text} in the other", first, second)
            return
        found, other = self.first.find(first), self.second.find(second)
        if found is None or other is None:  # an unknown type, which has been reported
            return
        names = _qualified(*found), _qualified(*other)
        if names[0] != names[1]:
            yield _difference(f"{what} is {names[0]} in one, and {names[1]} in the other", first, second)
        elif found[1] is not other[1] and names not in self.seen:
            self.seen.add(names)
            yield from _ModulePair(found[0], other[0], self.seen).definitions(names[0], found[1], other[1])

    def definitions(self, name: str, first: Definition, second: Definition) -> Iterator[InterfaceDifference]:
        match first, second:
            case Struct(), Struct():
                yield from self.members(name, first.members, second.members, first, second)
            case ExceptionType(), ExceptionType():
                yield from self.members(name, first.members, second.members, first, second)
            case Enum(), Enum():
                if list(first.numbered()) != list(second.numbered()):
                    yield _difference(f"the enumerators of {name} differ", first, second)
            case Sequence(), Sequence():
                yield from self.types(f"an element of {name}", first.element, second.element)
            case Map(), Map():
                yield from self.types(f"a key of {name}", first.key, second.key)
                yield from self.types(f"a value of {name}", first.value, second.value)
            case _:
                if type(first) is not type(second):
                    yield _difference(f"{name} has two kinds of definition", first, second)


def _qualified(scope: LinkedModule, definition: Definition) -> str:
    return f"{scope.module.name}.{definition.name}"


def _units(what: str, first: str, second: str, here: Spanned, there: Spanned) -> Iterator[InterfaceDifference]:
    if first and second and first != second:
        yield _difference(f"{what} is in {first} in one, and in {second} in the other", here, there)


def _difference(message: str, first: Spanned, second: Spanned) -> InterfaceDifference:
    return InterfaceDifference(message, first.span, second.span)
