# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Events of state machines: descriptors that match them, and delays."""

from __future__ import annotations

import re
from collections.abc import Iterable

_DELAY = re.compile(r"\+?(\d+(?:\.\d*)?|\.\d+)\s*(ms|s)")


def beginning(descriptor: str) -> str:
    """The words with which the name of a matching event begins; '' where every event matches."""
    plain = descriptor[:-2] if descriptor.endswith(".*") else descriptor.rstrip(".")
    return "" if plain == "*" else plain


def matches(descriptors: Iterable[str], name: str) -> bool:
    """Whether one of the descriptors matches: `door` matches `door` and `door.open`, `*` matches every event."""
    for descriptor in descriptors:
        plain = beginning(descriptor)
        if not plain or name == plain or name.startswith(plain + "."):
            return True
    return False


def seconds(delay: str) -> float | None:
    """The seconds of a delay such as `1.5s` or `100ms`; None if the text is not a delay."""
    found = _DELAY.fullmatch(delay.strip())
    return None if found is None else float(found[1]) / (1000 if found[2] == "ms" else 1)
