"""A text that a pattern matches: the shortest of its first alternatives."""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec

from robocomp_yaml.parameters.patterns.pattern import Pattern

_COUNT = re.compile(r"\{(\d+)[^}]*\}|[*+?]")
_CLASS = re.compile(r"\[\^?(?:\\.|[^\]\\])+\]", re.DOTALL)
_CONTROLS = {"t": "\t", "n": "\n", "r": "\r", "f": "\f", "v": "\v"}
_VARIED = "123456789bcdeBCDE"
_ENOUGH = 32
_PLAIN = "a0A-_./ "  # what a class is asked for first


def example_texts(pattern: Pattern) -> Iterator[str]:
    """Different texts that a pattern matches, as far as they are easily found: variations of the first one."""
    todo = [example_text(pattern)]
    seen = set(todo)
    for text in todo:
        yield text
        for at in range(len(text), -1, -1):
            for char in _VARIED:
                for other in (f"{text[:at]}{char}{text[at + 1 :]}", f"{text[:at]}{char}{text[at:]}"):
                    if len(todo) < _ENOUGH and other not in seen and pattern.matches(other):
                        seen.add(other)
                        todo.append(other)


def example_text(pattern: Pattern) -> str:
    return "text" if pattern.matches("text") else _Reader(pattern.portable).alternatives()


class _Reader(msgspec.Struct):
    """Goes over a portable pattern, which holds no more than `model.pattern` writes."""

    text: str
    at: int = 0

    def alternatives(self) -> str:
        first = self.sequence()
        while self.text[self.at : self.at + 1] == "|":
            self.at += 1
            self.sequence()
        return first

    def sequence(self) -> str:
        found = ""
        while self.at < len(self.text) and self.text[self.at] not in "|)":
            found += self.atom() * self.least()
        return found

    def atom(self) -> str:
        start, char = self.at, self.text[self.at]
        self.at += 1
        if char == "(":
            self.at += len("?:")
            inner = self.alternatives()
            self.at += 1
            return inner
        if char == "[":
            found = _CLASS.match(self.text, start)
            assert found is not None
            self.at = found.end()
            return _member(found[0])
        if char == "\\":
            char = self.text[self.at]
            self.at += 1
            return _CONTROLS.get(char, char)
        return char

    def least(self) -> int:
        """How often what stands before is repeated at least."""
        found = _COUNT.match(self.text, self.at)
        if found is None:
            return 1
        self.at = found.end()
        return int(found[1]) if found[1] else int(found[0] == "+")


def _member(characters: str) -> str:
    """A character of a class: a plain one, or the first that it has."""
    is_in = re.compile(characters).fullmatch
    return next((char for char in (*_PLAIN, *map(chr, range(0x21, 0x10000))) if is_in(char)), "")
