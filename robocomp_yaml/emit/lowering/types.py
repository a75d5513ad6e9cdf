"""Types of interfaces as they were linked."""

from __future__ import annotations

from robocomp_yaml.link.program import Definition, LinkedModule
from robocomp_yaml.model.interface import Method, TypeRef


def found(ref: TypeRef, scope: LinkedModule) -> tuple[LinkedModule, Definition]:
    """Raises LookupError where a reference is not linked: a component like that is not compiled."""
    place = scope.find(ref)
    if place is None:
        raise LookupError(f"{ref.text} is not linked: {scope.module.path}")
    return place


def scoped(ref: TypeRef, scope: LinkedModule) -> tuple[str, str]:
    """The names of its module, and its own."""
    home, definition = found(ref, scope)
    return home.module.name, definition.name


def results(method: Method) -> list[TypeRef]:
    """What a method gives back, in Ice's order."""
    returned = [] if method.returns is None else [method.returns]
    return [*returned, *(member.type for member in method.outputs)]
