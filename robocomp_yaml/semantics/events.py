# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Events of state machines: which ones a descriptor matches, and when those come that are sent with a delay."""

from __future__ import annotations

import re
from collections.abc import Iterable

_DELAY = re.compile(r"\+?(\d+(?:\.\d*)?|\.\d+)\s*(ms|s)")


def beginning(descriptor: str) -> str:
    """What an event's name begins with to match this, word by word; '' matches all."""
    plain = descriptor[:-2] if descriptor.endswith(".*") else descriptor.rstrip(".")
    return "" if plain == "*" else plain


def matches(descriptors: Iterable[str], name: str) -> bool:
    """`door` matches `door` and `door.open`; `*` matches everything."""
    for descriptor in descriptors:
        plain = beginning(descriptor)
        if not plain or name == plain or name.startswith(plain + "."):
            return True
    return False


def seconds(delay: str) -> float | None:
    """Of `1.5s` and `100ms`; None for what is no delay."""
    found = _DELAY.fullmatch(delay.strip())
    return None if found is None else float(found[1]) / (1000 if found[2] == "ms" else 1)
