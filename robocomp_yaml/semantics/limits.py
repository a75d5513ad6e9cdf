# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""What values of a type may be: kinds, ranges and sizes, and these in words."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from math import isfinite, trunc
from numbers import Integral, Real
from typing import Any, Union

Number = Union[int, float]
LIMITS: dict[str, tuple[Number, Number]] = {
    "int": (-(2**31), 2**31 - 1),
    "long": (-(2**63), 2**63 - 1),
    "float": (-3.4028234663852886e38, 3.4028234663852886e38),
    "double": (-1.7976931348623157e308, 1.7976931348623157e308),
}
INTEGERS = ("int", "long")
WORDS = {"bool": "true or false", "string": "text", "int": "a whole number", "long": "a whole number"}
WORDS |= dict.fromkeys(("float", "double"), "a number")
"""The values of a plain type in words, for messages."""
LIST, MAP = "a list", "a mapping of names to values"


def record_in_words(names: Collection[str]) -> str:
    """A record with these members in words, for messages."""
    return f"a mapping of {', '.join(names)}"


def one_of(values: Collection[str], secret: bool = False) -> str:
    """The allowed values in words, for messages; of a secret only their number."""
    return f"one of the {len(values)} values allowed" if secret else f"one of {', '.join(values)}"


def is_of(type_: str, data: Any) -> bool:
    """Whether data has the kind of a plain type. A bool is not a number, 2.0 is a whole number, and NaN and infinities
    are not numbers."""
    if type_ == "bool":
        return isinstance(data, bool)
    if type_ not in LIMITS:
        return isinstance(data, str)
    if type(data) is int:  # most are, and the general test of numbers is slow
        return True
    if isinstance(data, bool) or not isinstance(data, Real):
        return False
    return isinstance(data, Integral) or (isfinite(data) and (type_ not in INTEGERS or data == trunc(data)))


CHOICE, PATTERN, RANGE, LIMIT = "choice", "pattern", "range", "limit"


def outside(
    type_: str,
    value: Any,
    values: Collection[Any] = (),
    ends: Mapping[str, Number] | None = None,
    matches: Callable[[str], bool] | None = None,
) -> str:
    """Why a value of the right kind is not allowed: CHOICE if it is not one of `values`, PATTERN if a text does not
    match, RANGE if a number is outside `ends` (the arguments of `holds`), LIMIT if it does not fit its type; else
    ''."""
    if values:
        return "" if value in values else CHOICE
    if type_ not in LIMITS:
        return "" if matches is None or matches(value) else PATTERN
    if ends and not holds(value, **ends):
        return RANGE
    least, most = LIMITS[type_]
    return "" if least <= value <= most else LIMIT


def bounds(type_: str) -> str:
    """The numbers that fit a type, in words: `from -2147483648 to 2147483647 (int)`."""
    least, most = LIMITS[type_]
    return f"from {least} to {most} ({type_})"


def holds(
    value: Number,
    at_least: Number | None = None,
    at_most: Number | None = None,
    above: Number | None = None,
    below: Number | None = None,
) -> bool:
    """Whether a number is within limits: `at_least` and `at_most` are inclusive, `above` and `below` exclusive."""
    return not (
        (at_least is not None and value < at_least)
        or (at_most is not None and value > at_most)
        or (above is not None and value <= above)
        or (below is not None and value >= below)
    )


def range_in_words(at_least: object = None, at_most: object = None, above: object = None, below: object = None) -> str:
    """`from 0 to 2`, `at least 0`, `above 0 and at most 5`."""
    if at_least is not None and at_most is not None:
        return f"from {at_least} to {at_most}"
    ends = {"at least": at_least, "above": above, "at most": at_most, "below": below}
    return " and ".join(f"{word} {end}" for word, end in ends.items() if end is not None)


def has_size(count: int, least: int, most: int | None) -> bool:
    return least <= count and (most is None or count <= most)


def size_in_words(least: int, most: int | None) -> str:
    """`at least 1`, `exactly 3`, `1 to 4`, `at most 4`."""
    if most is None:
        return f"at least {least}"
    if least == most:
        return f"exactly {least}"
    return f"{least} to {most}" if least else f"at most {most}"


def elements(count: int) -> str:
    """`1 element`, `3 elements`."""
    return f"{count} element{'' if count == 1 else 's'}"
