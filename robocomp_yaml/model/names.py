"""Which names can be identifiers."""

from __future__ import annotations


def is_identifier(name: str) -> bool:
    return name.isascii() and name.isidentifier() and not name.startswith("__")
