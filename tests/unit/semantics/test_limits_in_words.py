"""Ranges, sizes and types: what is within them, and how they are said."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import pytest

from robocomp_yaml.semantics import limits


@pytest.mark.parametrize(
    ("ends", "words", "within", "beyond"),
    [
        ({"at_least": 5, "at_most": 5}, "from 5 to 5", [5], [4, 6]),
        ({"at_least": 0, "below": 1}, "at least 0 and below 1", [0, 0.5], [-1, 1]),
        ({"above": 0, "at_most": 1}, "above 0 and at most 1", [0.5, 1], [0, 2]),
        ({"above": -1}, "above -1", [0], [-1]),
        ({}, "", [10**30], []),
    ],
)
def test_ranges(ends: dict[str, float], words: str, within: list[float], beyond: list[float]) -> None:
    assert limits.range_in_words(**ends) == words
    assert all(limits.holds(value, **ends) for value in within)
    assert not any(limits.holds(value, **ends) for value in beyond)


@pytest.mark.parametrize(
    ("least", "most", "words", "counts"),
    [
        (0, None, "at least 0", [0, 9]),
        (2, 2, "exactly 2", [2]),
        (0, 3, "at most 3", [0, 3]),
        (1, 3, "1 to 3", [1, 2, 3]),
    ],
)
def test_sizes(least: int, most: int | None, words: str, counts: list[int]) -> None:
    assert limits.size_in_words(least, most) == words
    assert all(limits.has_size(count, least, most) for count in counts)
    assert not limits.has_size(least - 1, least, most) and (most is None or not limits.has_size(most + 1, least, most))


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("bool", [True, False], [0, 1, "true", None]),
        ("string", ["", "1"], [1, True, None, b"x", ["x"]]),
        ("int", [0, -7, 2.0, 2**80], [True, 2.5, "2", nan, inf, None]),
        ("long", [2**63, 1e300], [False, 0.1, -inf, [], {}]),
        ("float", [0, 0.5, 1e300, 10**400], [True, "0.5", nan, inf, None]),
        ("double", [-1, 2.5], [False, "", -inf]),
    ],
)
def test_kinds(name: str, good: list[Any], bad: list[Any]) -> None:
    assert all(limits.is_of(name, data) for data in good)
    assert not any(limits.is_of(name, data) for data in bad)


@pytest.mark.parametrize(
    ("name", "value", "given", "fault"),
    [
        ("int", 2**31 - 1, {}, ""),
        ("int", 2**31, {}, limits.LIMIT),
        ("int", 2**31, {"ends": {"at_most": 9}}, limits.RANGE),
        ("int", 7, {"ends": {"at_most": 9, "above": 7}}, limits.RANGE),
        ("int", 8, {"ends": {"at_most": 9, "above": 7}}, ""),
        ("long", 2**31, {}, ""),
        ("float", 4e38, {}, limits.LIMIT),
        ("float", 10**400, {}, limits.LIMIT),
        ("double", 4e38, {}, ""),
        ("double", 0.5, {"values": [0.25, 0.5]}, ""),
        ("double", 0.75, {"values": [0.25, 0.5]}, limits.CHOICE),
        ("string", "b", {"values": ("a",)}, limits.CHOICE),
        ("string", "b", {"matches": str.isdigit}, limits.PATTERN),
        ("string", "7", {"matches": str.isdigit}, ""),
        ("bool", False, {}, ""),
        ("Colour", "red", {"values": ("red",)}, ""),
    ],
)
def test_what_is_not_allowed(name: str, value: Any, given: dict[str, Any], fault: str) -> None:
    assert limits.outside(name, value, **given) == fault


def test_what_a_type_can_hold() -> None:
    assert limits.bounds("int") == "from -2147483648 to 2147483647 (int)"
    assert limits.bounds("float").endswith(" (float)")


def test_which_values_there_are() -> None:
    assert limits.one_of(("a", "b")) == "one of a, b"
    assert limits.one_of(("a", "b"), secret=True) == "one of the 2 values allowed"
