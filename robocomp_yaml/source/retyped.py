"""Values that YAML reads as something else than is wanted: quotes too many or too few, YAML 1.1's words for truth."""

from __future__ import annotations

from collections.abc import Collection

from robocomp_yaml.diag.fix import Fix, changing, listing, quoting, unquoting
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern

BOOL, INTEGER, NUMBER, STRING, LIST = "boolean", "integer", "number", "string", "array"
"""As JSON Schema calls them."""

TRUTHS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}
"""The words for truth of YAML 1.1, which are text in 1.2."""

_INTEGER = pattern(r"[-+]?[0-9]+")
_NUMBER = pattern(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_BOOL = ("true", "True", "TRUE", "false", "False", "FALSE")


def retyped(wanted: Collection[str], lexeme: str, value: object, span: Span) -> tuple[Fix, ...]:
    """How a scalar, spelled so, becomes a value of one of the wanted types and stays the same to its reader."""
    text = lexeme.strip()
    if isinstance(value, str):
        if (
            (INTEGER in wanted and _INTEGER.fullmatch(text)) or (NUMBER in wanted and _NUMBER.fullmatch(text))
            or (BOOL in wanted and text in _BOOL)
        ):  # fmt: skip
            return (unquoting(span),)
        if BOOL in wanted and (meant := TRUTHS.get(text.lower())):
            return (changing(span, meant),)
    elif set(wanted) == {STRING} and text and value is not None:
        return (quoting(span),)
    return (listing(span),) if set(wanted) == {LIST} and text and isinstance(value, str) else ()
