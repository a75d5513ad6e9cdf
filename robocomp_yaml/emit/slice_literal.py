"""Values as Slice spells them: numbers as the author wrote them, where Slice reads them so."""

from __future__ import annotations

import re

from robocomp_yaml.model.interface import Literal

_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*)\Z")
_REAL = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\Z")
_LARGEST_INTEGER = 2**63
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def literal(value: Literal, type_name: str) -> str:
    """The literal of a basic type."""
    match type_name:
        case "string":
            return quoted(str(value.value))
        case "bool":
            return "true" if value.value else "false"
        case "float" | "double":
            return _real(value)
        case _:
            return value.lexeme if _INTEGER.match(value.lexeme) else str(value.value)


def quoted(text: str) -> str:
    """A string literal; `??` is split, since the preprocessor knows trigraphs."""
    escaped = "".join(_ESCAPES.get(c) or (f"\\{ord(c):03o}" if ord(c) < 0x20 or ord(c) == 0x7F else c) for c in text)
    return '"' + escaped.replace("??", "?\\?") + '"'


def _real(value: Literal) -> str:
    lexeme = value.lexeme if _REAL.match(value.lexeme) else repr(value.value)
    is_integer = _INTEGER.match(lexeme)
    return f"{lexeme}.0" if is_integer and abs(int(lexeme)) >= _LARGEST_INTEGER else lexeme
