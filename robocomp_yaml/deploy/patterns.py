"""Regular expressions of users, matched within a time limit: some take exponential time, such as `(a|aa)+b?\\1c`.

Python's own engine has no time limit. `regex` has one in every thread, and reads Python's patterns as Python does.
"""

from __future__ import annotations

WITHIN = 0.25
"""Seconds for one line."""


class PatternTooSlow(Exception):
    """A match took longer than WITHIN seconds."""


def search(pattern: str, text: str) -> bool:
    """Whether a line contains a match of a pattern that `re` accepts. Raises PatternTooSlow."""
    import regex  # only deployments with such a pattern need it

    try:
        return regex.search(pattern, text, timeout=WITHIN, concurrent=True) is not None
    except TimeoutError as error:
        raise PatternTooSlow from error
