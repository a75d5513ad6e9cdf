"""Reads and writes Ice property files (`etc/config`) by the rules of Ice 3.7's `Properties::load`.

This is the only reader of flat configs; its result has the properties, their positions, and the comments.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from functools import lru_cache

import msgspec

from robocomp_yaml import secrets
from robocomp_yaml.patterns import pattern

_BLANKS = " \t\r\n"
_OF_A_KEY = pattern(r"(?:\\.|[^=#\\]|\\\Z)*", re.DOTALL)
_BLANK = r"(?:[ \t\r\n]|\\ )*"
_OF_A_VALUE = pattern(rf"({_BLANK})((?:{_BLANK}(?:\\[^ ]|[^ \t\r\n#\\]))*)({_BLANK})(\\\Z)?", re.DOTALL)
_ESCAPED = pattern(r"\\([\\#= ])")

FIRST_HEAD = "rcyaml wrote it once; it is yours."
VALUES_HEAD = "written by rcyaml from"
"""The first line of an `etc/config` says who wrote it, for workspaces without a manifest."""


class IceProperty(msgspec.Struct, frozen=True):
    """One `key=value` line. `line` and `column` (of the key) count from 1. `at` is the index in the text after `=`,
    before the blanks around the value."""

    key: str
    value: str
    line: int
    column: int = 1
    at: int = 0


class PropertyLine(msgspec.Struct, frozen=True):
    """A line that is not blank. As indices in the text, its content is from `start` to `stop`, and its comment from
    `stop` to `end`. Without an `entry` it is only a comment, or (`is_invalid`) Ice ignores it with a warning."""

    number: int
    start: int
    stop: int
    end: int
    entry: IceProperty | None = None
    is_invalid: bool = False


class Properties(msgspec.Struct, frozen=True):
    """A property file as Ice reads it."""

    lines: tuple[PropertyLine, ...] = ()

    @property
    def entries(self) -> tuple[IceProperty, ...]:
        """All properties in the order of the file."""
        return tuple(line.entry for line in self.lines if line.entry is not None)

    @property
    def invalid(self) -> tuple[int, ...]:
        """The numbers of the lines that Ice ignores with a warning."""
        return tuple(line.number for line in self.lines if line.is_invalid)

    @property
    def last(self) -> dict[str, IceProperty]:
        return last(self.entries)

    @property
    def values(self) -> dict[str, str]:
        """The content of `Ice.Properties` after reading the file."""
        return {key: entry.value for key, entry in self.last.items()}


def last(entries: Iterable[IceProperty]) -> dict[str, IceProperty]:
    """The effective property of each key: the last one; an empty value unsets the key."""
    effective: dict[str, IceProperty] = {}
    for entry in entries:
        if entry.value:
            effective[entry.key] = entry
        else:
            effective.pop(entry.key, None)
    return effective


@lru_cache(maxsize=512)  # a run reads each file several times, and `--watch` the same files again and again
def read(text: str) -> Properties:
    return _read(text)


def _read(text: str) -> Properties:
    lines: list[PropertyLine] = []
    start = len(text) - len(text.removeprefix("\ufeff"))
    for number, line in enumerate(text[start:].split("\n"), 1):
        if line and (made := _line(line, number, start)) is not None:
            lines.append(made)
        start += len(line) + 1
    return Properties(tuple(lines))


def without_secret(line: str, names: Collection[str] = ()) -> str:
    """A line (without its end) in which the value and all text after it is hidden if the key is secret, or is one of
    `names`."""
    for entry in _read(line).entries:
        if secrets.value(entry.key, entry.value, names) == secrets.HIDDEN:
            return f"{line[: entry.at]}{secrets.HIDDEN}"
    return line


def unwritable(key: str, value: str) -> str:
    """Why a property file cannot express this property, or ''."""
    if not key:
        return "a property's name may not be empty"
    if key.strip(_BLANKS) != key:
        return "a property's name may not start or end with white space"
    if not value:
        return "a property's value may not be empty: Ice treats an empty value as not set"
    if any(c in key or c in value for c in "\r\n\0"):
        return "a property may not contain a line break or a NUL"
    if value.strip(" ") != value.strip(_BLANKS):
        return "a property's value may not start or end with a tab"
    if key.startswith("\ufeff"):
        return "a property's name may not start with a byte order mark"
    return ""


def entry_line(key: str, value: str) -> str:
    """The line (without its end) that Ice reads as this property. Raises ValueError if there is no such line."""
    if reason := unwritable(key, value):
        raise ValueError(reason)
    inner = value.strip(" ")
    before = len(value) - len(value.lstrip(" ")) if inner else len(value)
    after = len(value) - before - len(inner)
    # Ice trims blanks at both ends; between other characters a blank needs no escape.
    blank = "\\ "
    return f"{_name(key)}={blank * before}{_escaped(inner)}{blank * after}"


def unset_line(key: str) -> str:
    """The line (without its end) after which Ice treats a property of earlier lines as not set."""
    return f"{_name(key)}="


def config_option(path: str) -> str:
    """The option with which an Ice program reads this file. Ice takes a list of files, separated by commas."""
    if any(char in path for char in "'\",#"):
        quoted = path.replace('"', '\\"')
        path = _escaped(f'"{quoted}"')
    return f"--Ice.Config={path}"


def _name(key: str) -> str:
    return _escaped(key).replace("=", "\\=")


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("#", "\\#")


def _line(line: str, number: int, start: int) -> PropertyLine | None:
    """A line that starts at index `start` of the text; None for a blank one."""
    end = start + len(line)
    key, at, separated = _key(line)
    if not separated:
        if not key:
            return PropertyLine(number, start, start + at, end) if line.strip(_BLANKS) else None
        return PropertyLine(number, start, start + at, end, is_invalid=True)
    value, stop = _value(line, at)
    if not key:
        return PropertyLine(number, start, start + stop, end, is_invalid=True)
    column = len(line) - len(line.lstrip(_BLANKS)) + 1
    return PropertyLine(number, start, start + stop, end, IceProperty(key, value, number, column, start + at))


def _key(line: str) -> tuple[str, int, bool]:
    """The key, the index after its `=`, and True; or the index where a comment begins or the line ends, and False."""
    match = _OF_A_KEY.match(line)
    assert match is not None  # it may be empty
    separated = line.startswith("=", match.end())
    # Ice trims again when it sets the property: `\\` before a tab does not protect the tab.
    return _ESCAPED.sub(r"\1", match[0]).strip(_BLANKS), match.end() + separated, separated


def _value(line: str, at: int) -> tuple[str, int]:
    """The value, and the index where a comment begins or the line ends. At both ends only escaped blanks are kept."""
    match = _OF_A_VALUE.match(line, at)
    assert match is not None
    before, inner, after, lone = match.groups()
    first, last = (" " * blanks.count("\\") for blanks in (before, after))
    value = first + _ESCAPED.sub(r"\1", inner)
    if lone:  # Ice appends the escaped blanks before it a second time
        value, last = f"{value}{_ESCAPED.sub(' ', after) if inner else ''}{lone}", last if inner else first
    return value + last, match.end()
