"""What comes of values that are not known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robocomp_yaml.semantics import constraints


def late(*values: Any) -> list[Callable[[], Any]]:
    return [lambda value=value: value for value in values]


@pytest.mark.parametrize(
    ("parts", "every", "some"),
    [
        ((True, None), None, True),
        ((False, None), False, None),
        ((None, True, False), False, True),
        ((True, True), True, True),
        ((), True, False),
    ],
)
def test_the_rest_may_decide(parts: tuple[Any, ...], every: Any, some: Any) -> None:
    assert constraints.every(*late(*parts)) is every
    assert constraints.some(*late(*parts)) is some


def test_what_is_made_of_it_is_unknown() -> None:
    assert constraints.arithmetic("+", None, 1) is None
    assert constraints.opposite(None) is None
    assert constraints.attribute(None, "x") is None
    assert constraints.entry(None, 0) is None
    assert constraints.call(min, lambda: iter((1, None))) is None
    assert constraints.call(sum, lambda: constraints.known(None)) is None


def test_comparisons_of_a_chain() -> None:
    assert constraints.compare(1, "<", 2, "<", None) is None
    assert constraints.compare(2, "<", 1, "<", None) is False
    assert constraints.compare(1, "in", (None, 1)) is None, "which one it is is not known"
    assert constraints.compare(1, "<", 2, "<=", 2) is True


@pytest.mark.parametrize(
    ("part", "holds"),
    [
        (lambda: None, True),
        (lambda: 0, True),
        (lambda: False, False),
        (lambda: constraints.arithmetic("/", 1, 0), False),
        (lambda: constraints.entry((1, 2), -1), False),
        (lambda: constraints.entry({"a": 1}, "b"), False),
        (lambda: constraints.call(min, lambda: ()), False),
    ],
)
def test_what_has_no_value_does_not_hold(part: Callable[[], Any], holds: bool) -> None:
    assert constraints.holds(part) == holds
