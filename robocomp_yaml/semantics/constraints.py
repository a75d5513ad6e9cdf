# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Constraints between values, in three-valued logic: an unknown value, such as a missing optional one, is None.

The result of an operation with an unknown operand is unknown, unless the other operands decide. An unknown constraint
holds.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

Part = Callable[[], Any]


@dataclass(frozen=True)
class Constraint:
    """`text` is the expression as the document spells it, `otherwise` the message where it does not hold."""

    text: str
    otherwise: str
    value: Callable[[Any], Any]

    def holds(self, values: Any) -> bool:
        return holds(lambda: self.value(values))


class _Unknown(Exception):
    """The elements of an unknown list are needed."""


def holds(part: Part) -> bool:
    """Whether a part is true or unknown. A division by zero or a missing element does not hold."""
    try:
        return part() is not False
    except (ArithmeticError, LookupError, ValueError):
        return False


def every(*parts: Part) -> Any:
    return all_of(part() for part in parts)


def some(*parts: Part) -> Any:
    return any_of(part() for part in parts)


def opposite(truth: Any) -> Any:
    return None if truth is None else not truth


def attribute(owner: Any, name: str) -> Any:
    return None if owner is None else getattr(owner, name)


def entry(owner: Any, index: Any) -> Any:
    if owner is None or index is None:
        return None
    if isinstance(index, int) and index < 0:
        raise LookupError(index)
    return owner[index]


_BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "%": operator.mod,
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
    "in": lambda one, many: one in many, "not in": lambda one, many: one not in many,
}  # fmt: skip


def arithmetic(sign: str, left: Any, right: Any = 0) -> Any:
    return None if left is None or right is None else _BINARY[sign](left, right)


def compare(first: Any, *rest: Any) -> Any:
    """`compare(a, "<", b, "<=", c)`."""
    return all_of(compared(first, zip(rest[::2], rest[1::2])))


def compared(left: Any, rest: Iterable[tuple[str, Any]]) -> Iterator[Any]:
    """The result of each comparison of a chain."""
    for sign, right in rest:
        unknown = left is None or right is None or (isinstance(right, tuple) and None in right)
        yield None if unknown else _BINARY[sign](left, right)
        left = right


def known(many: Any) -> Any:
    """The list itself. Raises _Unknown if it is unknown."""
    if many is None:
        raise _Unknown
    return many


def when(condition: Any, element: Part) -> Iterator[Any]:
    """The element if the condition is true, None if the condition is unknown."""
    if condition is None:
        yield None
    elif condition:
        yield element()


def call(function: Callable[[Any], Any], operand: Part) -> Any:
    """The result of a function; None if the operand, or an element of it, is unknown."""
    try:
        argument = operand()
        if argument is None:
            return None
        if function is all:
            return all_of(argument)
        if function is any:
            return any_of(argument)
        if isinstance(argument, Iterator):
            argument = tuple(argument)
        return None if isinstance(argument, tuple) and None in argument else function(argument)
    except _Unknown:
        return None


def unique(parts: Iterable[Any]) -> bool:
    every_one = tuple(parts)
    return len(set(every_one)) == len(every_one)


def keys(mapping: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(mapping)


def values(mapping: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple(mapping.values())


FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "len": len, "min": min, "max": max, "abs": abs, "sum": sum, "all": all, "any": any, "unique": unique, "keys": keys,
    "values": values,
}  # fmt: skip


def all_of(parts: Iterable[Any]) -> Any:
    return _decided(parts, False)


def any_of(parts: Iterable[Any]) -> Any:
    return _decided(parts, True)


def _decided(parts: Iterable[Any], by: bool) -> Any:
    """`by` if a part equals it, else None if a part is unknown, else the opposite of `by`."""
    unknown = False
    for part in parts:
        if part is None:
            unknown = True
        elif bool(part) is by:
            return by
    return None if unknown else not by
