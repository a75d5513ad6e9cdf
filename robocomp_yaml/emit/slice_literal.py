"""Values as Slice spells them: numbers as the author wrote them, where they arrive so."""

from __future__ import annotations

import re

from robocomp_yaml.link.numbers import arrives, compiles, is_integer_literal
from robocomp_yaml.model.interface import Literal

_INTEGER = r"[-+]?(?:0|[1-9][0-9]*)\Z"
_REAL = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\Z"
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def literal(value: Literal, type_name: str) -> str:
    """The literal of a basic type."""
    match type_name:
        case "string":
            return quoted(str(value.value))
        case "bool":
            return "true" if value.value else "false"
        case "float" | "double":
            return _real(value, type_name)
        case _:
            return value.lexeme if re.match(_INTEGER, value.lexeme) else str(value.value)


def quoted(text: str) -> str:
    """A string literal; `??` is split, since the preprocessor knows trigraphs."""
    escaped = "".join(_ESCAPES.get(c) or (f"\\{ord(c):03o}" if ord(c) < 0x20 or ord(c) == 0x7F else c) for c in text)
    return '"' + escaped.replace("??", "?\\?") + '"'


def _real(value: Literal, type_name: str) -> str:
    number = float(value.value)
    if re.match(_INTEGER, value.lexeme):
        return value.lexeme if is_integer_literal(number) else f"{value.lexeme}.0"
    if is_integer_literal(number) and not (compiles(number, type_name) and arrives(number, type_name)):
        return str(int(number))
    return value.lexeme if re.match(_REAL, value.lexeme) else repr(number)
