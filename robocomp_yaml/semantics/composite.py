# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""The types of parameters that contain values: lists, maps and records; and the members of records.

All values are immutable: lists become tuples, maps read-only mappings, records instances of their classes.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Any, Union

from . import limits
from .paths import Path, in_words
from .plain import Conversion, PlainKind, shown
from .references import Unresolved
from .secrecy import HIDDEN

Kind = Union[PlainKind, "ListKind", "MapKind", "RecordKind"]


class _SizedKind:
    """A type of values with elements: `at_least` to `at_most` of them, any number where it is None."""

    def __init__(self, element: Kind, at_least: int = 0, at_most: int | None = None) -> None:
        self.element = element
        self._at_least, self._at_most = at_least, at_most

    def check_size(self, count: int, path: Path, conversion: Conversion) -> None:
        if not limits.has_size(count, self._at_least, self._at_most):
            elements, expected = limits.elements(count), limits.size_in_words(self._at_least, self._at_most)
            conversion.reject(path, f"has {elements}, and must have {expected}", elements, expected)


class ListKind(_SizedKind):
    def __init__(self, element: Kind, at_least: int = 0, at_most: int | None = None, unique: bool = False) -> None:
        super().__init__(element, at_least, at_most)
        self._unique = unique

    def convert(self, raw: Any, path: Path, conversion: Conversion) -> Any:
        if not isinstance(raw, (list, tuple)):
            conversion.reject(path, f"must be {limits.LIST}, and is {shown(raw)}", shown(raw), limits.LIST)
            return None
        self.check_size(len(raw), path, conversion)
        items = tuple(self.element.convert(item, (*path, index), conversion) for index, item in enumerate(raw))
        known = [item for item in items if item is not None]
        if self._unique and len(set(known)) < len(known):
            twice = next(item for index, item in enumerate(known) if item in known[:index])
            text = self.element.shown(twice) if isinstance(self.element, PlainKind) else shown(twice)
            conversion.reject(path, f"contains {text} twice", text, "elements that all differ")
        return items


class MapKind(_SizedKind):
    """Maps: values by name."""

    def convert(self, raw: Any, path: Path, conversion: Conversion) -> Any:
        if not isinstance(raw, Mapping) or not all(isinstance(name, str) for name in raw):
            conversion.reject(path, f"must be {limits.MAP}, and is {shown(raw)}", shown(raw), "a mapping")
            return None
        self.check_size(len(raw), path, conversion)
        return MappingProxyType(
            {name: self.element.convert(item, (*path, name), conversion) for name, item in raw.items()}
        )


class RecordMember:
    """A member of a record. `key` is its name in documents and paths, `attribute` its name in code."""

    attribute = ""

    def __init__(
        self, kind: Kind, key: str, has_default: bool, default: Any, is_optional: bool, is_editable: bool
    ) -> None:
        self.kind = kind
        self.key = key
        self.has_default, self.default = has_default, default
        self.is_optional = is_optional
        self.is_editable = is_editable

    @property
    def reads_as_empty(self) -> bool:
        """Whether a text or list that has no property is empty, rather than missing."""
        return not self.has_default and not self.is_optional


_NOTHING = object()


def member(
    kind: Kind, *, default: Any = _NOTHING, optional: bool = False, editable: bool = False, key: str = ""
) -> Any:
    """A member of a record, for the class that declares it."""
    has_default = default is not _NOTHING
    return RecordMember(kind, key, has_default, default if has_default else None, optional, editable)


class Record:
    """A group of values, which can be read and compared. Setting or deleting one raises AttributeError."""

    __hash__ = None  # type: ignore[assignment]
    __members__: tuple[RecordMember, ...] = ()

    def __init_subclass__(cls) -> None:
        own = {name: value for name, value in vars(cls).items() if isinstance(value, RecordMember)}
        for name, value in own.items():
            value.attribute, value.key = name, value.key or name
            delattr(cls, name)  # each instance has its own value
        cls.__members__ = (*cls.__members__, *own.values())

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be set: use set() of the parameters")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be deleted")

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and all(
            getattr(other, member.attribute) == getattr(self, member.attribute) for member in self.__members__
        )

    def __repr__(self) -> str:
        pairs = ((member, getattr(self, member.attribute)) for member in self.__members__)
        shown_pairs = (f"{m.attribute}={HIDDEN if _hides(m.kind) and value else repr(value)}" for m, value in pairs)
        return f"{type(self).__name__}({', '.join(shown_pairs)})"


def _hides(kind: Kind) -> bool:
    """Whether plain values of a type, or its plain elements, are secret."""
    while isinstance(kind, _SizedKind):
        kind = kind.element
    return isinstance(kind, PlainKind) and kind.is_secret


class RecordKind:
    """Records of the class `made`. `is_group`: the record is a group, not a struct."""

    def __init__(self, made: type[Record], *, is_group: bool = False) -> None:
        self.made = made
        self.is_group = is_group
        self.members = {member.key: member for member in made.__members__}

    def convert(self, raw: Any, path: Path, conversion: Conversion) -> Any:
        if isinstance(raw, self.made):
            raw = {member.key: getattr(raw, member.attribute) for member in self.members.values()}
            raw = {key: value for key, value in raw.items() if value is not None}
        if not isinstance(raw, Mapping):
            words = limits.record_in_words(self.members)
            conversion.reject(path, f"must be {words}, and is {shown(raw)}", shown(raw), words)
            return None
        for key in raw:
            if key not in self.members:
                conversion.reject((), f"unknown parameter '{in_words((*path, str(key)))}'")
        made = self.made()
        for member in self.members.values():
            object.__setattr__(made, member.attribute, self._member(member, raw, (*path, member.key), conversion))
        return made

    def changed(self, record: Any, raw: Mapping[str, Any], keys: Collection[str], conversion: Conversion) -> Any:
        """A copy of a record in which the members with these keys are converted from `raw`."""
        made = self.made()
        for key, member in self.members.items():
            value = self._member(member, raw, (key,), conversion) if key in keys else getattr(record, member.attribute)
            object.__setattr__(made, member.attribute, value)
        return made

    def _member(self, member: RecordMember, raw: Mapping[str, Any], path: Path, conversion: Conversion) -> Any:
        if member.key in raw:
            return member.kind.convert(raw[member.key], path, conversion)
        if member.has_default:
            return member.kind.convert(member.default, path, Conversion())  # the compiler has checked it
        if isinstance(member.kind, RecordKind) and member.kind.is_group:
            return member.kind.convert({}, path, conversion)
        if not member.is_optional:
            conversion.reject(path, "has no value, and no default")
        return None


# The names that generated code uses.
listing, naming, record = ListKind, MapKind, RecordKind


def group(made: type[Record]) -> Kind:
    return RecordKind(made, is_group=True)


def data(kind: Kind, value: Any) -> Any:
    """A value as plain data: dictionaries, lists, numbers, texts. Missing optional members are omitted. References that
    are not resolved are as documents spell them."""
    if isinstance(kind, RecordKind):
        return members_data(kind, value, kind.members)
    if isinstance(kind, ListKind):
        return [data(kind.element, item) for item in value]
    if isinstance(kind, MapKind):
        return {name: data(kind.element, item) for name, item in value.items()}
    return dict(value.data) if isinstance(value, Unresolved) else value


def members_data(kind: RecordKind, record: Any, keys: Collection[str]) -> dict[str, Any]:
    """Those members of a record that have these keys, as plain data."""
    pairs = ((member, getattr(record, member.attribute)) for key, member in kind.members.items() if key in keys)
    return {member.key: data(member.kind, item) for member, item in pairs if item is not None}
