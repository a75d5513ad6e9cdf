"""Resolves types of interfaces."""

from __future__ import annotations

from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Definition, Method, TypeRef


def resolve(ref: TypeRef, scope: LinkedModule) -> tuple[LinkedModule, Definition]:
    """The definition of a type, and its module. Raises LookupError if the type is unknown, which no component has that
    is compiled."""
    definition = scope.find(ref)
    if definition is None:
        raise LookupError(f"{ref.text} is not linked: {scope.module.path}")
    return definition


def scoped(ref: TypeRef, scope: LinkedModule) -> tuple[str, str]:
    """The names of a type's module and of the type."""
    home, definition = resolve(ref, scope)
    return home.module.name, definition.name


def results(method: Method) -> list[TypeRef]:
    """The types of a method's results, in Ice's order."""
    returned = [] if method.returns is None else [method.returns]
    return [*returned, *(member.type for member in method.outputs)]
