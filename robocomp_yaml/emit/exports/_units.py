"""The text of a unit for systemd. Every line of one goes through `Unit`, so that no value can become a line of its own.

A value is text of one line: words in quotes (`quoted`), a folder (`folder`), or names that need neither.
"""

from __future__ import annotations

import re

from robocomp_yaml.emit.exports._unwritable import Unwritable
from robocomp_yaml.source.text import OF_NO_LINE

_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


class Unit:
    """Lines in order: comments, sections, and what is set in them."""

    def __init__(self) -> None:
        self._lines: list[str] = []

    @property
    def text(self) -> str:
        return "".join(f"{line}\n" for line in self._lines)

    def section(self, name: str) -> None:
        self._lines += ["", f"[{name}]"] if any(line.startswith("[") for line in self._lines) else [f"[{name}]"]

    def put(self, key: str, value: str) -> None:
        self._add(f"{key}={value}")

    def comment(self, text: str) -> None:
        self._add(f"# {text}")

    def _add(self, line: str) -> None:
        """Raises Unwritable: a line ends at a control character, and goes on behind a backslash."""
        found = OF_NO_LINE.search(line)
        if found:
            raise Unwritable(f"a line of a unit cannot hold U+{ord(found[0]):04X}")
        if line.endswith("\\"):
            raise Unwritable("a line of a unit cannot end with a backslash")
        self._lines.append(line)


def quoted(word: str, *, doubled: str = "") -> str:
    """A word in quotes, in which no specifier is found; `doubled` are signs that stand for themselves when they stand
    twice."""
    escaped = OF_NO_LINE.sub(_escape, "".join(_ESCAPES.get(char, char) for char in word)).replace("%", "%%")
    for char in doubled:
        escaped = escaped.replace(char, char * 2)
    return f'"{escaped}"'


def _escape(found: re.Match[str]) -> str:
    number = ord(found[0])
    if not number:
        raise Unwritable("no program can be given a text with a NUL in it")
    return f"\\x{number:02x}" if number < 0x80 else f"\\u{number:04x}"


def folder(path: str) -> str:
    """A path, which systemd takes without quotes: what would get lost at the end of a line does not stand there."""
    return percent(f"{path}/." if path.endswith((" ", "\\")) else path)


def percent(text: str) -> str:
    """A text in which no specifier is found."""
    return text.replace("%", "%%")


def plain(text: str) -> str:
    """A text for people."""
    return percent(" ".join(text.split())).rstrip("\\")
