# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""TOML configs as properties: each key with the tables around it, its value as it is written, in the quotes that
`texts.unquoted` removes. So components read `config.toml` as they read a flat `config` with quoted texts."""

from __future__ import annotations

import re
from collections.abc import Iterator

SUFFIX = ".toml"
_TEXT = r"\"(?:[^\"\\]|\\.)*\"|'[^']*'"
_PART = rf"(?:[A-Za-z0-9_-]+|{_TEXT})"
_KEY = rf"{_PART}(?:\s*\.\s*{_PART})*"
_TABLE = re.compile(rf"\s*(\[?)\[\s*({_KEY})\s*\]\]?\s*(?:#.*)?\Z")
_ENTRY = re.compile(rf"\s*({_KEY})\s*=(.*)\Z", re.DOTALL)
_PIECE = re.compile(rf"\"\"\".*?(?:\"\"\"|\Z)|'''.*?(?:'''|\Z)|{_TEXT}|#[^\n]*|[\[\](){{}}]|.", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def properties(text: str) -> dict[str, str]:
    """The properties of a TOML file. A line that is no TOML is skipped: whoever needs errors has a parser."""
    found: dict[str, str] = {}
    table = ""
    rows: dict[str, int] = {}
    for line in _joined(text):
        if match := _TABLE.match(line):
            name = _name(match[2])
            if match[1]:
                rows[name] = rows.get(name, -1) + 1
                name = f"{name}.{rows[name]}"
            table = f"{name}."
        elif match := _ENTRY.match(line):
            value = _value(match[2])
            if value is not None:
                found[table + _name(match[1])] = value
    return found


def _joined(text: str) -> Iterator[str]:
    """The lines; a value of several lines is one of them."""
    kept = ""
    for line in text.splitlines():
        kept = f"{kept}\n{line}" if kept else line
        if not _is_open(kept):
            yield kept
            kept = ""


def _is_open(text: str) -> bool:
    """Whether a list or a long text goes on in the next line."""
    depth = 0
    for piece in _PIECE.findall(text.partition("=")[2]):
        if piece[:3] in ('"""', "'''"):
            if len(piece) < 6 or piece[-3:] != piece[:3]:
                return True
        elif piece in "[{":
            depth += 1
        elif piece in "]}":
            depth -= 1
    return depth > 0


def _name(key: str) -> str:
    """A dotted key without blanks and quotes."""
    return ".".join(part.strip("\"'") for part in re.findall(_PART, key))


def _value(text: str) -> str | None:
    """A value without its comment, on one line; None if it is empty."""
    pieces = [piece for piece in _PIECE.findall(text) if not piece.startswith("#")]
    value = "".join(pieces).strip()
    for quotes in ('"""', "'''", "'", '"'):
        if value.startswith(quotes) and value.endswith(quotes) and len(value) >= 2 * len(quotes):
            inner = value[len(quotes) : -len(quotes)]
            if quotes[0] == '"' and "\\" in inner:
                inner = re.sub(r"\\(.)", lambda match: _ESCAPES.get(match[1], match[1]), inner)
            if len(quotes) == 1 and quotes in inner and quotes == "'":
                break
            return inner if '"' in inner else f'"{inner}"'
    return " ".join(value.split()) or None
