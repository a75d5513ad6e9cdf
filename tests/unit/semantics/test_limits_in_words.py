"""Ranges, sizes and types: what is within them, and how they are said."""

from __future__ import annotations

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
        (1, 3, "from 1 to 3", [1, 2, 3]),
    ],
)
def test_sizes(least: int, most: int | None, words: str, counts: list[int]) -> None:
    assert limits.size_in_words(least, most) == words
    assert all(limits.has_size(count, least, most) for count in counts)
    assert not limits.has_size(least - 1, least, most) and (most is None or not limits.has_size(most + 1, least, most))


def test_what_a_type_cannot_hold() -> None:
    assert limits.beyond("int", 2**31) == "from -2147483648 to 2147483647 (int)"
    assert limits.beyond("long", 2**31) == limits.beyond("float", 3e38) == ""
    assert limits.beyond("float", 4e38).endswith(" (float)")


def test_which_values_there_are() -> None:
    assert limits.one_of(("a", "b")) == "one of a, b"
    assert limits.one_of(("a", "b"), secret=True) == "one of the 2 values allowed"
