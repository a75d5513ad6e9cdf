"""Convert literals of Slice to YAML scalars, in the same spelling where YAML reads the same value."""

from __future__ import annotations

import re

from lark import Token, Tree

from robocomp_yaml.legacy.document import Raw, Value

_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{1,2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|[0-7]{1,3}|.)", re.DOTALL)
_LETTERS = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}


def value(token: Token) -> Value:
    """Return a number or a text in quotes as a value of a document."""
    if token.type == "STRING":
        return _ESCAPE.sub(_unescaped, str(token)[1:-1])
    lexeme = str(token)
    digits = lexeme.lstrip("+-")
    sign = lexeme[: len(lexeme) - len(digits)]
    if digits[:2] in ("0x", "0X"):
        return Raw(f"{sign}{int(digits, 16)}" if sign or digits[1] == "X" else digits)
    if re.fullmatch(r"0[0-7]+", digits):
        return Raw(f"{sign}{int(digits, 8)}" if sign else f"0o{digits.lstrip('0') or '0'}")
    return Raw(sign + digits.rstrip("fF"))


def name(qname: Tree[Token]) -> Value:
    """Return an enumerator without its qualifiers; `true` and `false` are booleans."""
    last = str([child for child in qname.children if isinstance(child, Token)][-1]).lstrip("\\")
    return Raw(last) if last in ("true", "false") else last


def _unescaped(match: re.Match[str]) -> str:
    code = match[1]
    if code[0] in "xuU":
        return chr(int(code[1:], 16))
    if code[0] in "01234567":
        return chr(int(code, 8))
    return _LETTERS.get(code, code)
