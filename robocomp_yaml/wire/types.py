"""The types that linked modules define, as Ice carries them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import IcePy

from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model import interface as model
from robocomp_yaml.model.interface import TypeRef
from robocomp_yaml.wire.composites import MapOf, Members, SequenceOf, Struct
from robocomp_yaml.wire.values import Enumeration, Real, Text, Truth, Whole, WireType


class Types:
    """The types of linked modules, each made once."""

    def __init__(self) -> None:
        wholes = [Whole("byte", IcePy._t_byte), Whole("short", IcePy._t_short), Whole("int", IcePy._t_int)]
        reals = [Real("float", IcePy._t_float), Real("double", IcePy._t_double)]
        others = [Truth("bool", IcePy._t_bool), Whole("long", IcePy._t_long), Text("string", IcePy._t_string)]
        self._basic: Mapping[str, WireType] = {one.name: one for one in (*wholes, *reals, *others)}
        self._made: dict[tuple[LinkedModule, str], WireType] = {}

    def of(self, scope: LinkedModule, ref: TypeRef) -> WireType:
        """The type that a reference in a module names. The module has passed every check."""
        if ref.is_basic:
            return self._basic[ref.text]
        found = scope.find(ref)
        assert found is not None, ref.text
        owner, definition = found
        if (owner, definition.name) not in self._made:
            self._made[owner, definition.name] = self._define(owner, definition)
        return self._made[owner, definition.name]

    def members(self, scope: LinkedModule, members: Sequence[model.Member]) -> Members:
        return Members([(member, self.of(scope, member.type)) for member in members])

    def _define(self, scope: LinkedModule, definition: object) -> WireType:
        match definition:
            case model.Enum():
                return Enumeration(id_of(scope, definition.name), definition)
            case model.Struct():
                return Struct(id_of(scope, definition.name), definition, self.members(scope, definition.members))
            case model.Sequence():
                return SequenceOf(id_of(scope, definition.name), definition.name, self.of(scope, definition.element))
            case model.Map():
                key, value = self.of(scope, definition.key), self.of(scope, definition.value)
                return MapOf(id_of(scope, definition.name), definition.name, key, value)
        raise AssertionError(definition)


def id_of(scope: LinkedModule, name: str) -> str:
    """The type id that Ice gives a definition: `::RoboCompMouth::Mouth`."""
    return f"::{scope.module.name}::{name}"
