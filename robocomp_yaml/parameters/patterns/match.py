"""Whether a text matches a pattern, in a time that grows with the text and with the pattern, never with its square.

Engines that try one way after the other take years for `(a+)+b`. Here all ways are gone at once: a pattern becomes a
graph of places, and each character of the text leads from some of them to others. What was found out is kept.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TypeAlias

import msgspec

from robocomp_yaml.patterns import pattern

MAX_PLACES = 5_000  # so many that `[a-z]{1,1000}` is none of the large ones
_KEPT = 10_000
_ATOM = pattern(r"\[(?:\\.|[^\]\\])*\]|\\.|.", re.DOTALL)
_COUNT = pattern(r"[*+?]|\{(\d+)(,(\d*))?\}")


Alternatives: TypeAlias = "list[list[tuple[Atom, int, int | None]]]"
"""Sequences of (atom, least, most)."""
Atom: TypeAlias = "str | Alternatives"
"""The text of a character or of a class of them, or a group."""


class TooLarge(ValueError):
    pass


@cache
def matcher(portable: str) -> Matcher:
    """For what `patterns.pattern` writes. Raises TooLarge, where counts of counts come to more than MAX_PLACES."""
    alternatives = parsed(portable)
    if _size(alternatives) > MAX_PLACES:
        raise TooLarge
    made = Matcher()
    made.end = made.add(alternatives, made.place())
    return made


def parsed(portable: str) -> Alternatives:
    return _TreeParser(portable).alternatives()


class _TreeParser(msgspec.Struct):
    text: str
    at: int = 0

    def alternatives(self) -> Alternatives:
        found = [self.sequence()]
        while self.text.startswith("|", self.at):
            self.at += 1
            found.append(self.sequence())
        return found

    def sequence(self) -> list[tuple[Atom, int, int | None]]:
        found = []
        while self.at < len(self.text) and self.text[self.at] not in "|)":
            if self.text.startswith("(?:", self.at):
                self.at += 3
                atom: Atom = self.alternatives()
                self.at += 1
            else:
                whole = _ATOM.match(self.text, self.at)
                assert whole
                atom, self.at = whole[0], whole.end()
            found.append((atom, *self.count()))
        return found

    def count(self) -> tuple[int, int | None]:
        found = _COUNT.match(self.text, self.at)
        if not found:
            return 1, 1
        self.at = found.end()
        if found[1] is None:
            return {"*": (0, None), "+": (1, None), "?": (0, 1)}[found[0]]
        least = int(found[1])
        return least, (least if found[2] is None else int(found[3]) if found[3] else None)


def _size(alternatives: Alternatives) -> int:
    return 1 + sum(
        (1 if isinstance(atom, str) else _size(atom)) * max(1, least + 1 if most is None else most)
        for sequence in alternatives for atom, least, most in sequence
    )  # fmt: skip


class Matcher:
    """`free` leads from a place to others by itself, `steps` by a character of a class."""

    def __init__(self) -> None:
        self.free: list[list[int]] = []
        self.steps: list[tuple[re.Pattern[str], int] | None] = []
        self.end = 0
        self._next: dict[tuple[frozenset[int], str], frozenset[int]] = {}

    def place(self) -> int:
        self.free.append([])
        self.steps.append(None)
        return len(self.free) - 1

    def add(self, part: Atom, start: int) -> int:
        """The place that one is at behind a part that begins at `start`."""
        end = self.place()
        if isinstance(part, str):
            self.steps[start] = (re.compile(part), end)
            return end
        for sequence in part:
            here = self.place()
            self.free[start].append(here)
            for atom, least, most in sequence:
                here = self.repeat(atom, least, most, here)
            self.free[here].append(end)
        return end

    def repeat(self, atom: Atom, least: int, most: int | None, here: int) -> int:
        for _ in range(least):
            here = self.add(atom, self.behind(here))
        end = self.place()
        if most is None:
            around = self.behind(here)
            self.free[self.add(atom, self.behind(around))].append(around)
            here = around
        for _ in range((most or 0) - least):
            self.free[here].append(end)
            here = self.add(atom, self.behind(here))
        self.free[here].append(end)
        return end

    def behind(self, here: int) -> int:
        there = self.place()
        self.free[here].append(there)
        return there

    def matches(self, text: str) -> bool:
        here = self._with_free({0})
        for char in text:
            there = self._next.get((here, char))
            if there is None:
                if len(self._next) >= _KEPT:
                    self._next.clear()
                steps = (self.steps[place] for place in here)
                there = self._with_free({step[1] for step in steps if step and step[0].fullmatch(char)})
                self._next[here, char] = there
            if not there:
                return False
            here = there
        return self.end in here

    def _with_free(self, places: set[int]) -> frozenset[int]:
        found, left = set(places), list(places)
        while left:
            for place in self.free[left.pop()]:
                if place not in found:
                    found.add(place)
                    left.append(place)
        return frozenset(found)
