# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Which events a descriptor of a transition matches: `door` matches `door` and `door.open`; `*` matches everything."""

from __future__ import annotations

from collections.abc import Iterable


def beginning(descriptor: str) -> str:
    """What an event's name begins with to match this, word by word; '' matches all."""
    plain = descriptor[:-2] if descriptor.endswith(".*") else descriptor.rstrip(".")
    return "" if plain == "*" else plain


def matches(descriptors: Iterable[str], name: str) -> bool:
    for descriptor in descriptors:
        plain = beginning(descriptor)
        if not plain or name == plain or name.startswith(plain + "."):
            return True
    return False
