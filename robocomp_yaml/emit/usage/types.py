"""What values of the types of interfaces have: members of structs and exceptions, elements of sequences and maps."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robocomp_yaml.emit.lowering.ports import LoweredPorts
from robocomp_yaml.emit.lowering.types import results
from robocomp_yaml.emit.usage.offer import (
    OTHER,
    PLAIN,
    RESULTS,
    STRUCT,
    UNKNOWN,
    Natives,
    Offer,
    OfferedMember,
    of_list,
    of_map,
    plain,
)
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.interface import Enum, ExceptionType, Map, Method, Sequence, Struct, TypeRef

_Members = Callable[[str], bool]


class OfferedTypes:
    """The offers of types in one language. `in_code` makes the name of a member, `others` are members that every
    struct has, or every exception; `lists` are names that no list has, each with a hint. `natives` count for values
    that the code has not made: a member of a struct may be set to any value that Ice accepts."""

    def __init__(
        self, in_code: Callable[[str], str], of_structs: _Members, of_exceptions: _Members,
        lists: Mapping[str, str] = {}, natives: Natives = UNKNOWN,
    ) -> None:  # fmt: skip
        self._lists, self._natives = lists, natives
        self._in_code, self._of_structs, self._of_exceptions = in_code, of_structs, of_exceptions
        self._made: dict[tuple[LinkedModule, str], Offer | None] = {}

    def of(self, ref: TypeRef, scope: LinkedModule, *, is_member: bool = False) -> Offer | None:
        """What a value of a type has; None if it is unknown."""
        if ref.is_basic:
            return plain(ref.text, {} if is_member else self._natives)
        found = scope.find(ref)
        return self.of_definition(found[1], found[0], is_member=is_member) if found is not None else None

    def of_definition(self, definition: object, home: LinkedModule, *, is_member: bool = False) -> Offer | None:
        """What a value of the type has that a module defines."""
        natives = {} if is_member else self._natives
        match definition:
            case Struct(name=name) | ExceptionType(name=name):
                key = home, name
                if key not in self._made:
                    self._made[key] = None  # while it is made
                    members = {self._in_code(one.name): OfferedMember(self.of(one.type, home, is_member=True))
                               for one in definition.members}  # fmt: skip
                    is_struct = isinstance(definition, Struct)
                    others = self._of_structs if is_struct else self._of_exceptions
                    self._made[key] = Offer(STRUCT, name, members, others=others)
                return self._made[key]
            case Sequence(element=ref):
                element = self.of(ref, home, is_member=is_member)
                return of_list(element, self._lists, natives) if ref.text != "byte" else of_list(element)
            case Map(value=ref):
                return of_map(self.of(ref, home, is_member=is_member), natives)
            case Enum(name=name):
                return Offer(PLAIN, name, is_complete=False)
            case _:
                return None

    def result(self, method: Method, scope: LinkedModule, *, tuples: bool) -> Offer | None:
        """What a call returns. With `tuples`, several results are a tuple; else only the returned value counts."""
        refs = results(method) if tuples else [method.returns] if method.returns is not None else []
        if len(refs) == 1:
            return self.of(refs[0], scope)
        items = tuple(self.of(ref, scope) for ref in refs)
        return Offer(RESULTS, method.name, count=len(refs), items=items, others=("count", "index").__contains__)

    def arguments(self, ports: LoweredPorts) -> Offer:
        """The arguments that the methods of the user's class get, by method and position."""
        found = {
            called.name: OfferedMember(Offer(OTHER, members={
                str(number): OfferedMember(self.of(member.type, called.port.scope))
                for number, member in enumerate(called.method.inputs)
            }, is_complete=False))
            for service in (*ports.implements, *ports.subscribes) for called in service.methods
        }  # fmt: skip
        return Offer(OTHER, members=found, is_complete=False)
