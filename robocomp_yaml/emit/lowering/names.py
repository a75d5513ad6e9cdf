"""Names in code, each handed out once."""

from __future__ import annotations

from collections.abc import Iterable


class NameAllocator:
    """Hands out names: what is taken gets an underscore at its end, and another one if need be."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)

    def take(self, *candidates: str) -> str:
        """The first candidate that is free; else the last one with underscores."""
        name = next((name for name in candidates if name not in self._taken), candidates[-1])
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name
