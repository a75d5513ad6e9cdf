"""Enums and structs: that they hold something, and that the numbers of an enum are its own."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.interface import Enum, Enumerator, Struct

LARGEST = 2**31 - 1


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        for definition in linked.module.types:
            if isinstance(definition, Enum):
                yield from _numbers(definition)
                if not definition.enumerators:
                    yield codes.EMPTY_TYPE.at(
                        definition.list_span,
                        kind="enum",
                        name=definition.name,
                        parts="enumerators",
                        hint="name at least one: {enum: [first]}",
                    )
            elif isinstance(definition, Struct) and not definition.members:
                yield codes.EMPTY_TYPE.at(
                    definition.list_span,
                    kind="struct",
                    name=definition.name,
                    parts="members",
                    hint="give it a member: {struct: {x: float}}",
                )


def _numbers(enum: Enum) -> Iterator[Diagnostic]:
    first: dict[int, Enumerator] = {}
    number = -1
    for enumerator in enum.enumerators:
        number = number + 1 if enumerator.value is None else enumerator.value
        if not 0 <= number <= LARGEST:
            yield codes.ENUM_NUMBER.at(
                enumerator.span,
                name=enumerator.name,
                number=number,
                largest=LARGEST,
                hint="give it a number of its own: an enumerator without one has one more than the one before",
            )
            continue
        other = first.setdefault(number, enumerator)
        if other is not enumerator:
            yield codes.ENUM_NUMBER_TWICE.at(
                enumerator.span,
                name=enumerator.name,
                other=other.name,
                number=number,
                hint="give one of them another number",
                related=[Related(f"'{other.name}' stands here", other.span)],
            )
