"""Types of parameters as components have them, to read properties exactly as a component does."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.patterns.pattern import Pattern
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    ResolvedMember,
    Size,
    Type,
)
from robocomp_yaml.semantics import composite, plain


class _Text(plain.TextKind):
    """Text that is matched as the compiler does, in a bounded time."""

    def __init__(self, values: tuple[str, ...], pattern: Pattern | None) -> None:
        super().__init__(values, shown_as="" if pattern is None else pattern.text)
        self._matching = pattern

    def matches(self, value: str) -> bool:
        return self._matching is None or self._matching.matches(value)


def recording(record: RecordType) -> composite.RecordKind:
    members = {
        f"m{number}": composite.member(
            kind(member.type),
            key=member.name,
            optional=member.optional,
            **_default(member),
        )
        for number, member in enumerate(record.members)
    }
    return composite.RecordKind(type("Values", (composite.Record,), members), is_group=record.is_group)


def kind(type_: Type) -> composite.Kind:
    match type_:
        case BasicType(name="bool"):
            made: plain.PlainKind = plain.truth()
        case BasicType(name="string", values=values, pattern=pattern):
            made = _Text(tuple(str(literal.value) for literal in values), pattern)
        case BasicType(name=name, values=values, range=limits, unit=unit):
            numbers: Any = tuple(literal.value for literal in values)
            number = plain.whole if type_.is_integer else plain.decimal
            made = number(name, values=numbers, unit=unit, **(limits.limits if limits else {}))
        case EnumType(name=name, allowed=allowed):
            made = plain.choice(name, *allowed)
        case ListType(element=element, size=size, unique=unique):
            return composite.listing(kind(element), unique=unique, **_size(size))
        case MapType(element=element, size=size):
            return composite.naming(kind(element), **_size(size))
        case RecordType():
            return recording(type_)
    return plain.secret(made) if type_.secret else made


def _default(member: ResolvedMember) -> dict[str, Any]:
    return {} if member.default is None else {"default": member.default.data}


def _size(size: Size) -> dict[str, Any]:
    return {"at_least": size.least, "at_most": size.most}
