"""Regular expressions with the same meaning in ECMAScript, Python, Rust and C++.

`pattern:` of a PDSL document accepts the subset that all of them support: literals, `.`, classes, `\\d \\w \\s`,
groups, alternatives and counts. The parser rewrites a pattern in a portable form, which all engines read alike: classes
are sorted ranges, and shorthands are spelled out (ASCII).

Rust's `regex` matches them, in a time proportional to the lengths of pattern and text; backtracking engines need
exponential time for `(a+)+b`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TypeAlias

import jsonschema_rs
import msgspec

from robocomp_yaml.patterns import pattern

MAX_COUNT = 1000
MAX_SIZE = 5_000  # enough for `[a-z]{1,1000}`
_MEMORY = 2**28  # of a pattern of this size, whose classes have many characters
_SHORTHANDS = {
    "d": [(0x30, 0x39)],
    "w": [(0x30, 0x39), (0x41, 0x5A), (0x5F, 0x5F), (0x61, 0x7A)],
    "s": [(0x09, 0x0D), (0x20, 0x20)],
}
CONTROLS = {"t": "\t", "n": "\n", "r": "\r", "f": "\f", "v": "\v"}
_SPELLED = {"\t": "\\t", "\n": "\\n", "\r": "\\r", "\f": "\\f", "\v": "\\v"}
_SYNTAX = frozenset("^$\\.*+?()[]{}|/")
_COUNTS: dict[str, tuple[int, int | None]] = {"*": (0, None), "+": (1, None), "?": (0, 1)}
_COUNT = pattern(r"\{(\d{1,4})(,(\d{1,4})?)?\}")


class NotPortable(ValueError):
    """A pattern is not in the supported subset; `index` is the position of the problem."""

    def __init__(self, problem: str, index: int) -> None:
        super().__init__(problem)
        self.index = index


class Part(msgspec.Struct, frozen=True):
    """A character or class, as the portable form spells it, or a group, with its count."""

    atom: str | Alternatives
    count: str = ""
    least: int = 1
    most: int | None = 1

    @property
    def portable(self) -> str:
        return (self.atom if isinstance(self.atom, str) else f"(?:{_spelled(self.atom)})") + self.count

    @property
    def size(self) -> int:
        """The number of states of an automaton for the part."""
        times = self.least + 1 if self.most is None else self.most
        return max(1, times) * (1 if isinstance(self.atom, str) else _size(self.atom))


Alternatives: TypeAlias = tuple[tuple[Part, ...], ...]


class Pattern(msgspec.Struct, frozen=True):
    """`text` is the pattern as written, `portable` the same pattern without anchors, for `^(?:…)$` in any engine."""

    text: str
    portable: str
    alternatives: Alternatives

    def matches(self, value: str) -> bool:
        try:
            return _matcher(self.portable)(value)
        except UnicodeEncodeError:  # half a pair of surrogates is not a character
            return False

    @property
    def anchored(self) -> str:
        """For engines that search. The look-ahead is for Python, where `$` also matches before a last line end."""
        return f"^(?:{self.portable})$(?!\\n)"


def parse(text: str) -> Pattern:
    """The pattern that a text spells. Raises NotPortable."""
    body, shift = text, 0
    if body.startswith("^"):  # a pattern always matches the whole text
        body, shift = body[1:], 1
    if body.endswith("$") and (len(body) - len(body.rstrip("$").rstrip("\\")) - 1) % 2 == 0:
        body = body[:-1]
    parser = _PatternParser(body, shift)
    alternatives = parser.alternatives()
    if parser.at < len(body):
        raise NotPortable("a ')' has no '(' before it", parser.at + shift)
    if _size(alternatives) > MAX_SIZE:
        raise NotPortable(f"its counts add up to more than {MAX_SIZE} characters", 0)
    return Pattern(text, _spelled(alternatives), alternatives)


@cache
def _matcher(portable: str) -> Callable[[str], bool]:
    linear = jsonschema_rs.RegexOptions(size_limit=_MEMORY)
    return jsonschema_rs.Draft7Validator({"pattern": f"^(?:{portable})$"}, pattern_options=linear).is_valid


def _spelled(alternatives: Alternatives) -> str:
    return "|".join("".join(part.portable for part in parts) for parts in alternatives)


def _size(alternatives: Alternatives) -> int:
    return 1 + sum(part.size for parts in alternatives for part in parts)


class _PatternParser(msgspec.Struct):
    text: str
    shift: int
    at: int = 0
    depth: int = 0

    def fail(self, problem: str, index: int | None = None) -> NotPortable:
        return NotPortable(problem, (self.at if index is None else index) + self.shift)

    def peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def alternatives(self) -> Alternatives:
        found = [self.sequence()]
        while self.peek() == "|":
            self.at += 1
            found.append(self.sequence())
        return tuple(found)

    def sequence(self) -> tuple[Part, ...]:
        parts = []
        while (char := self.peek()) and char not in "|)":
            parts.append(self.counted(self.atom()))
        return tuple(parts)

    def atom(self) -> str | Alternatives:
        start, char = self.at, self.peek()
        self.at += 1
        match char:
            case "(":
                return self.group(start)
            case "[":
                return self.char_class(start)
            case ".":
                return "[^\\n\\r]"
            case "\\":
                return self.escape(start)
            case "*" | "+" | "?":
                raise self.fail(f"'{char}' has nothing before it to repeat", start)
            case "^" | "$":
                raise self.fail(
                    f"'{char}' is not supported inside a pattern, which always matches the whole text", start
                )
            case "{" | "}" | "]":
                raise self.fail(f"'{char}' needs a backslash: '\\{char}'", start)
        return _literal(char)

    def group(self, start: int) -> Alternatives:
        if self.text.startswith("?:", self.at):
            self.at += 2
        elif self.peek() == "?":
            raise self.fail("look-around, named groups and flags are not supported by every engine", start)
        self.depth += 1
        if self.depth > 20:
            raise self.fail("groups are nested more than 20 levels deep", start)
        inner = self.alternatives()
        if self.peek() != ")":
            raise self.fail("this '(' has no ')'", start)
        self.depth -= 1
        self.at += 1
        return inner

    def counted(self, atom: str | Alternatives) -> Part:
        """The part of an atom and the count after it, if one follows."""
        char = self.peek()
        if char in _COUNTS:
            self.at += 1
            part = Part(atom, char, *_COUNTS[char])
        elif char == "{":
            counted = _COUNT.match(self.text, self.at)
            if not counted:
                raise self.fail("a count is written {2}, {2,} or {2,5}")
            least, most = int(counted[1]), int(counted[3] or counted[1])
            if most < least or most > MAX_COUNT:
                raise self.fail(f"a count must go up, to at most {MAX_COUNT}")
            self.at = counted.end()
            part = Part(atom, counted[0], least, most if counted[3] or not counted[2] else None)
        else:
            return Part(atom)
        following = self.peek()
        if following == "?":
            raise self.fail("a lazy count has no effect where the whole text must match; remove the '?'")
        if following and following in "*+{":
            raise self.fail("a count after a count needs a group around the first")
        return part

    def escape(self, start: int) -> str:
        char = self.peek()
        self.at += 1
        if char.lower() in _SHORTHANDS and char:
            return _class(_SHORTHANDS[char.lower()], negated=char.isupper())
        return _literal(self.single(char, start))

    def single(self, char: str, start: int) -> str:
        """The character that a backslash and `char` spell."""
        if char in CONTROLS:
            return CONTROLS[char]
        if not char:
            raise self.fail("a backslash ends the pattern", start)
        if char.isalnum() or (char.isspace() and char != " "):
            raise self.fail(f"'\\{char}' does not mean the same in every engine", start)
        return char

    def char_class(self, start: int) -> str:
        negated = self.peek() == "^"
        self.at += negated
        ranges: list[tuple[int, int]] = []
        while self.peek() != "]":
            if not self.peek():
                raise self.fail("this '[' has no ']'", start)
            low = self.class_item()
            if isinstance(low, list):
                ranges += low
            elif self.peek() == "-" and self.text[self.at + 1 : self.at + 2] not in ("]", ""):
                start_of_range = self.at
                self.at += 1
                high = self.class_item()
                if isinstance(high, list) or high < low:
                    raise self.fail("a range of characters must go up, from one character to another", start_of_range)
                ranges.append((low, high))
            else:
                ranges.append((low, low))
        self.at += 1
        if not ranges:
            raise self.fail("a class of characters is empty", start)
        return _class(ranges, negated)

    def class_item(self) -> int | list[tuple[int, int]]:
        start, char = self.at, self.peek()
        self.at += 1
        if char == "[":
            raise self.fail("inside a class, '[' needs a backslash: '\\['", start)
        if char != "\\":
            return ord(char)
        char = self.peek()
        self.at += 1
        if char and char in _SHORTHANDS:
            return _SHORTHANDS[char]
        return ord(self.single(char, start))


def _literal(char: str) -> str:
    return _SPELLED.get(char) or (f"\\{char}" if char in _SYNTAX else char)


def _class(ranges: list[tuple[int, int]], negated: bool) -> str:
    """A class of sorted, separate ranges, so that it never contains `--`, `&&` and `~~`, which are operators in
    Rust."""
    merged: list[list[int]] = []
    for low, high in sorted(ranges):
        if merged and low <= merged[-1][1] + 1:
            merged[-1][1] = max(merged[-1][1], high)
        else:
            merged.append([low, high])
    inner = "".join(
        _in_class(low) + ("" if low == high else f"-{_in_class(high)}" if high > low + 1 else _in_class(high))
        for low, high in merged
    )
    return f"[{'^' if negated else ''}{inner}]"


def _in_class(code: int) -> str:
    char = chr(code)
    return _SPELLED.get(char) or (f"\\{char}" if char in _SYNTAX or char == "-" else char)
