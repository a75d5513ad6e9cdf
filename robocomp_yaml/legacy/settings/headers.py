"""Name the columns of rows: by the user, by a comment above the rows, or by a table of known records."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules

REACH = 25
"""At most this many lines above the first row, a comment may be a header."""

_NAME = re.compile(r"(?P<name>[A-Za-z_][\w/ -]*?)\s*(?:\((?P<doc>.*)\))?\s*\Z")
_LABEL = re.compile(r"\s*[A-Za-z_][\w. ]*?\s*[:=]\s*(?=\S)")
_COLUMN_GAP = re.compile(r"\t| {2,}|,")


class Column(msgspec.Struct, frozen=True):
    name: str
    doc: str = ""


def columns(
    stem: str, arity: int, source: SourceText, line: int, rules: Rules, requested: Mapping[str, Sequence[str]]
) -> tuple[list[Column], str]:
    """Return the columns of the rows `stem`0, `stem`1, …, the first of which is at `line`, and the source of their
    names: `names` (the user), `header` (a comment), `known` (the rules), or ''."""
    for key in (stem, stem.rstrip("_.-")):
        if len(requested.get(key, ())) == arity:
            return [Column(name) for name in unique(requested[key])], "names"
    for text in _comments_above(source, line, stem):
        found = header(text, arity, rules.stop)
        if found:
            return found, "header"
    for record in rules.records:
        if stem.endswith(record["key"]) and len(record["columns"]) == arity:
            return [Column(name) for name in record["columns"]], "known"
    return [Column(f"f{number}") for number in range(1, arity + 1)], ""


def _comments_above(source: SourceText, line: int, stem: str) -> Iterator[str]:
    """Yield the comments above a line, the nearest first, without rows that are commented out."""
    row = re.compile(rf"[#~;\s]*{re.escape(stem)}\d+\s*=")
    for number in range(line - 1, max(line - 1 - REACH, 0), -1):
        text = source.line_text(number).strip()
        if text.startswith("#") and not row.match(text):
            yield text.lstrip("#~ \t").rstrip("# \t")


def header(text: str, arity: int, stop: frozenset[str] = frozenset()) -> list[Column]:
    """Return the columns that a comment names, if it names as many as there are; else none."""
    label = _LABEL.match(text)
    for body in dict.fromkeys((text[label.end() :] if label else text, text)):
        parts = [part.strip() for part in _split(body)]
        if "," in body and len(parts) == arity:
            found = _names(parts)
            if found:
                return found
        words = re.split(r"[\s,]+", body.strip(" \t,"))
        prose = not _COLUMN_GAP.search(body.strip()) and any(word.lower().strip(".") in stop for word in words)
        if len(words) == arity and arity > 1 and not prose:
            found = _names(words)
            if found:
                return found
    return []


def _split(text: str) -> list[str]:
    """Split a text at commas, except in parentheses."""
    parts, depth = [""], 0
    for char in text:
        depth += (char == "(") - (char == ")")
        if char == "," and depth <= 0:
            parts.append("")
        else:
            parts[-1] += char
    return parts


def _names(parts: Sequence[str]) -> list[Column]:
    matches = [match for match in map(_NAME.match, parts) if match]
    if len(matches) < len(parts):
        return []
    names = unique([sanitized(match["name"]) for match in matches])
    docs = [(match["doc"] or "").strip() or _doc(match["name"]) for match in matches]
    return [Column(name, doc) for name, doc in zip(names, docs, strict=True)]


def _doc(original: str) -> str:
    return original if sanitized(original) != original else ""


def sanitized(text: str) -> str:
    """Return a text as a legal name: several words become `several_words`."""
    words = re.sub(r"[^A-Za-z0-9_]+", "_", text.strip()).strip("_") or "field"
    words = words.lower() if " " in text.strip() else words
    return f"f{words}" if words[0].isdigit() else words


def unique(names: Sequence[str]) -> list[str]:
    """Return the names; a name that occurs again gets a number."""
    found: dict[str, None] = {}
    for name in names:
        found[free(name, found)] = None
    return list(found)


def free(name: str, used: Container[str]) -> str:
    """Return a name that is not used: the name itself, or with a number."""
    result, number = name, 2
    while result in used:
        result, number = f"{name}_{number}", number + 1
    return result
