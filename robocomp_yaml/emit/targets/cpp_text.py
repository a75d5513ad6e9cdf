"""Pieces of C++ source: comments and declarations, laid out as a person would."""

from __future__ import annotations

from collections.abc import Sequence

WIDTH = 120
IN = "    "


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
    return "".join(c for c in line if c.isprintable() or c == "\t").rstrip(" \t\\")
