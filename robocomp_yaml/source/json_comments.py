"""Adds members to JSON with comments and trailing commas (editors' settings) without changing the rest of the text."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping

from robocomp_yaml.patterns import pattern

_TOKEN = pattern(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/|,(?=\s*[}\]])', re.DOTALL)
_BLANK = pattern(r"[^\n]")
_SPACE = pattern(r"\s*")


class Unreadable(ValueError):
    """The text is not JSON, or the value at the key of the members is not an object."""


def with_members(text: str, key: str, members: Mapping[str, object]) -> str:
    """The text with `members` in the object under `key`. An existing member keeps its value. Raises Unreadable."""
    plain = _strict(text)
    try:
        whole = json.loads(plain)
    except (ValueError, RecursionError):
        raise Unreadable("it is not JSON") from None
    if not isinstance(whole, dict) or not isinstance(whole.get(key, {}), dict):
        raise Unreadable("the value of the settings is not an object")
    missing = {name: value for name, value in members.items() if name not in whole.get(key, {})}
    if not missing:
        return text
    start = _skip(plain, 0)
    if key not in whole:
        return _insert(text, plain, start, {key: missing}, 1)
    inner = next(value for name, value in reversed(list(_members(plain, start))) if name == key)
    return _insert(text, plain, inner, missing, 2)


def _strict(text: str) -> str:
    """The text as strict JSON of the same length: comments and trailing commas become blanks."""

    def blank(token: re.Match[str]) -> str:
        return token[0] if token[0].startswith('"') else _BLANK.sub(" ", token[0])

    if text.startswith("\ufeff"):
        text = " " + text[1:]
    return _TOKEN.sub(blank, _TOKEN.sub(blank, text))


def _members(plain: str, start: int) -> Iterator[tuple[str, int]]:
    """The keys of the object that starts at `start`, each with the index of its value."""
    decoder = json.JSONDecoder()
    at = _skip(plain, start + 1)
    while plain[at] != "}":
        name, at = decoder.raw_decode(plain, at)
        at = _skip(plain, _skip(plain, at) + 1)
        yield name, at
        _, at = decoder.raw_decode(plain, at)
        at = _skip(plain, at)
        if plain[at] == ",":
            at = _skip(plain, at + 1)


def _skip(plain: str, at: int) -> int:
    return _SPACE.match(plain, at).end()  # type: ignore[union-attr]


def _insert(text: str, plain: str, brace: int, members: Mapping[str, object], depth: int) -> str:
    """The text with `members` inserted as the first ones of the object whose `{` is at index `brace`."""
    indent = "  " * depth
    rows = json.dumps(members, indent=2, ensure_ascii=False)[2:-2].splitlines()
    block = "\n".join(f"{indent}{row[2:]}" for row in rows)
    first = _skip(plain, brace + 1)
    if plain[first] != "}":
        return f"{text[: brace + 1]}\n{block},{text[brace + 1 :]}"
    between = text[brace + 1 : first]
    return f"{text[: brace + 1]}\n{block}{between if between.strip() else chr(10) + indent[2:]}{text[first:]}"
