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
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import Ice
import IcePy
import msgspec

from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model import interface as model
from robocomp_yaml.model.interface import TypeRef
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.source import tree
from robocomp_yaml.source.tree import Node

Data = Any
"""What JSON and YAML have: None, bool, int, float, str, list, dict with texts as keys."""

_INTEGERS = {"byte": (0, 2**8 - 1), "short": (-(2**15), 2**15 - 1), "int": (-(2**31), 2**31 - 1)}
_INTEGERS["long"] = (-(2**63), 2**63 - 1)
_SHOWN = 60  # characters of a wrong value in a message


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

    @abstractmethod
    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        """The Ice value that a node of a document spells. None, and a report, where it spells none."""

    @abstractmethod
    def to_data(self, value: Any) -> Data:
        """The data that an Ice value is in documents."""

    @abstractmethod
    def zero(self) -> Any:
        """The Ice value that nothing was said of: false, 0, an empty text, the first enumerator, an empty list."""

    def key(self, text: tree.Scalar, path: Path, report: Report) -> Any:
        """The Ice value that a mapping's key spells."""
        return self.to_ice(tree.scalar_at(text.span, text.lexeme), path, report)

    def _wrong(self, node: Node, path: Path, report: Report, words: str, hint: Hint | str = "") -> None:
        report(Fault(node.span, paths.in_words(path), f"must be {words}, but is {_shown(node)}", hint))


class _Truth(WireType):
    name, ice = "bool", IcePy._t_bool

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(node.data, bool):
            return node.data
        return self._wrong(node, path, report, "true or false")

    def to_data(self, value: Any) -> Data:
        return bool(value)

    def zero(self) -> Any:
        return False


class _Whole(WireType):
    def __init__(self, name: str, ice: Any) -> None:
        self.name, self.ice = name, ice

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

    def to_data(self, value: Any) -> Data:
        return int(value)

    def zero(self) -> Any:
        return 0


class _Real(WireType):
    """Unlike parameters, what travels may be infinite, or not a number."""

    def __init__(self, name: str, ice: Any) -> None:
        self.name, self.ice = name, ice

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        data = node.data
        if isinstance(data, bool) or not isinstance(data, (int, float)):
            return self._wrong(node, path, report, "a number")
        try:
            struct.pack("<f" if self.name == "float" else "<d", data)
            return float(data)
        except OverflowError:
            return self._wrong(node, path, report, f"a number that a {self.name} can hold")

    def to_data(self, value: Any) -> Data:
        """A float as the shortest number that is the same one in 32 bits: 0.1, not 0.10000000149011612."""
        if self.name == "double" or not math.isfinite(value):
            return float(value)
        return next(short for digits in range(6, 10) if as_float(short := float(f"{value:.{digits}g}")) == value)

    def zero(self) -> Any:
        return 0.0


def as_float(number: float) -> float:
    """The nearest number of 32 bits; an infinity where it is too large."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", number))[0])
    except OverflowError:
        return math.copysign(math.inf, number)


class _Text(WireType):
    name, ice = "string", IcePy._t_string

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(node.data, str):
            return node.data
        hint = f'quote it: "{node.lexeme}"' if isinstance(node, tree.Scalar) and node.lexeme else ""
        return self._wrong(node, path, report, "text", hint)

    def to_data(self, value: Any) -> Data:
        return str(value)

    def zero(self) -> Any:
        return ""

    def key(self, text: tree.Scalar, path: Path, report: Report) -> Any:
        return text.lexeme


class _Enum(WireType):
    def __init__(self, id_: str, definition: model.Enum) -> None:
        self.name = definition.name
        kind = type(definition.name, (Ice.EnumBase,), {})
        self._values: dict[str, Any] = {}
        number = -1
        for enumerator in definition.enumerators:
            number = number + 1 if enumerator.value is None else enumerator.value
            self._values[enumerator.name] = kind(enumerator.name, number)
        self._names = {value.value: name for name, value in self._values.items()}
        self.ice = IcePy.defineEnum(id_, kind, (), {value.value: value for value in self._values.values()})

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        name = node.lexeme if isinstance(node, tree.Scalar) else ""
        if name in self._values:
            return self._values[name]
        words = f"one of {', '.join(self._values)}"
        return self._wrong(node, path, report, words, did_you_mean(name, self._values) if name else "")

    def to_data(self, value: Any) -> Data:
        return self._names[value.value]

    def zero(self) -> Any:
        return next(iter(self._values.values()))


class _Record:
    """A struct's value: Ice reads and writes its attributes."""

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(self.__dict__.values()))


class Members:
    """The members of a struct or an exception, by their names in documents.

    Ice gets other names, since only their order travels: a member may have a name that Python cannot have.
    """

    def __init__(self, members: Sequence[tuple[model.Member, WireType]]) -> None:
        self.types = {member.name: type_ for member, type_ in members}
        self._defaults = {member.name: member.default for member, _ in members if member.default is not None}
        self._attributes = {name: f"m{number}" for number, name in enumerate(self.types)}

    def described(self, *more: object) -> tuple[tuple[object, ...], ...]:
        """As Ice wants them described."""
        return tuple((self._attributes[name], (), type_.ice, *more) for name, type_ in self.types.items())

    def fill(self, made: Any, node: tree.Mapping, path: Path, report: Report) -> None:
        """Sets the attributes of a value to what a mapping says, and to defaults."""
        for key, _ in node.items():
            if key.lexeme not in self.types:
                hint = did_you_mean(key.lexeme, self.types) or f"there is {', '.join(self.types) or 'no member'}"
                report(Fault(key.span, paths.in_words((*path, key.lexeme)), "is unknown", hint))
        for name, type_ in self.types.items():
            entry, default = node.entries.get(name), self._defaults.get(name)
            if entry is not None:
                value = type_.to_ice(entry[1], (*path, name), report)
            elif default is not None:
                value = type_.to_ice(tree.scalar_at(node.span, default.lexeme), (*path, name), report)
            else:
                value = None
                hint = f"write `{name}: …`, a {type_.name}"
                report(Fault(node.span, paths.in_words((*path, name)), "is missing", hint))
            setattr(made, self._attributes[name], value)

    def zero(self, made: Any) -> None:
        for name, type_ in self.types.items():
            default = self._defaults.get(name)
            value = type_.to_ice(tree.scalar_at(Span(""), default.lexeme), (), lambda fault: None) if default else None
            setattr(made, self._attributes[name], type_.zero() if value is None else value)

    def to_data(self, made: Any) -> dict[str, Data]:
        return {name: type_.to_data(getattr(made, self._attributes[name])) for name, type_ in self.types.items()}


class _Struct(WireType):
    def __init__(self, id_: str, definition: model.Struct, members: Members) -> None:
        self.name, self.members = definition.name, members
        self._kind = type(definition.name, (_Record,), {})
        self.ice = IcePy.defineStruct(id_, self._kind, (), members.described())

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if not isinstance(node, tree.Mapping):
            return self._wrong(node, path, report, f"a mapping of {', '.join(self.members.types) or 'nothing'}")
        made = self._kind()
        self.members.fill(made, node, path, report)
        return made

    def to_data(self, value: Any) -> Data:
        return self.members.to_data(value)

    def zero(self) -> Any:
        made = self._kind()
        self.members.zero(made)
        return made


class _Sequence(WireType):
    def __init__(self, id_: str, name: str, element: WireType) -> None:
        self.name, self._element = name, element
        self.ice = IcePy.defineSequence(id_, (), element.ice)

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if not isinstance(node, tree.Sequence):
            return self._wrong(node, path, report, "a list")
        made = [self._element.to_ice(item, (*path, at), report) for at, item in enumerate(node.items)]
        if self._element.name != "byte":
            return made
        return bytes(0 if value is None else value for value in made)

    def to_data(self, value: Any) -> Data:
        return [self._element.to_data(item) for item in value]

    def zero(self) -> Any:
        return b"" if self._element.name == "byte" else []


class _Map(WireType):
    def __init__(self, id_: str, name: str, key: WireType, value: WireType) -> None:
        self.name, self._key, self._value = name, key, value
        self.ice = IcePy.defineDictionary(id_, (), key.ice, value.ice)

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(self._key, _Struct):
            return self._of_pairs(node, path, report)
        if not isinstance(node, tree.Mapping):
            return self._wrong(node, path, report, "a mapping")
        made = {}
        for key, value in node.items():
            at = (*path, key.lexeme)
            made[self._key.key(key, at, report)] = self._value.to_ice(value, at, report)
        return made

    def _of_pairs(self, node: Node, path: Path, report: Report) -> Any:
        if not isinstance(node, tree.Sequence):
            return self._wrong(node, path, report, "a list of {key: …, value: …}")
        made = {}
        for number, item in enumerate(node.items):
            at = (*path, number)
            entries = item.entries if isinstance(item, tree.Mapping) else {}
            if entries.keys() != {"key", "value"}:
                self._wrong(item, at, report, "{key: …, value: …}")
                continue
            key = self._key.to_ice(entries["key"][1], (*at, "key"), report)
            made[key] = self._value.to_ice(entries["value"][1], (*at, "value"), report)
        return made

    def to_data(self, value: Any) -> Data:
        if isinstance(self._key, _Struct):
            return [{"key": self._key.to_data(k), "value": self._value.to_data(v)} for k, v in value.items()]
        return {_as_key(self._key.to_data(key)): self._value.to_data(item) for key, item in value.items()}

    def zero(self) -> Any:
        return {}


def _as_key(data: Data) -> str:
    return str(data).lower() if isinstance(data, bool) else str(data)


class Types:
    """The types of linked modules, each made once."""

    def __init__(self) -> None:
        wholes = [_Whole("byte", IcePy._t_byte), _Whole("short", IcePy._t_short), _Whole("int", IcePy._t_int)]
        reals = [_Real("float", IcePy._t_float), _Real("double", IcePy._t_double)]
        basic = [_Truth(), *wholes, _Whole("long", IcePy._t_long), *reals, _Text()]
        self._basic: Mapping[str, WireType] = {one.name: one for one in basic}
        self._made: dict[tuple[LinkedModule, str], WireType] = {}

    def of(self, scope: LinkedModule, ref: TypeRef) -> WireType:
        """The type that a reference in a module names. The module has passed every check."""
        if ref.is_basic:
            return self._basic[ref.text]
        found = scope.find(ref)
        assert found is not None, ref.text
        owner, definition = found
        if (owner, definition.name) not in self._made:
            self._made[owner, definition.name] = self._define(owner, definition)
        return self._made[owner, definition.name]

    def members(self, scope: LinkedModule, members: Sequence[model.Member]) -> Members:
        return Members([(member, self.of(scope, member.type)) for member in members])

    def _define(self, scope: LinkedModule, definition: object) -> WireType:
        match definition:
            case model.Enum():
                return _Enum(id_of(scope, definition.name), definition)
            case model.Struct():
                return _Struct(id_of(scope, definition.name), definition, self.members(scope, definition.members))
            case model.Sequence():
                return _Sequence(id_of(scope, definition.name), definition.name, self.of(scope, definition.element))
            case model.Map():
                key, value = self.of(scope, definition.key), self.of(scope, definition.value)
                return _Map(id_of(scope, definition.name), definition.name, key, value)
        raise AssertionError(definition)


def id_of(scope: LinkedModule, name: str) -> str:
    """The type id that Ice gives a definition: `::RoboCompMouth::Mouth`."""
    return f"::{scope.module.name}::{name}"


def _shown(node: Node) -> str:
    if isinstance(node, tree.Scalar):
        text = node.lexeme if not node.quoted else f"'{node.lexeme}'"
        return (text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…") or "missing"
    return "a mapping" if isinstance(node, tree.Mapping) else "a list"
