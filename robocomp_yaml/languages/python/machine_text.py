"""Tables of state machines as text of Python: constructor calls."""

from __future__ import annotations

import json
from dataclasses import MISSING, fields, is_dataclass

WIDTH = 110


def text(table: object, indent: str = "") -> str:
    """A call of the table's class, without what is as by default; long ones with one argument a line."""
    if isinstance(table, tuple):
        return _sequence([text(item, indent + "    ") for item in table], indent)
    if isinstance(table, str):
        return json.dumps(table, ensure_ascii=False)
    if not is_dataclass(table):
        return repr(table)
    name = type(table).__name__
    given = [f for f in fields(table) if f.default is MISSING or getattr(table, f.name) != f.default]
    inner = indent + "    "
    parts = [f"{f.name}={text(getattr(table, f.name), inner)}" for f in given]
    line = f"{name}({', '.join(parts)})"
    if "\n" not in line and len(indent) + len(line) <= WIDTH:
        return line
    return f"{name}(\n" + "".join(f"{inner}{part},\n" for part in parts) + f"{indent})"


def _sequence(items: list[str], indent: str) -> str:
    line = f"({', '.join(items)}{',' if len(items) == 1 else ''})"
    if "\n" not in line and len(indent) + len(line) <= WIDTH:
        return line
    inner = indent + "    "
    return "(\n" + "".join(f"{inner}{item},\n" for item in items) + f"{indent})"
