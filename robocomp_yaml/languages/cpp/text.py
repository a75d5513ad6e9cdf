"""Pieces of C++ source: comments and declarations, laid out as a person would."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

WIDTH = 120
IN = "    "
_LITERAL_OR_MARK = re.compile(r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|[][(){},]""", re.DOTALL)


def comment(text: str, indent: str = "") -> str:
    """A documentation comment; without the first line's indent."""
    lines = [_plain(line) for line in text.strip().splitlines()] or [""]
    return f"\n{indent}".join(f"/// {line}".rstrip() for line in lines)


def declaration(head: str, parameters: Sequence[str], tail: str = "", indent: str = "") -> str:
    """`HEAD(PARAMETERS)TAIL`, with the parameters on lines of their own where it would be too long; without the first
    line's indent."""
    line = f"{head}({', '.join(parameters)}){tail}"
    if len(indent) + len(line) <= WIDTH:
        return line
    inner = f"{indent}{IN}"
    joined = ", ".join(parameters)
    if len(inner) + len(joined) + 1 + len(tail) > WIDTH:
        joined = f",\n{inner}".join(parameters)
    return f"{head}(\n{inner}{joined}){tail}"


def one_line(text: str) -> str:
    """A document's text as the rest of a line of comment."""
    return _plain(" ".join(text.split()))


def quoted(text: str) -> str:
    """A string literal; what is no plain character becomes an escape."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _plain(line: str) -> str:
    """Without what is no text, and without the backslash that would draw the next line into the comment."""
    kept = line if line.isprintable() else "".join(c for c in line if c.isprintable() or c == "\t")
    return kept.rstrip(" \t\\")


def folded(code: str, indent: str) -> str:
    """An expression that is too long for a line with what is in its largest brackets on lines of its own, and so on;
    without the first line's indent."""
    if len(indent) + len(code) <= WIDTH or "\n" in code:
        return code
    start, end = max(_brackets(code), key=lambda found: found[1] - found[0], default=(0, 0))
    if end - start < 2:
        return code
    inner = indent + IN
    lines = [f"{inner}{folded(part, inner)}" for part in _parts(code[start + 1 : end])]
    return "\n".join([code[: start + 1], *lines, f"{indent}{code[end:]}"])


def _brackets(code: str) -> Iterator[tuple[int, int]]:
    """Where the outermost brackets open and close."""
    start = 0
    for at, depth, char in _outside_texts(code):
        if char in "([{" and depth == 1:
            start = at
        elif char in ")]}" and depth == 0:
            yield start, at


def _parts(inner: str) -> list[str]:
    """What stands between the outermost commas, each with its comma."""
    cuts = [at + 1 for at, depth, char in _outside_texts(inner) if char == "," and depth == 0]
    return [inner[start:end].strip() for start, end in zip([0, *cuts], [*cuts, len(inner)], strict=True)]


def _outside_texts(code: str) -> Iterator[tuple[int, int, str]]:
    """Each bracket and comma that stands in no literal, with its place and how deep it is in brackets behind it."""
    depth = 0
    for found in _LITERAL_OR_MARK.finditer(code):
        mark = found[0]
        if len(mark) == 1:
            depth += (mark in "([{") - (mark in ")]}")
            yield found.start(), depth, mark
