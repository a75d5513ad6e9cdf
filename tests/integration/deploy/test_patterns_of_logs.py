"""Patterns of logs have a time limit, in every thread."""

from __future__ import annotations

import re
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml.deploy.patterns import WITHIN, PatternTooSlow, search

SLOW = [(r"(a|aa)+b?\1c", "a" * 60 + "!"), (r"(.+)+(.+)+(.+)+\d\1", "ab" * 60)]
EXPONENTIAL_FOR_PYTHON = [
    ("(a+)+$", "a" * 60 + "!"),
    (r"(\w+\s?)*:$", "word " * 30),
    (r"^(([a-z])+.)+[A-Z]$", "a" * 60),
]


@pytest.mark.parametrize(
    ("pattern", "text", "expected"),
    [
        ("listening on", "now listening on 7", True),
        (r"^\[ok\]", "x [ok]", False),
        ("(a+)+$", "caaaa", True),
        (r"(\d+ )+ready", "at 12 30 45 and a long line before it: 7 8 9 ready", True),
        ("é", "é", True),
        ("(?i)READY", "ready", True),
    ],
)
def test_a_match(pattern: str, text: str, expected: bool) -> None:
    assert search(pattern, text) == expected
    with ThreadPoolExecutor(1) as others:
        assert others.submit(search, pattern, text).result() == expected


@pytest.mark.parametrize(("pattern", "text"), EXPONENTIAL_FOR_PYTHON)
def test_a_pattern_that_takes_python_exponential_time(pattern: str, text: str) -> None:
    assert not search(pattern, text)


@pytest.mark.parametrize(("pattern", "text"), SLOW)
def test_a_pattern_that_takes_too_long(pattern: str, text: str) -> None:
    began = time.monotonic()
    with pytest.raises(PatternTooSlow):
        search(pattern, text)
    with ThreadPoolExecutor(1) as others, pytest.raises(PatternTooSlow):
        others.submit(search, pattern, text).result()
    assert time.monotonic() - began < 80 * WITHIN


PIECES = ["a", "b", " ", ".", r"\d", r"\w", r"\b", "[ab]", "[^a]", "(a|b)", "(?:ab)", "(?=a)", "^", "$", r"\[", "é"]
PATTERNS = st.lists(
    st.tuples(st.sampled_from(PIECES), st.sampled_from(["", "", "*", "+", "?", "{1,3}", "+?"])), max_size=5
)


@given(PATTERNS.map(lambda parts: "".join(piece + times for piece, times in parts)), st.text("ab1 [é.", max_size=12))
def test_it_matches_as_python_does(pattern: str, text: str) -> None:
    try:
        expected = re.search(pattern, text) is not None
    except re.error:  # such as `^*`
        return
    assert search(pattern, text) == expected
