"""Whether a text matches a pattern, in a time proportional to the lengths of both.

Backtracking engines need exponential time for `(a+)+b`. This matcher simulates a nondeterministic finite automaton
(Thompson, 1968): it follows all alternatives at once, and caches the sets of states that it reaches.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TypeAlias

import msgspec

from robocomp_yaml.patterns import pattern

MAX_STATES = 5_000  # enough for `[a-z]{1,1000}`
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
    """The matcher of a portable pattern. Raises TooLarge if nested counts need more than MAX_STATES states."""
    alternatives = parsed(portable)
    if _size(alternatives) > MAX_STATES:
        raise TooLarge
    return Matcher(alternatives)


def parsed(portable: str) -> Alternatives:
    """The tree of a portable pattern."""
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
    """A finite automaton. `free` are the transitions without a character, `steps` those with a character of a class."""

    def __init__(self, alternatives: Alternatives) -> None:
        self.free: list[list[int]] = []
        self.steps: list[tuple[re.Pattern[str], int] | None] = []
        self._next: dict[tuple[frozenset[int], str], frozenset[int]] = {}
        start = self.state()
        self.end = self.add(alternatives, start)
        self.begin = self._with_free({start})

    def state(self) -> int:
        self.free.append([])
        self.steps.append(None)
        return len(self.free) - 1

    def add(self, part: Atom, start: int) -> int:
        """Adds a part that begins at state `start`. Returns the state at its end."""
        end = self.state()
        if isinstance(part, str):
            self.steps[start] = (re.compile(part), end)
            return end
        for sequence in part:
            state = self.state()
            self.free[start].append(state)
            for atom, least, most in sequence:
                state = self.repeat(atom, least, most, state)
            self.free[state].append(end)
        return end

    def repeat(self, atom: Atom, least: int, most: int | None, state: int) -> int:
        for _ in range(least):
            state = self.add(atom, self.after(state))
        end = self.state()
        if most is None:
            loop = self.after(state)
            self.free[self.add(atom, self.after(loop))].append(loop)
            state = loop
        for _ in range((most or 0) - least):
            self.free[state].append(end)
            state = self.add(atom, self.after(state))
        self.free[state].append(end)
        return end

    def after(self, state: int) -> int:
        following = self.state()
        self.free[state].append(following)
        return following

    def matches(self, text: str) -> bool:
        states = self.begin
        for char in text:
            following = self._next.get((states, char))
            if following is None:
                if len(self._next) >= _KEPT:
                    self._next.clear()
                steps = (self.steps[state] for state in states)
                following = self._with_free({step[1] for step in steps if step and step[0].fullmatch(char)})
                self._next[states, char] = following
            if not following:
                return False
            states = following
        return self.end in states

    def _with_free(self, states: set[int]) -> frozenset[int]:
        """The states, and all that transitions without a character reach from them."""
        found, left = set(states), list(states)
        while left:
            for state in self.free[left.pop()]:
                if state not in found:
                    found.add(state)
                    left.append(state)
        return frozenset(found)
