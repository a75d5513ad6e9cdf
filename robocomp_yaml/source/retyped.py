"""Fixes for values of the wrong type: superfluous or missing quotes, and the truth values of YAML 1.1."""

from __future__ import annotations

from collections.abc import Collection

from robocomp_yaml.diag.fix import Fix, changing, listing, quoting, unquoting
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern

BOOL, INTEGER, NUMBER, STRING, LIST = "boolean", "integer", "number", "string", "array"
"""The names of types in JSON Schema."""

TRUTHS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}
"""The truth values of YAML 1.1, which are text in YAML 1.2."""

_INTEGER = pattern(r"[-+]?[0-9]+")
_NUMBER = pattern(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_BOOL = ("true", "True", "TRUE", "false", "False", "FALSE")


def retyped(expected: Collection[str], lexeme: str, value: object, span: Span) -> tuple[Fix, ...]:
    """The fixes that make a scalar a value of one of the expected types, with the same meaning for a reader."""
    text = lexeme.strip()
    if isinstance(value, str):
        if (
            (INTEGER in expected and _INTEGER.fullmatch(text)) or (NUMBER in expected and _NUMBER.fullmatch(text))
            or (BOOL in expected and text in _BOOL)
        ):  # fmt: skip
            return (unquoting(span),)
        if BOOL in expected and (meant := TRUTHS.get(text.lower())):
            return (changing(span, meant),)
    elif set(expected) == {STRING} and text and value is not None:
        return (quoting(span),)
    return (listing(span),) if set(expected) == {LIST} and text and isinstance(value, str) else ()
