"""Allocates unique names in code."""

from __future__ import annotations

from collections.abc import Iterable


class NameAllocator:
    """Allocates names: a name that is already taken gets underscores at its end."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)

    def allocate(self, *candidates: str) -> str:
        """Allocates the first candidate that is free, else the last one with underscores, and returns it."""
        name = next((name for name in candidates if name not in self._taken), candidates[-1])
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name
