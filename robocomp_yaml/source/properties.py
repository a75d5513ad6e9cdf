"""Ice property files (`etc/config`), read and written by the rules of Ice 3.7's `Properties::load`."""

from __future__ import annotations

import msgspec

_BLANKS = " \t\r\n"


class Entry(msgspec.Struct, frozen=True):
    """One `key=value` line. `line` and `column` (of the key) count from 1."""

    key: str
    value: str
    line: int
    column: int = 1


class Properties(msgspec.Struct, frozen=True):
    """A property file as Ice understands it: its entries in order, and the lines that Ice drops with a warning."""

    entries: tuple[Entry, ...]
    invalid: tuple[int, ...] = ()

    @property
    def last(self) -> dict[str, Entry]:
        """The entry that counts for each key: the last one; an empty value unsets the key."""
        found: dict[str, Entry] = {}
        for entry in self.entries:
            if entry.value:
                found[entry.key] = entry
            else:
                found.pop(entry.key, None)
        return found

    @property
    def values(self) -> dict[str, str]:
        """The property set: what `Ice.Properties` holds after reading the file."""
        return {key: entry.value for key, entry in self.last.items()}


def read(text: str) -> Properties:
    entries: list[Entry] = []
    invalid: list[int] = []
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), 1):
        parsed = _parsed(line)
        if parsed is None:
            continue
        if parsed[0] and parsed[1] is not None:
            entries.append(Entry(parsed[0], parsed[1], number, len(line) - len(line.lstrip(_BLANKS)) + 1))
        else:
            invalid.append(number)
    return Properties(tuple(entries), tuple(invalid))


def unquoted(value: str) -> str:
    """The value of a flat-TOML config: one that stands between double quotes, and has no other, loses them."""
    if len(value) >= 2 and value[0] == value[-1] == '"' and value.count('"') == 2:
        return value[1:-1]
    return value


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


def _parsed(line: str) -> tuple[str, str | None] | None:
    """Key and value of a line; value None where the line has no `=`; None for a blank or comment line."""
    key, at, separated = _key(line)
    if not separated:
        return (key, None) if key else None
    return key, _value(line, at)


def _key(line: str) -> tuple[str, int, bool]:
    """The key, the index after its `=`, and whether there is a `=`."""
    key = blanks = ""
    at = 0
    while at < len(line):
        char = line[at]
        at += 1
        if char == "=":
            # Ice trims once more when it sets the property: `\` before a tab does not protect the tab.
            return key.strip(_BLANKS), at, True
        if char == "#":
            break
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


def _value(line: str, at: int) -> str:
    # `blanks` is all white space since the last other character, `kept` the escaped part of it, which survives at
    # the ends.
    value = blanks = kept = ""
    while at < len(line):
        char = line[at]
        at += 1
        if char == "#":
            break
        if char in _BLANKS:
            blanks += char if value else ""
            continue
        if char == "\\":
            if at == len(line):
                # Ice forgets to clear the escaped blanks here, and appends them once more at the end.
                return value + (blanks if value else kept) + char + kept
            escaped = line[at]
            at += 1
            if escaped == " ":
                blanks += escaped
                kept += escaped
                continue
            char = escaped if escaped in "\\#=" else char + escaped
        value += (blanks if value else kept) + char
        blanks = kept = ""
    return value + kept
