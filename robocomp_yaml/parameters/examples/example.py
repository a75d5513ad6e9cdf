"""An example of a parameter: its default, or else the simplest valid value."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import Any

from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    ResolvedMember,
    ScalarType,
    Size,
    Type,
    is_secret,
)
from robocomp_yaml.semantics.limits import LIMITS
from robocomp_yaml.parameters.patterns.example_text import example_texts
from robocomp_yaml.parameters.hidden import hidden

_MOST = 16  # different values of one type
_LARGEST = 1024  # entries of an example


def example(member: ResolvedMember) -> object:
    """An example of a member, without secrets."""
    if isinstance(member.type, (BasicType, EnumType)) and member.type.secret:
        return reference(member.name)
    if member.default is not None and not is_secret(member.type):
        return hidden(member.type, member.default.data)
    return example_of(member.type)


def reference(name: str) -> dict[str, str]:
    """The reference to the environment variable for a secret of this name: secrets are not in documents."""
    made = re.sub(r"[^A-Z0-9]+", "_", re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).upper()).strip("_")
    return {"env": made if made[:1].isalpha() else f"SECRET_{made}".rstrip("_")}


def example_of(type_: Type) -> object:
    match type_:
        case EnumType() | BasicType():
            return next(simplest(type_))
        case ListType(element=element, size=size, unique=unique):
            return _different(element, count_of(size)) if unique else [example_of(element)] * count_of(size)
        case MapType(element=element, size=size):
            return {f"name{index or ''}": example_of(element) for index in range(count_of(size))}
        case _:
            return {m.name: example(m) for m in type_.members if not m.optional}


def count_of(size: Size, preferred: int | None = None) -> int:
    """The number of elements of an example: the preferred number (1 if None), or the nearest allowed one."""
    count = max(1 if preferred is None else preferred, size.least)
    return min(count, _LARGEST if size.most is None else size.most)


def _different(element: Type, count: int) -> list[object]:
    """Different elements, as far as they are known. The others repeat the last one, and the user must change them."""
    plain = element if isinstance(element, (EnumType, BasicType)) else None
    entries = list(islice(simplest(plain), count)) if plain else [example_of(element)]
    return entries + entries[-1:] * (count - len(entries))


def simplest(type_: ScalarType) -> Iterator[object]:
    """Different valid values, the simplest first; at least one."""
    if type_.secret:
        yield from ({"env": f"SECRET{number}" if number > 1 else "SECRET"} for number in range(1, _MOST + 1))
    elif isinstance(type_, EnumType):
        yield from type_.allowed
    elif type_.values:
        is_text = type_.name == "string"
        yield from (str(literal.value) if is_text else literal.value for literal in type_.values)
    elif type_.name == "bool":
        yield from (False, True)
    elif type_.name != "string":
        yield from _numbers(type_)
    elif type_.pattern:
        yield from islice(example_texts(type_.pattern), _MOST)
    else:
        yield from ("text", *(f"text{number}" for number in range(2, _MOST + 1)))


def _numbers(type_: BasicType) -> Iterator[int | float]:
    """The valid number nearest to zero, then its neighbours in steps of 1 or, in a narrow range, less."""
    first = _nearest(type_)
    yield first
    for step in (1, -1) if type_.is_integer else (1, -1, 1 / 64, -1 / 64):
        others = (first + number * step for number in range(1, _MOST))
        yield from (other for other in others if type_.range is None or type_.range.holds(other))


def _nearest(type_: BasicType) -> int | float:
    if type_.range is None or type_.range.holds(0):
        return 0
    low, high = type_.range.low, type_.range.high
    if low is not None and not low.is_open:
        return low.value
    if high is not None and not high.is_open:
        return high.value
    if type_.is_integer:
        return int(low.value) + 1 if low is not None else int(high.value) - 1  # type: ignore[union-attr]
    if low is not None and high is not None:
        return (low.value + high.value) / 2
    return low.value + 1 if low is not None else high.value - 1  # type: ignore[union-attr]
