"""Patterns of logs have a time limit."""

from __future__ import annotations

import signal
import threading
import time

import pytest

from robocomp_yaml.deploy.patterns import WITHIN, PatternTooSlow, search

SLOW = [
    ("(a+)+$", "a" * 60 + "!"),
    (r"(\w+\s?)*:$", "word " * 30),
    ("(x|x)*y", "x" * 50),
    (r"^(([a-z])+.)+[A-Z]$", "a" * 60),
]


@pytest.mark.parametrize(
    ("pattern", "text", "expected"),
    [
        ("listening on", "now listening on 7", True),
        (r"^\[ok\]", "x [ok]", False),
        ("(a+)+$", "caaaa", True),
        ("é", "é", True),
    ],
)
def test_a_match(pattern: str, text: str, expected: bool) -> None:
    assert search(pattern, text) == expected


@pytest.mark.parametrize(("pattern", "text"), SLOW)
def test_a_pattern_that_takes_exponential_time(pattern: str, text: str) -> None:
    before, began = signal.getsignal(signal.SIGALRM), time.monotonic()
    with pytest.raises(PatternTooSlow):
        search(pattern, text)
    assert time.monotonic() - began < 40 * WITHIN
    assert signal.getsignal(signal.SIGALRM) is before and signal.getitimer(signal.ITIMER_REAL)[0] == 0


@pytest.mark.parametrize(("pattern", "text"), SLOW)
def test_in_another_thread(pattern: str, text: str) -> None:
    done = threading.Thread(target=search, args=(pattern, text), daemon=True)
    done.start()
    done.join(20)
    assert not done.is_alive()
