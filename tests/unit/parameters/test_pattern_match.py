"""Patterns are matched in a time that their size bounds; `tests/properties/test_random_patterns.py` has what they
match."""

from __future__ import annotations

import time

import pytest

from robocomp_yaml.parameters.patterns.pattern import NotPortable, parse


@pytest.mark.parametrize(
    ("text", "value"),
    [("(a+)+$", "a" * 100 + "!"), ("(a|a)*b", "a" * 10_000), ("(.*a){25}", "a" * 1000 + "b"), ("(x+x+)+y", "x" * 10_000),
     ("(a?){30}a{30}", "a" * 29), ("a*a*a*a*a*b", "a" * 10_000), ("(()*)*b", "a")],
)  # fmt: skip
def test_none_takes_years(text: str, value: str) -> None:
    begin = time.process_time()
    assert not parse(text).matches(value)
    assert time.process_time() - begin < 2


@pytest.mark.parametrize(
    "text", ["((a{900}){900}){900}", "(a{0,1000}){0,6}", "(" * 15 + "a" + "){9}" * 15, "a{1000}" * 6]
)
def test_counts_of_counts_are_limited(text: str) -> None:
    with pytest.raises(NotPortable, match="its counts add up to more than 5000 characters"):
        parse(text)
    assert parse("([a-z]{1,63}[.]){1,10}[a-z]{1,1000}").matches("www.example.org")
