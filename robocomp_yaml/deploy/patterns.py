"""Regular expressions of users, matched within a time limit: some take exponential time, such as `(a+)+$`.

Python's engine handles signals while it matches, so that a timer can end it. This works in the main thread only, where
commands run; in another thread, a line that is long is not matched at all.
"""

from __future__ import annotations

import re
import signal
import threading
from types import FrameType

WITHIN = 0.25
"""Seconds for one line."""

_SHORT = 20  # characters that even an exponential pattern matches in milliseconds


class PatternTooSlow(Exception):
    """A match took longer than WITHIN seconds."""


def search(pattern: str, text: str) -> bool:
    """Whether a line contains a match. Raises PatternTooSlow."""
    compiled = re.compile(pattern)
    if threading.current_thread() is not threading.main_thread():
        return compiled.search(text[:_SHORT]) is not None if _is_nested(pattern) else compiled.search(text) is not None

    def stop(number: int, frame: FrameType | None) -> None:
        raise PatternTooSlow

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, WITHIN)
    try:
        return compiled.search(text) is not None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _is_nested(pattern: str) -> bool:
    """Whether a pattern repeats a group, which is what takes exponential time."""
    return re.search(r"\)[*+{]", pattern) is not None
