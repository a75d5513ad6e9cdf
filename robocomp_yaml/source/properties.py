"""Ice property files (`etc/config`), read and written by the rules of Ice 3.7's `Properties::load`.

This is the one reader of flat `key=value` files: whoever wants entries, their places, or the comments among them, takes
them from its result.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

_BLANKS = " \t\r\n"


class Entry(msgspec.Struct, frozen=True):
    """One `key=value` line. `line` and `column` (of the key) count from 1. `at` is the index in the text where its
    value begins, with the blanks around it."""

    key: str
    value: str
    line: int
    column: int = 1
    at: int = 0


class Line(msgspec.Struct, frozen=True):
    """A line that is not blank: what it says stands from `start` to `stop`, and a comment from there to its `end`, as
    indices in the text. Without an `entry` it says nothing to Ice, or (`is_invalid`) Ice drops it with a warning."""

    number: int
    start: int
    stop: int
    end: int
    entry: Entry | None = None
    is_invalid: bool = False


class Properties(msgspec.Struct, frozen=True):
    """A property file as Ice understands it."""

    lines: tuple[Line, ...] = ()

    @property
    def entries(self) -> tuple[Entry, ...]:
        """In order."""
        return tuple(line.entry for line in self.lines if line.entry is not None)

    @property
    def invalid(self) -> tuple[int, ...]:
        """The numbers of the lines that Ice drops."""
        return tuple(line.number for line in self.lines if line.is_invalid)

    @property
    def last(self) -> dict[str, Entry]:
        return last(self.entries)

    @property
    def values(self) -> dict[str, str]:
        """The property set: what `Ice.Properties` holds after reading the file."""
        return {key: entry.value for key, entry in self.last.items()}


def last(entries: Iterable[Entry]) -> dict[str, Entry]:
    """The entry that counts for each key: the last one; an empty value unsets the key."""
    found: dict[str, Entry] = {}
    for entry in entries:
        if entry.value:
            found[entry.key] = entry
        else:
            found.pop(entry.key, None)
    return found


def read(text: str) -> Properties:
    lines: list[Line] = []
    start = len(text) - len(text.removeprefix("\ufeff"))
    for number, line in enumerate(text[start:].split("\n"), 1):
        if line:
            found = _line(line, number, start)
            if found is not None:
                lines.append(found)
        start += len(line) + 1
    return Properties(tuple(lines))


def unwritable(key: str, value: str) -> str:
    """Why no line of a property file can say this entry, or ''."""
    if not key:
        return "a property's name may not be empty"
    if key.strip(_BLANKS) != key:
        return "a property's name may not start or end with white space"
    if not value:
        return "a property's value may not be empty: Ice takes that as not set"
    if any(c in key or c in value for c in "\r\n\0"):
        return "a property may hold no line break and no NUL"
    if value.strip(" ") != value.strip(_BLANKS):
        return "a property's value may not start or end with a tab"
    if key.startswith("\ufeff"):
        return "a property's name may not start with a byte order mark"
    return ""


def entry_line(key: str, value: str) -> str:
    """The line (without its end) that Ice reads as this entry. Raises ValueError where there is none."""
    if reason := unwritable(key, value):
        raise ValueError(reason)
    inner = value.strip(" ")
    before = len(value) - len(value.lstrip(" ")) if inner else len(value)
    after = len(value) - before - len(inner)
    # A blank at either end would be trimmed; inside it stands for itself.
    name, blank = _escaped(key).replace("=", "\\="), "\\ "
    return f"{name}={blank * before}{_escaped(inner)}{blank * after}"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("#", "\\#")


def _line(line: str, number: int, start: int) -> Line | None:
    """A line that starts at an index of the text; None for a blank one."""
    end = start + len(line)
    key, at, separated = _key(line)
    if not separated:
        if not key:
            return Line(number, start, start + at, end) if line.strip(_BLANKS) else None
        return Line(number, start, start + at, end, is_invalid=True)
    value, stop = _value(line, at)
    if not key:
        return Line(number, start, start + stop, end, is_invalid=True)
    column = len(line) - len(line.lstrip(_BLANKS)) + 1
    return Line(number, start, start + stop, end, Entry(key, value, number, column, start + at))


def _key(line: str) -> tuple[str, int, bool]:
    """The key, the index after its `=`, and True; or the index where a comment begins or the line ends, and False."""
    key = blanks = ""
    at = 0
    while at < len(line):
        char = line[at]
        at += 1
        if char == "=":
            # Ice trims once more when it sets the property: `\` before a tab does not protect the tab.
            return key.strip(_BLANKS), at, True
        if char == "#":
            return key, at - 1, False
        if char in _BLANKS:
            blanks += char if key else ""
            continue
        if char == "\\" and at < len(line):
            escaped = line[at]
            at += 1
            if escaped == " ":
                blanks += escaped if key else ""
                continue
            char = escaped if escaped in "\\#=" else char + escaped
        key += blanks + char
        blanks = ""
    return key, at, False


def _value(line: str, at: int) -> tuple[str, int]:
    """The value, and the index where a comment begins or the line ends."""
    # `blanks` is all white space since the last other character, `kept` the escaped part of it, which survives at
    # the ends.
    value = blanks = kept = ""
    while at < len(line):
        char = line[at]
        at += 1
        if char == "#":
            at -= 1
            break
        if char in _BLANKS:
            blanks += char if value else ""
            continue
        if char == "\\":
            if at == len(line):
                # Ice forgets to clear the escaped blanks here, and appends them once more at the end.
                return value + (blanks if value else kept) + char + kept, at
            escaped = line[at]
            at += 1
            if escaped == " ":
                blanks += escaped
                kept += escaped
                continue
            char = escaped if escaped in "\\#=" else char + escaped
        value += (blanks if value else kept) + char
        blanks = kept = ""
    return value + kept, at
