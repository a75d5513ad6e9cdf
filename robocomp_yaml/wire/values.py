"""The types of IDSL as Ice carries them: data of documents to Ice values, and back.

Ice for Python describes a type by objects that `slice2py` generates code for. Here they are made from the linked model,
so that nothing has to be generated: https://doc.zeroc.com/ice/3.7/language-mappings/python-mapping

What a document spells is what values documents spell: enumerators by name, structs and maps as mappings, bytes as a
list of numbers. A map whose keys are structs is a list of `{key: …, value: …}`.
"""

from __future__ import annotations

import math
import struct
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, TypeVar

import Ice
import IcePy
import msgspec

from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.model import interface as model
from robocomp_yaml.patterns import pattern
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.source import tree
from robocomp_yaml.source.tree import Node

Data = Any
"""What JSON and YAML have: None, bool, int, float, str, list, dict with texts as keys."""

_INTEGERS = {"byte": (0, 2**8 - 1), "short": (-(2**15), 2**15 - 1), "int": (-(2**31), 2**31 - 1)}
_INTEGERS["long"] = (-(2**63), 2**63 - 1)
_SHOWN = 60  # characters of a wrong value in a message
_DIGIT = pattern(r"\d")  # infinities have none, unless they are numbers that are too large


Shape = tuple[Any, ...]
_KEPT: list[type] = []
Kind = TypeVar("Kind", bound=type)


def kept(kind: Kind) -> Kind:
    """A class that is described to Ice. It is kept until the process ends: Ice has no reference of its own to it, and
    crashes without it."""
    _KEPT.append(kind)
    return kind


class Fault(msgspec.Struct, frozen=True):
    """What is wrong with a value: `path` leads to it from the argument's name."""

    span: Span
    path: str
    problem: str
    hint: Hint | str = ""


Report = Callable[[Fault], None]


class WireType(ABC):
    """A type. `name` is the one that documents have, `ice` what describes it to Ice."""

    name: str
    ice: Any

    @property
    def shape(self) -> Shape:
        """What makes the type the same as another one."""
        return (self.name,)

    @abstractmethod
    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        """The Ice value that a node of a document spells. None, and a report, where it spells none."""

    @abstractmethod
    def to_data(self, value: Any) -> Data:
        """The data that an Ice value is in documents."""

    @abstractmethod
    def zero(self) -> Any:
        """The Ice value without any choice: false, 0, an empty text, the first enumerator, an empty list."""

    def example(self, name: str) -> Any:
        """An Ice value to try a program with: `name` as text, one entry in each list and map, otherwise `zero`."""
        return self.zero()

    def key(self, text: tree.Scalar, path: Path, report: Report) -> Any:
        """The Ice value that a mapping's key spells."""
        return self.to_ice(tree.scalar_at(text.span, text.lexeme), path, report)

    def _wrong(self, node: Node, path: Path, report: Report, words: str, hint: Hint | str = "") -> None:
        report(Fault(node.span, paths.in_words(path), f"must be {words}, but is {_shown(node)}", hint))


class Basic(WireType):
    """A type that Python has, too: `kind`."""

    kind: type[Any]

    def __init__(self, name: str, ice: Any) -> None:
        self.name, self.ice = name, ice

    def to_data(self, value: Any) -> Data:
        return self.kind(value)

    def zero(self) -> Any:
        return self.kind()


class Truth(Basic):
    kind = bool

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(node.data, bool):
            return node.data
        return self._wrong(node, path, report, "true or false")


class Whole(Basic):
    kind = int

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        data = node.data
        if isinstance(data, float) and data.is_integer():
            data = int(data)
        if isinstance(data, bool) or not isinstance(data, int):
            return self._wrong(node, path, report, "a whole number")
        least, most = _INTEGERS[self.name]
        if least <= data <= most:
            return data
        return self._wrong(node, path, report, f"from {least} to {most} ({self.name})")


class Real(Basic):
    """Unlike parameters, what travels may be infinite, or not a number."""

    kind = float

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        data = node.data
        if isinstance(data, bool) or not isinstance(data, (int, float)):
            return self._wrong(node, path, report, "a number")
        try:
            struct.pack("<f" if self.name == "float" else "<d", data)
            if math.isfinite(data) or not isinstance(node, tree.Scalar) or not _DIGIT.search(node.lexeme):
                return float(data)
        except OverflowError:
            pass
        return self._wrong(node, path, report, f"a number that a {self.name} can hold")

    def to_data(self, value: Any) -> Data:
        """A float as the shortest number that is the same one in 32 bits: 0.1, not 0.10000000149011612."""
        if self.name == "double" or not math.isfinite(value):
            return float(value)
        value = as_float(value)  # what travels, if it was not sent yet
        if not math.isfinite(value):
            return value
        return next(short for digits in range(6, 10) if as_float(short := float(f"{value:.{digits}g}")) == value)


def as_float(number: float) -> float:
    """The nearest number of 32 bits; an infinity where it is too large."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", number))[0])
    except OverflowError:
        return math.copysign(math.inf, number)


class Text(Basic):
    kind = str

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(node.data, str):
            return node.data
        hint = f'quote it: "{node.lexeme}"' if isinstance(node, tree.Scalar) and node.lexeme else ""
        return self._wrong(node, path, report, "text", hint)

    def example(self, name: str) -> Any:
        return name

    def key(self, text: tree.Scalar, path: Path, report: Report) -> Any:
        return text.lexeme


class Enumeration(WireType):
    def __init__(self, id_: str, definition: model.Enum) -> None:
        self.name = definition.name
        kind = kept(type(definition.name, (Ice.EnumBase,), {}))
        self.values: dict[str, Any] = {}
        self.id = id_
        number = -1
        for enumerator in definition.enumerators:
            number = number + 1 if enumerator.value is None else enumerator.value
            self.values[enumerator.name] = kind(enumerator.name, number)
        self._names = {value.value: name for name, value in self.values.items()}
        self.ice = IcePy.defineEnum(id_, kind, (), {value.value: value for value in self.values.values()})
        self._shape = (id_, *self._names.items())

    @property
    def shape(self) -> Shape:
        return self._shape

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        name = node.lexeme if isinstance(node, tree.Scalar) else ""
        if name in self.values:
            return self.values[name]
        words = f"one of {', '.join(self.values)}"
        return self._wrong(node, path, report, words, did_you_mean(name, self.values) if name else "")

    def to_data(self, value: Any) -> Data:
        return self._names[value.value]

    def zero(self) -> Any:
        return next(iter(self.values.values()))


def _shown(node: Node) -> str:
    if isinstance(node, tree.Scalar):
        text = node.lexeme if not node.quoted else f"'{node.lexeme}'"
        return (text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…") or "missing"
    return "a mapping" if isinstance(node, tree.Mapping) else "a list"
