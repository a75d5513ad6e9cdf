"""Patterns are matched in a time that their size bounds, and match what Python says that they match."""

from __future__ import annotations

import random
import re
import time

import pytest

from robocomp_yaml.parameters.patterns.pattern import NotPortable, parse

ATOMS = ["a", "b", "[ab]", "[^a]", ".", "\\d", "\\.", "[\\]\\\\a-c]", "\\*", "\\|", "[^)|(]", "()"]
COUNTS = ["*", "+", "?", "{2}", "{1,3}", "{0,2}", "{2,}", "{0}", "{0,}"]


def some(chance: random.Random, depth: int = 0) -> str:
    match chance.randrange(8 if depth < 4 else 1):
        case 1 | 2:
            return some(chance, depth + 1) + some(chance, depth + 1)
        case 3:
            return f"({some(chance, depth + 1)}|{some(chance, depth + 1)})"
        case 4:
            return f"({some(chance, depth + 1)}|)"
        case 5 | 6:
            return f"({some(chance, depth + 1)}){chance.choice(COUNTS)}"
        case _:
            return chance.choice(ATOMS)


def test_it_matches_what_python_matches() -> None:
    chance, matched = random.Random(10), 0
    for _ in range(800):
        pattern = parse(some(chance))
        known = re.compile(pattern.portable)
        for _ in range(10):
            text = "".join(chance.choice("aab.1]\\*|()\n") for _ in range(chance.randrange(7)))
            assert pattern.matches(text) is (known.fullmatch(text) is not None), (pattern, text)
            matched += pattern.matches(text)
    assert matched > 300


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
