"""Tables as text of a language: constructor calls in Python, braces in C++."""

from __future__ import annotations

import json
from dataclasses import MISSING, fields, is_dataclass

from robocomp_yaml.emit.machines.tables import Value

WIDTH = 110


def python(table: object, indent: str = "") -> str:
    """A call of the table's class, without what is as by default; long ones with one argument a line."""
    if isinstance(table, tuple):
        return _sequence([python(item, indent + "    ") for item in table], indent)
    if isinstance(table, str):
        return json.dumps(table, ensure_ascii=False)
    if not is_dataclass(table):
        return repr(table)
    name = type(table).__name__
    given = [f for f in fields(table) if f.default is MISSING or getattr(table, f.name) != f.default]
    inner = indent + "    "
    parts = [f"{f.name}={python(getattr(table, f.name), inner)}" for f in given]
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


_KINDS = {"Value": "ValueKind", "Condition": "ConditionKind", "Action": "ActionKind", "State": "StateKind"}


def cpp(table: object, indent: str = "") -> str:
    """The table as an aggregate, up to the last field that is not as by default; long ones with one field a line."""
    if isinstance(table, tuple):
        return _braces("", [cpp(item, indent + "    ") for item in table], indent)
    if isinstance(table, bool):
        return "true" if table else "false"
    if isinstance(table, str):
        return cpp_string(table)
    if not is_dataclass(table):
        return str(table)
    inner = indent + "    "
    shown = list(fields(table))
    while shown and type(table).__name__ != "Action" and getattr(table, shown[-1].name) == shown[-1].default:
        shown.pop()
    parts = [_field(table, field.name, inner) for field in shown]
    return _braces(type(table).__name__, parts, indent) if parts else "{}"


def _field(table: object, name: str, indent: str) -> str:
    value = getattr(table, name)
    if name == "kind":
        return f"{_KINDS[type(table).__name__]}::{value.capitalize()}"
    if isinstance(table, Value) and name == "text" and table.kind == "literal":
        decoded = json.loads(value)
        return cpp_string(decoded if isinstance(decoded, str) else value)
    return "{}" if value in ("", ()) or value == Value() else cpp(value, indent)


def _braces(head: str, items: list[str], indent: str) -> str:
    line = f"{head}{{{', '.join(items)}}}"
    if "\n" not in line and len(indent) + len(line) <= WIDTH:
        return line
    inner = indent + "    "
    return f"{head}{{\n" + "".join(f"{inner}{item},\n" for item in items) + f"{indent}}}"


def cpp_string(text: str) -> str:
    """A string literal, whatever the text holds."""
    plain = "".join(
        character if character.isprintable() and character not in '"\\?' else
        "".join(f"\\{byte:03o}" for byte in character.encode("utf-8", "replace"))
        for character in text
    )  # fmt: skip
    return f'"{plain}"'
