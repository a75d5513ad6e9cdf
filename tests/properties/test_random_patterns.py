"""Patterns match what Python says that they match."""

from __future__ import annotations

import random
import re

from robocomp_yaml.parameters.patterns.pattern import parse

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
