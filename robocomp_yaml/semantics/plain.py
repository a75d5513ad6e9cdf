# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""The types of plain parameters: values from data or from text, their limits, and messages about both."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import trunc
from numbers import Real
from typing import Any

from . import limits, references, texts
from .limits import Number
from .paths import Path, in_words
from .problems import Problem
from .secrecy import HIDDEN, url

_DATA = frozenset((bool, int, float, str))


@dataclass
class Conversion:
    """A conversion of raw values, with its result: `problems`, and `references`, the references by the paths of the
    values that they set. `is_text`: plain values are the texts of properties."""

    is_text: bool = False
    problems: list[Problem] = field(default_factory=list)
    references: dict[Path, str] = field(default_factory=dict)

    def reject(self, path: Path, message: str, value: str = "", wanted: str = "", unit: str = "") -> None:
        name = in_words(path)
        self.problems.append(Problem(name, f"{name} {message}" if name else message, value, wanted, unit))


class PlainKind:
    """A type of plain values. `name` is the name of the type, `unit` the unit of its numbers. `accepts_any_text`: every
    text is a value. `is_secret`: values are never shown."""

    unit = ""
    accepts_any_text = False
    is_secret = False

    def __init__(self, name: str) -> None:
        self.name = name

    @property
    def words(self) -> str:
        """The values in words, for messages."""
        return limits.WORDS[self.name]

    def convert(self, raw: Any, path: Path, conversion: Conversion) -> Any:
        """The value of `raw`, or None, with a problem in `conversion`."""
        is_text = type(raw) is str and conversion.is_text
        if type(raw) not in _DATA:  # only other data can be a reference, or stand for one
            raw = references.referred(raw)
            if isinstance(raw, references.Unresolved):
                return raw
            if isinstance(raw, references.Missing):
                conversion.reject(path, raw.why)
                return None
            if isinstance(raw, references.Referred):
                conversion.references[path] = raw.reference
            is_text = isinstance(raw, references.Referred) or (conversion.is_text and isinstance(raw, str))
        value = self.read(raw) if is_text else self.of(raw)
        if value is None:
            unit = f" ({self.unit})" if self.unit else ""
            expected, text = f"{self.words}{unit}", self.shown(raw)
            conversion.reject(path, f"must be {expected}, and is {text}", text, expected, self.unit)
        elif expected := self.limit(value):
            unit = f" {self.unit}" if self.unit else ""
            text = self.shown(raw) if self.accepts_any_text else self.shown(raw).strip("'")
            conversion.reject(path, f"is {text}{unit}, and must {expected}", text, expected, self.unit)
        return value

    def shown(self, raw: Any) -> str:
        """A value for messages, or data in its position; HIDDEN for a secret."""
        is_hidden = self.is_secret and isinstance(raw, (str, Real)) and not isinstance(raw, references.Referred)
        return HIDDEN if is_hidden else shown(raw)

    def one_of(self, values: Sequence[Any]) -> str:
        """The allowed values in words, for messages."""
        return limits.one_of(tuple(map(str, values)), self.is_secret)

    def of(self, raw: Any) -> Any:
        """The value of data, or None if the data has the wrong type."""
        raise NotImplementedError

    def read(self, text: str) -> Any:
        """The value that a text spells, or None if it spells none."""
        return str(text) if self.accepts_any_text else texts.read(self.name, text)

    def limit(self, value: Any) -> str:
        """The limit that a value breaks, as words after "must", or ''."""
        return ""


def shown(raw: Any) -> str:
    """A value for messages, shortened to 60 characters."""
    if isinstance(raw, references.Referred):
        return raw.reference
    if raw is None or isinstance(raw, (list, tuple)) or hasattr(raw, "keys"):
        return "nothing" if raw is None else "a mapping" if hasattr(raw, "keys") else "a list"
    text = repr(url(raw)) if isinstance(raw, str) else texts.spelled(raw)
    return text if len(text) <= 60 else f"{text[:59]}…"


class BoolKind(PlainKind):
    def __init__(self) -> None:
        super().__init__("bool")

    def of(self, raw: Any) -> Any:
        return raw if limits.is_of("bool", raw) else None


class NumberKind(PlainKind):
    """Numbers. `ends` are `at_least` and `at_most` (inclusive), `above` and `below` (exclusive)."""

    def __init__(self, name: str, values: Sequence[Number] = (), unit: str = "", **ends: Number) -> None:
        super().__init__(name)
        self.values = values
        self._ends = ends
        self.unit = unit

    def limit(self, value: Any) -> str:
        unit = f" {self.unit}" if self.unit else ""
        fault = limits.outside(self.name, value, self.values, self._ends)
        if fault == limits.CHOICE:
            return f"be {self.one_of(self.values)}{unit}"
        if fault == limits.RANGE:
            return f"be {limits.range_in_words(**self._ends)}{unit}"
        return f"be {limits.bounds(self.name)}" if fault else ""


class WholeKind(NumberKind):
    def of(self, raw: Any) -> Any:
        return trunc(raw) if limits.is_of(self.name, raw) else None


class DecimalKind(NumberKind):
    def of(self, raw: Any) -> Any:
        if not limits.is_of(self.name, raw):
            return None
        try:
            return float(raw)
        except OverflowError:
            return raw  # too large for every type


class TextKind(PlainKind):
    """Text; `pattern` must match all of it."""

    accepts_any_text = True

    def __init__(self, values: Sequence[str] = (), pattern: str = "", shown_as: str = "") -> None:
        super().__init__("string")
        self.values = values
        self._pattern = re.compile(pattern) if pattern else None
        self._shown_as = shown_as or pattern

    def of(self, raw: Any) -> Any:
        return str(raw) if limits.is_of(self.name, raw) else None

    def matches(self, value: str) -> bool:
        return self._pattern is None or self._pattern.fullmatch(value) is not None

    def limit(self, value: Any) -> str:
        fault = limits.outside(self.name, value, self.values, matches=self.matches)
        if fault == limits.CHOICE:
            return f"be {self.one_of(self.values)}"
        return f"match {self._shown_as}" if fault else ""


class ChoiceKind(PlainKind):
    """An enumerator."""

    accepts_any_text = True

    def __init__(self, name: str, *names: str) -> None:
        super().__init__(name)
        self.names = names

    @property
    def words(self) -> str:
        return self.one_of(self.names)

    def of(self, raw: Any) -> Any:
        return str(raw) if limits.is_of("string", raw) else None

    def limit(self, value: Any) -> str:
        return f"be {self.words}" if limits.outside(self.name, value, self.names) else ""


# The names that generated code uses.
truth, whole, decimal, text, choice = BoolKind, WholeKind, DecimalKind, TextKind, ChoiceKind


def secret(kind: PlainKind) -> PlainKind:
    """The same type; its values are never shown."""
    kind.is_secret = True
    return kind
