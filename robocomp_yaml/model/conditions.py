"""The expression language of the data model `null`, which all languages with state machines have.

A condition consists of `In('state')`, names of the worker's guards (`low` or `low()`), `true` and `false`, joined by
`and`, `or`, `not` and parentheses (or `&&`, `||`, `!`). A value is a quoted text, a number, `true` or `false`. A script
is a list of names of the worker's actions: `park; beep()`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator

import msgspec

ALWAYS, NEVER, IN, GUARD, NOT, AND, OR = "always", "never", "in", "guard", "not", "and", "or"

_TOKEN = re.compile(
    r"\s*(?:(?P<in>In\s*\(\s*(?P<quote>['\"])(?P<state>[^'\"]*)(?P=quote)\s*\))"
    r"|(?P<op>\(|\)|&&|\|\||!(?!=))|(?P<name>[A-Za-z_][A-Za-z0-9_]*)(?P<call>\s*\(\s*\))?)"
)
_WORDS = {"&&": AND, "||": OR, "!": NOT, "and": AND, "or": OR, "not": NOT}
_CONSTANTS = {"true": ALWAYS, "True": ALWAYS, "false": NEVER, "False": NEVER}
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?")
_STRING = re.compile(r"""'[^'\\]*'|"[^"\\]*\"""")
_ACTION = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)\s*(?:\(\s*\))?")

MAX_PARTS = 200


class NullSyntaxError(ValueError):
    """The text is not in this language. The message is the reason."""


class Condition(msgspec.Struct, frozen=True):
    """A node of a parsed condition; `name` is that of the guard or state."""

    kind: str
    name: str = ""
    parts: tuple[Condition, ...] = ()


def condition(text: str) -> Condition:
    """Returns a parsed condition. Raises NullSyntaxError if the text is none."""
    parser = _ConditionParser(list(_tokens(text)))
    parsed = parser.either()
    if parser.rest:
        raise NullSyntaxError(f"unexpected '{parser.rest[0][1]}'")
    return parsed


def names(condition: Condition, kind: str) -> Iterator[str]:
    """The names of a condition's guards (GUARD) or states (IN)."""
    if condition.kind == kind:
        yield condition.name
    for part in condition.parts:
        yield from names(part, kind)


def always(condition: Condition) -> bool:
    """Whether the condition holds for all guards and states, such as `true` and `not false`."""
    return _is_constant(condition, True)


def _is_constant(condition: Condition, value: bool) -> bool:
    match condition.kind:
        case "not":
            return _is_constant(condition.parts[0], not value)
        case "and" | "or":
            some = any if value == (condition.kind == OR) else all
            return some(_is_constant(part, value) for part in condition.parts)
        case _:
            return condition.kind == (ALWAYS if value else NEVER)


def literal(text: str) -> str:
    """A value as JSON text. Raises NullSyntaxError if the text is no value."""
    text = text.strip()
    if text in _CONSTANTS:
        return text.lower()
    if _STRING.fullmatch(text):
        return quoted(text[1:-1])
    if _NUMBER.fullmatch(text):
        number = float(text)
        return json.dumps(int(number) if number.is_integer() and abs(number) < 1e15 else number)
    raise NullSyntaxError(f"'{text}' is not a quoted text, a number, true or false")


def quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def script(text: str) -> list[str]:
    """The names of a script's actions. Raises NullSyntaxError if a part of the text is not a name."""
    actions: list[str] = []
    for part in re.split(r"[;\n]", text):
        if part := part.strip():
            match = _ACTION.fullmatch(part)
            if not match:
                raise NullSyntaxError(f"'{part[:40]}' is not the name of an action")
            actions.append(match[1])
    return actions


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    at = 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if not match:
            raise NullSyntaxError(f"'{text[at:].strip()[:40]}' is neither the name of a guard nor In('state')")
        at = match.end()
        if match["in"]:
            yield IN, match["state"]
        elif match["name"] == "In":
            raise NullSyntaxError("In() requires the name of a state in quotes")
        elif match["op"]:
            yield _WORDS.get(match["op"], match["op"]), match["op"]
        elif match["name"] in _WORDS and not match["call"]:
            yield _WORDS[match["name"]], match["name"]
        else:
            yield _CONSTANTS.get(match["name"], GUARD), match["name"]


class _ConditionParser:
    def __init__(self, tokens: list[tuple[str, str]]) -> None:
        if len(tokens) > MAX_PARTS:
            raise NullSyntaxError(f"a condition has at most {MAX_PARTS} words")
        self.rest = tokens

    def either(self) -> Condition:
        return self._joined(OR, self._both)

    def _both(self) -> Condition:
        return self._joined(AND, self._not)

    def _joined(self, kind: str, part: Callable[[], Condition]) -> Condition:
        parts = [part()]
        while self.rest and self.rest[0][0] == kind:
            self.rest.pop(0)
            parts.append(part())
        return parts[0] if len(parts) == 1 else Condition(kind, parts=tuple(parts))

    def _not(self) -> Condition:
        if self.rest and self.rest[0][0] == NOT:
            self.rest.pop(0)
            return Condition(NOT, parts=(self._not(),))
        return self._one()

    def _one(self) -> Condition:
        if not self.rest:
            raise NullSyntaxError("unexpected end")
        kind, text = self.rest.pop(0)
        if kind == "(":
            inner = self.either()
            if not self.rest or self.rest.pop(0)[0] != ")":
                raise NullSyntaxError("missing ')'")
            return inner
        if kind in (IN, GUARD, ALWAYS, NEVER):
            return Condition(kind, text if kind in (IN, GUARD) else "")
        raise NullSyntaxError(f"unexpected '{text}'")
