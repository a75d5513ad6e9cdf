"""A text that a pattern matches: the shortest text of its first alternatives."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

from robocomp_yaml.parameters.patterns.pattern import CONTROLS, Alternatives, Pattern

_VARIED = "123456789bcdeBCDE"
_ENOUGH = 32
_PLAIN = "a0A-_./ "  # preferred characters of a class


def example_texts(pattern: Pattern) -> Iterator[str]:
    """Different texts that a pattern matches: the example of `example_text`, then variations of it, at most 32."""
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
    """A short text that a pattern matches."""
    return "text" if pattern.matches("text") else _shortest(pattern.alternatives)


def _shortest(alternatives: Alternatives) -> str:
    return "".join(
        (_character(part.atom) if isinstance(part.atom, str) else _shortest(part.atom)) * part.least
        for part in alternatives[0]
    )


def _character(atom: str) -> str:
    """A character that an atom matches, preferably a plain one."""
    if not atom.startswith("["):
        return CONTROLS.get(atom[1:], atom[-1])
    is_in = re.compile(atom).fullmatch
    return next(filter(is_in, chain(_PLAIN, map(chr, range(0x21, 0x10000)))), "")
