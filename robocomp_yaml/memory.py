"""Results of passes that are kept from one analysis to the next.

A pass is a pure function: equal input gives an equal result. Memory holds the last result of each part of a pass,
together with its causes, which are everything that it depends on. As long as the causes are equal, the result is the
same object, so that it is again an equal cause of later passes. An analysis without a past has an empty memory.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Any, TypeVar

_Kept = TypeVar("_Kept")


class Memory:
    """`on_make` is called before each result is made, and may raise an exception
    to end the analysis. With `once`, it is for one analysis, after which nothing is edited."""

    def __init__(self, *, once: bool = False) -> None:
        self.on_make: Callable[[], None] = lambda: None
        self._results: dict[Hashable, tuple[tuple[Any, ...], Any]] = {}
        self._parts: dict[Hashable, dict[Any, Any]] | None = None if once else {}
        self._within: dict[Hashable, set[Hashable]] = {}  # what was used for a result
        self._making: list[set[Hashable]] = []
        self._used: set[Hashable] = set()
        self._used_before: set[Hashable] = set()

    def result(
        self, part: Hashable, causes: tuple[Any, ...], make: Callable[[], _Kept],
        holds: Callable[[_Kept], bool] = lambda kept: True,
    ) -> _Kept:  # fmt: skip
        """The result of `make` for this part of a pass: the kept one if its causes are the same. Only one result is
        kept for each part. `holds` is for causes that are known only with a result: whether they are still the same."""
        known = self._results.get(part)
        if known is not None and _is_same(known[0], causes) and holds(known[1]):
            self._use(part)
            result: _Kept = known[1]
            return result
        self.on_make()
        self._making.append(set())
        try:
            result = make()
        finally:
            within = self._making.pop()
        if within:
            self._within[part] = within
        else:
            self._within.pop(part, None)
        self._use(part)
        self._results[part] = causes, result
        return result

    def listed(self, part: Hashable, causes: tuple[Any, ...], make: Callable[[], Iterable[_Kept]]) -> tuple[_Kept, ...]:
        """As `result`, of what is found one by one."""
        return self.result(part, causes, lambda: tuple(make()))

    @property
    def is_lasting(self) -> bool:
        """Whether another analysis may follow."""
        return self._parts is not None

    def _use(self, part: Hashable) -> None:
        """A part is used, and with it all that was used for it."""
        used = self._making[-1] if self._making else self._used
        used.add(part)
        used |= self._within.get(part, set())

    def parts(self, name: Hashable) -> dict[Any, Any] | None:
        """The parts of which a pass made its last result, for it to use them again; None if it will not. They may have
        changed since: an earlier result may not be used any more."""
        if self._parts is None:
            return None
        self._use(("parts", name))
        return self._parts.setdefault(name, {})

    def fork(self) -> Memory:
        """A memory with the same results, for an analysis beside this one: it changes no parts."""
        forked = Memory(once=True)
        forked._results = dict(self._results)
        return forked

    def forget_unused(self) -> None:
        """Drops what no analysis has used since the call before the last one."""
        used = self._used | self._used_before
        for name in [name for name in self._parts or () if ("parts", name) not in used]:
            del (self._parts or {})[name]
        for part in self._results.keys() - used:
            del self._results[part]
            self._within.pop(part, None)
        self._used, self._used_before = set(), self._used


_PLAIN = frozenset((str, bytes, int, float, bool, type(None)))


def _is_same(one: Any, other: Any) -> bool:
    """Whether two causes are the same: plain data if they are equal, everything else if it is the same object. Models
    that are equal may differ in their locations."""
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    if type(one) is tuple:
        return len(one) == len(other) and all(map(_is_same, one, other))
    return type(one) in _PLAIN and bool(one == other)
