"""Structs, exceptions, sequences and maps as Ice carries them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import IcePy

from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, suggest
from robocomp_yaml.model import interface as model
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Path
from robocomp_yaml.source import tree
from robocomp_yaml.source.tree import Node
from robocomp_yaml.wire.values import Data, Fault, Report, Shape, WireType, kept


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
        self.attributes = {name: f"m{number}" for number, name in enumerate(self.types)}

    @property
    def shape(self) -> Shape:
        return tuple((name, type_.shape, str(self._defaults.get(name))) for name, type_ in self.types.items())

    def described(self, *more: object) -> tuple[tuple[object, ...], ...]:
        """As Ice wants them described."""
        return tuple((self.attributes[name], (), type_.ice, *more) for name, type_ in self.types.items())

    def fill(self, made: Any, node: tree.Mapping, path: Path, report: Report) -> None:
        """Sets the attributes of a value to what a mapping says, and to defaults. A misspelled member is one fault."""
        absent = [name for name in self.types if name not in node.entries]
        meant = set[str | None]()
        for key, _ in node.items():
            if key.lexeme not in self.types:
                meant.add(suggest(key.lexeme, absent))
                there = ", ".join(self.types) or ("no member" if path else "no argument")
                hint = did_you_mean(key.lexeme, absent) or f"there is {there}"
                report(Fault(key.span, paths.in_words((*path, key.lexeme)), "is unknown", hint))
        for name, type_ in self.types.items():
            entry, default = node.entries.get(name), self._defaults.get(name)
            value: Any = None
            if entry is not None:
                value = type_.to_ice(entry[1], (*path, name), report)
            elif default is not None:
                value = type_.to_ice(tree.scalar_at(node.span, default.lexeme), (*path, name), report)
            elif name not in meant:
                article = "an" if type_.name[:1].lower() in "aeiou" else "a"
                hint = f"write `{name}: …`, {article} {type_.name}"
                report(Fault(node.span, paths.in_words((*path, name)), "is missing", hint))
            setattr(made, self.attributes[name], value)

    def set(self, made: Any, otherwise: Callable[[str, WireType], Any]) -> Any:
        """The value, with the attributes set to defaults, else to what `otherwise` returns for name and type."""
        for name, type_ in self.types.items():
            default = self._defaults.get(name)
            value = type_.to_ice(tree.scalar_at(Span(""), default.lexeme), (), lambda fault: None) if default else None
            setattr(made, self.attributes[name], otherwise(name, type_) if value is None else value)
        return made

    def to_data(self, made: Any) -> dict[str, Data]:
        return {name: type_.to_data(getattr(made, self.attributes[name])) for name, type_ in self.types.items()}


class Defined(WireType):
    """A type with an id of Ice's own, made of `parts`."""

    id: str
    parts: tuple[WireType | Members, ...]

    @property
    def shape(self) -> Shape:
        return (self.id, *(part.shape for part in self.parts))


class Struct(Defined):
    def __init__(self, id_: str, definition: model.Struct, members: Members) -> None:
        self.name, self.members = definition.name, members
        self.kind = kept(type(definition.name, (_Record,), {}))
        self.ice = IcePy.defineStruct(id_, self.kind, (), members.described())
        self.id, self.parts = id_, (members,)

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if not isinstance(node, tree.Mapping):
            return self._wrong(node, path, report, f"a mapping of {', '.join(self.members.types) or 'nothing'}")
        made = self.kind()
        self.members.fill(made, node, path, report)
        return made

    def to_data(self, value: Any) -> Data:
        return self.members.to_data(value)

    def zero(self) -> Any:
        return self.members.set(self.kind(), lambda name, type_: type_.zero())

    def example(self, name: str) -> Any:
        return self.members.set(self.kind(), lambda name, type_: type_.example(name))


class SequenceOf(Defined):
    def __init__(self, id_: str, name: str, element: WireType) -> None:
        self.name, self.element = name, element
        self.ice = IcePy.defineSequence(id_, (), element.ice)
        self.id, self.parts = id_, (element,)

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if not isinstance(node, tree.Sequence):
            return self._wrong(node, path, report, "a list")
        made = [self.element.to_ice(item, (*path, at), report) for at, item in enumerate(node.items)]
        if self.element.name != "byte":
            return made
        return bytes(0 if value is None else value for value in made)

    def to_data(self, value: Any) -> Data:
        return [self.element.to_data(item) for item in value]

    def zero(self) -> Any:
        return b"" if self.element.name == "byte" else []

    def example(self, name: str) -> Any:
        return b"\0" if self.element.name == "byte" else [self.element.example(name)]


class MapOf(Defined):
    def __init__(self, id_: str, name: str, key: WireType, value: WireType) -> None:
        self.name, self.key_type, self.value_type = name, key, value
        self.ice = IcePy.defineDictionary(id_, (), key.ice, value.ice)
        self.id, self.parts = id_, (key, value)

    def to_ice(self, node: Node, path: Path, report: Report) -> Any:
        if isinstance(self.key_type, Struct):
            return self._of_pairs(node, path, report)
        if not isinstance(node, tree.Mapping):
            return self._wrong(node, path, report, "a mapping")
        made = {}
        for key, value in node.items():
            at = (*path, key.lexeme)
            made[self.key_type.key(key, at, report)] = self.value_type.to_ice(value, at, report)
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
            key = self.key_type.to_ice(entries["key"][1], (*at, "key"), report)
            made[key] = self.value_type.to_ice(entries["value"][1], (*at, "value"), report)
        return made

    def to_data(self, value: Any) -> Data:
        if isinstance(self.key_type, Struct):
            return [{"key": self.key_type.to_data(k), "value": self.value_type.to_data(v)} for k, v in value.items()]
        return {_as_key(self.key_type.to_data(key)): self.value_type.to_data(item) for key, item in value.items()}

    def zero(self) -> Any:
        return {}

    def example(self, name: str) -> Any:
        return {self.key_type.example("key"): self.value_type.example(name)}


def _as_key(data: Data) -> str:
    return str(data).lower() if isinstance(data, bool) else str(data)
