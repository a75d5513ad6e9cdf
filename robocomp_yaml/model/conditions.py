"""The little language of the data model `null`, which both C++ and Python have.

A condition is `In('state')`, the name of a guard of the worker (`low`, or `low()`), `true` or `false`, joined by `and`,
`or`, `not` and parentheses (or `&&`, `||`, `!`). A value is a text in quotes, a number, `true` or `false`. A script is
a list of names of actions of the worker: `park; beep()`.
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
    """The text is not of this language; the message says what is not."""


class Condition(msgspec.Struct, frozen=True):
    """`name` is a guard's, or a state's."""

    kind: str
    name: str = ""
    parts: tuple[Condition, ...] = ()


def condition(text: str) -> Condition:
    """Raises NotInLanguage."""
    parser = _ConditionParser(list(_tokens(text)))
    found = parser.either()
    if parser.rest:
        raise NullSyntaxError(f"'{parser.rest[0][1]}' is not expected here")
    return found


def names(found: Condition, kind: str) -> Iterator[str]:
    """All guards, or all states, of a condition."""
    if found.kind == kind:
        yield found.name
    for part in found.parts:
        yield from names(part, kind)


def always(found: Condition) -> bool:
    """Whether it holds whatever guards and states say, as `true` and `not false` do."""
    return _is_constant(found, True)


def _is_constant(found: Condition, value: bool) -> bool:
    match found.kind:
        case "not":
            return _is_constant(found.parts[0], not value)
        case "and" | "or":
            some = any if value == (found.kind == OR) else all
            return some(_is_constant(part, value) for part in found.parts)
        case _:
            return found.kind == (ALWAYS if value else NEVER)


def literal(text: str) -> str:
    """A value as JSON. Raises NotInLanguage."""
    text = text.strip()
    if text in _CONSTANTS:
        return text.lower()
    if _STRING.fullmatch(text):
        return quoted(text[1:-1])
    if _NUMBER.fullmatch(text):
        number = float(text)
        return json.dumps(int(number) if number.is_integer() and abs(number) < 1e15 else number)
    raise NullSyntaxError(f"'{text}' is no text in quotes, number, true or false")


def quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def script(text: str) -> list[str]:
    """The names of actions. Raises NotInLanguage."""
    found: list[str] = []
    for part in re.split(r"[;\n]", text):
        if part := part.strip():
            match = _ACTION.fullmatch(part)
            if not match:
                raise NullSyntaxError(f"'{part[:40]}' is no name of an action")
            found.append(match[1])
    return found


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    at = 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if not match:
            raise NullSyntaxError(f"'{text[at:].strip()[:40]}' is no name of a guard, nor In('state')")
        at = match.end()
        if match["in"]:
            yield IN, match["state"]
        elif match["name"] == "In":
            raise NullSyntaxError("In() wants the name of a state in quotes")
        elif match["op"]:
            yield _WORDS.get(match["op"], match["op"]), match["op"]
        elif match["name"] in _WORDS and not match["call"]:
            yield _WORDS[match["name"]], match["name"]
        else:
            yield _CONSTANTS.get(match["name"], GUARD), match["name"]


class _ConditionParser:
    def __init__(self, tokens: list[tuple[str, str]]) -> None:
        if len(tokens) > MAX_PARTS:
            raise NullSyntaxError(f"it has more than {MAX_PARTS} words")
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
            raise NullSyntaxError("something is missing at its end")
        kind, text = self.rest.pop(0)
        if kind == "(":
            inner = self.either()
            if not self.rest or self.rest.pop(0)[0] != ")":
                raise NullSyntaxError("a ')' is missing")
            return inner
        if kind in (IN, GUARD, ALWAYS, NEVER):
            return Condition(kind, text if kind in (IN, GUARD) else "")
        raise NullSyntaxError(f"'{text}' is not expected here")
