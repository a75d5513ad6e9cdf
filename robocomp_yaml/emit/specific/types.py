"""Types in signatures: whether a type that the user wrote is surely another one than the interface has.

A part `code` of a language reads a type to a `TypeForm`, whose heads are the same for all languages. What may be the
same type under another name, such as a typedef of the user, has no form.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import msgspec

from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.model.interface import Enum, Map, Sequence, Struct, TypeRef

LIST, MAP, TUPLE, ANY_OF, NOTHING = "list", "map", "tuple", "any of", "nothing"
NUMBERS = ("bool", "byte", "short", "int", "long", "float", "double")
"""What a caller may pass one for another, if the language converts it."""

Differ = Callable[[str, str, bool], bool]
"""Whether two texts of parameters, or of results, surely mean different types: the user's, the skeleton's."""


class TypeForm(msgspec.Struct, frozen=True):
    """A type: a basic type of Slice, NOTHING, LIST or MAP, TUPLE or ANY_OF with `arguments`, or the name of a
    definition with its module."""

    head: str
    arguments: tuple[TypeForm | None, ...] = ()
    module: str = ""


class KnownTypes:
    """The types of a component's interfaces, by the names that they have in a language. `users` are names that the
    user's code defines itself: they may mean anything."""

    def __init__(
        self,
        linked: LinkedComponent,
        spelled: Callable[[str], str],
        users: Iterable[str],
        basic: Mapping[str, TypeForm],
    ) -> None:
        self._users = frozenset(users)
        self._basic, self._spelled = basic, spelled
        self._definitions: dict[str, list[tuple[str, LinkedModule, Struct | Enum | Sequence | Map]]] = {}
        self.modules: set[str] = set()
        for scope in linked.modules():
            module = spelled(scope.module.name)
            self.modules.add(module)
            for type_ in scope.module.types:
                self._definitions.setdefault(spelled(type_.name), []).append((module, scope, type_))

    def named(self, name: str, qualifiers: Iterable[str] = ()) -> TypeForm | None:
        """The form of a type with this name; None if it may be any."""
        found = self._definitions.get(name, [])
        modules = [one for one in qualifiers if one in self.modules]
        found = [one for one in found if not modules or one[0] == modules[-1]]
        if name in self._users and not modules:
            return None
        if len(found) != 1:
            # A module of these interfaces that lacks the type: it had it before.
            return TypeForm(name, (), modules[-1]) if modules and not found else None
        module, scope, definition = found[0]
        if isinstance(definition, Sequence):
            return TypeForm(LIST, (self._of(definition.element, scope),))
        if isinstance(definition, Map):
            return TypeForm(MAP, (self._of(definition.key, scope), self._of(definition.value, scope)))
        return TypeForm(name, (), module)

    def _of(self, ref: TypeRef, scope: LinkedModule) -> TypeForm | None:
        if ref.is_basic:
            return self._basic[ref.text]
        found = scope.find(ref)
        return (
            None if found is None else self.named(self._spelled(found[1].name), [self._spelled(found[0].module.name)])
        )


def differ(one: TypeForm | None, other: TypeForm | None) -> bool:
    """Whether two types are surely different."""
    if one is None or other is None:
        return False
    if one.head == ANY_OF:
        return all(differ(alternative, other) for alternative in one.arguments)
    if (one.head, one.module) != (other.head, other.module):
        return True
    pairs = zip(one.arguments, other.arguments, strict=False)
    is_longer = one.head == TUPLE and one.arguments and other.arguments and len(one.arguments) != len(other.arguments)
    return bool(is_longer) or any(differ(*pair) for pair in pairs)
