"""Pieces of source that C++ and Java lay out alike."""

from __future__ import annotations

from collections.abc import Sequence

WIDTH = 120
IN = "    "


def declaration(head: str, parameters: Sequence[str], tail: str = "", indent: str = "") -> str:
    """`HEAD(PARAMETERS)TAIL`. Where it is longer than a line, the parameters are on a line of their own, or one on each
    line. The first line has no indent."""
    line = f"{head}({', '.join(parameters)}){tail}"
    if len(indent) + len(line) <= WIDTH:
        return line
    inner = f"{indent}{IN}"
    joined = ", ".join(parameters)
    if len(inner) + len(joined) + 1 + len(tail) > WIDTH:
        joined = f",\n{inner}".join(parameters)
    return f"{head}(\n{inner}{joined}){tail}"
