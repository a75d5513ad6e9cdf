# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Properties to the values of parameters, which are still texts: by their paths, or as a table spells them.

The reader accepts what `rcyaml compile` writes, and legacy files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import references, rows, spellings, texts
from .composite import Kind, ListKind, MapKind, RecordKind
from .paths import unescaped
from .plain import PlainKind, TextKind
from .spellings import Spelling

ROBOCOMP = {"period.compute": "Period.Compute", "period.emergency": "Period.Emergency"}
"""Parameters that every component has, with the names that RoboComp's tool writes, which count if the parameter has no
property of its own name. Readers in other languages have the same table."""


class PropertyReader:
    """Reads a set of properties. `used` are the keys that it has read, by the names in documents. `follow` returns the
    value of a text, which may be a reference. `known` are plain values by their paths, which are used instead of their
    texts."""

    def __init__(
        self,
        properties: Mapping[str, str],
        table: Mapping[str, Spelling],
        follow: Callable[[str], Any] = references.resolved,
        known: Mapping[str, Any] | None = None,
    ) -> None:
        self._properties = properties
        self._spellings = table
        self._follow = follow
        self._known = known or {}
        self._quoted = spellings.quotes_texts(properties)
        self.used: set[str] = set()
        self._stems: set[str] = set()  # every prefix of a key, so that a test for properties below a path is one lookup
        for key in properties:
            at = key.find(".")
            while at >= 0:
                self._stems.add(key[:at])
                at = key.find(".", at + 1)

    def read(self, kind: RecordKind) -> dict[str, Any]:
        """The texts of the parameters, in dictionaries and lists."""
        return self._record(kind, "", is_top=True)

    def _get(self, key: str) -> str | None:
        text = self._properties.get(key)
        if text is None and key in ROBOCOMP:
            text = self._properties.get(ROBOCOMP[key])
        if text is not None:
            self.used.add(key)
        return text

    def _record(self, kind: RecordKind, key: str, *, is_top: bool = False) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for member in kind.members.values():
            stem = f"{key}.{member.key}" if key else member.key
            if isinstance(member.kind, RecordKind) and member.kind.is_group:
                found[member.key] = self._record(member.kind, stem, is_top=is_top)
                continue
            spelling = self._spellings.get(stem) if is_top else None
            value = self._value(member.kind, stem) if spelling is None else self._spelled(spelling, member.kind)
            if value is None and member.reads_as_empty:
                value = _empty(member.kind)
            if value is not None:
                found[member.key] = value
        return found

    def _value(self, kind: Kind, key: str) -> Any:
        """The texts at a path; None if there are none."""
        if isinstance(kind, PlainKind):
            text = self._get(key)
            if text is not None and key in self._known:
                return self._known[key]
            return None if text is None else self._text(kind, text)
        if isinstance(kind, ListKind):
            return self._list(kind, key)
        if isinstance(kind, MapKind):
            names = self._get(f"{key}.keys")
            if names is None:
                return None
            return {unescaped(name): self._entry(kind.element, f"{key}.{name}") for name in names.split()}
        return self._record(kind, key) if key in self._stems else None

    def _list(self, kind: ListKind, key: str) -> Any:
        size = self._get(f"{key}.size")
        count = self._count(size) if size else 0
        if count is None:
            return size  # not a list: rejected later
        if not size:
            while f"{key}.{count}" in self._stems or f"{key}.{count}" in self._properties:
                count += 1
            if not count:
                return None
        return [self._entry(kind.element, f"{key}.{index}") for index in range(count)]

    def _count(self, text: str) -> int | None:
        """The number of elements that a count sets; None if it is not a count, or is implausibly large."""
        return texts.count(text, len(self._properties) + 1_000_000)

    def _entry(self, kind: Kind, key: str) -> Any:
        """The texts of an element of a list or map; empty if the element has no property."""
        value = self._value(kind, key)
        return _empty(kind) if value is None else value

    def _text(self, kind: Kind, text: str) -> Any:
        is_text = isinstance(kind, PlainKind) and kind.accepts_any_text
        return self._follow(texts.unquoted(text) if self._quoted and is_text else text)

    def _spelled(self, spelling: Spelling, kind: Kind) -> Any:
        if isinstance(kind, ListKind) and not spelling.separators:
            is_numbered = bool(spelling.fields) or "i" in spellings.placeholders(spelling.key)
            return self._numbered(spelling, kind) if is_numbered else self._keyed(spelling, kind)
        text = self._get(spelling.key)
        if text is None:
            return None
        if isinstance(kind, ListKind):
            levels, inner = _levels(kind)
            parts = rows.nested(text, spelling.separators, levels, spelling.trailing)
            separator = spelling.separators[levels] if levels < len(spelling.separators) else ""
            return self._parts(spelling, inner, parts, separator)
        return self._row(spelling, kind, text, spelling.separator)

    def _parts(self, spelling: Spelling, kind: Kind, parts: Any, separator: str) -> Any:
        if isinstance(parts, list):
            return [self._parts(spelling, kind, part, separator) for part in parts]
        return self._row(spelling, kind, parts, separator)

    def _row(self, spelling: Spelling, kind: Kind, text: str, separator: str) -> Any:
        """The columns of a record, or one plain value. A text that is not a row is rejected later."""
        if not isinstance(kind, RecordKind):
            return self._text(kind, text) if isinstance(kind, PlainKind) else text
        members = kind.members
        found = rows.row(
            text,
            separator,
            spelling.columns,
            lambda name: members[name].is_optional,
            lambda name: isinstance(members[name].kind, TextKind),
        )
        return text if found is None else {name: self._text(members[name].kind, part) for name, part in found.items()}

    def _numbered(self, spelling: Spelling, kind: ListKind) -> Any:
        """Rows by their numbers: as many as the count sets, or up to the first missing one."""
        counted = self._get(spelling.count) if spelling.count else None
        count = self._count(counted) if counted else None
        if counted and count is None:
            return counted  # not a list: rejected later
        found: list[Any] = []
        while count is None or len(found) < count:
            row = self._numbered_row(spelling, kind.element, str(spelling.first + len(found)))
            if row is None and count is None:
                break
            found.append(_empty(kind.element) if row is None else row)
        return None if count is None and not found else found

    def _numbered_row(self, spelling: Spelling, kind: Kind, number: str) -> Any:
        if spelling.fields and isinstance(kind, RecordKind):
            row = {}
            for name, key in spelling.fields:
                text = self._get(spellings.filled(key, {"i": number}))
                if text is not None:
                    row[name] = self._text(kind.members[name].kind, text)
            return {**_emptiness(kind), **row} if row else None
        text = self._get(spellings.filled(spelling.key, {"i": number}))
        return None if text is None else self._row(spelling, kind, text, spelling.separator)

    def _keyed(self, spelling: Spelling, kind: ListKind) -> Any:
        """Rows whose key contains members, sorted by these, because properties have no order."""
        names, pattern = spellings.placeholders(spelling.key), spellings.pattern(spelling.key)
        found: list[tuple[Any, Any]] = []
        for key, text in self._properties.items():
            in_key = pattern.match(key)
            if in_key:
                self.used.add(key)
                row = self._row(spelling, kind.element, text, spelling.separator)
                if isinstance(row, dict):
                    row.update(zip(names, in_key.groups()))
                found.append((tuple(map(_by_number, in_key.groups())), row))
        return [row for _, row in sorted(found, key=lambda pair: pair[0])] if found else None


def _empty(kind: Kind) -> Any:
    """The value of something that exists and has no property."""
    if isinstance(kind, TextKind):
        return ""
    if isinstance(kind, ListKind):
        return []
    if isinstance(kind, MapKind):
        return {}
    return _emptiness(kind) if isinstance(kind, RecordKind) else None


def _emptiness(kind: RecordKind) -> dict[str, Any]:
    """The members of a record that are empty if they have no property."""
    found = {member.key: _empty(member.kind) for member in kind.members.values() if member.reads_as_empty}
    return {key: value for key, value in found.items() if value is not None}


def _levels(kind: Kind) -> tuple[int, Kind]:
    levels = 0
    while isinstance(kind, ListKind):
        levels, kind = levels + 1, kind.element
    return levels, kind


def _by_number(text: str) -> tuple[bool, int, str]:
    """A sort key: numbers of any length first, by their value, then words."""
    if not texts.is_digits(text):
        return True, 0, text
    digits = text.lstrip("0")
    return False, len(digits), digits
