"""The list of values that CommonBehavior has, by dotted paths, as the data that it means, and back."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import msgspec

from robocomp_yaml.parameters.editing import show
from robocomp_yaml.parameters.types import BasicType, ListType, MapType, RecordType, Type, is_secret, unit_of
from robocomp_yaml.semantics import paths, secrecy, texts
from robocomp_yaml.semantics.paths import Path, Step, dotted, in_words
from robocomp_yaml.semantics.secrecy import HIDDEN
from robocomp_yaml.source.yaml_text import flow

_ROUNDING = 1e-6  # relative: what a `float` changes in a number


class RunningValue(msgspec.Struct, frozen=True):
    """A plain value of a running component, or an empty list or map. Secrets are hidden."""

    path: str
    data: Any
    type: str
    unit: str = ""
    editable: bool = False


class Listed(msgspec.Struct, frozen=True):
    """One entry of CommonBehavior's list."""

    text: str
    type: str
    editable: bool


def in_line(data: Any) -> str:
    """A value as text in one line."""
    return HIDDEN if data == HIDDEN else flow(data)


def read(type_: str, text: str) -> Any:
    """The data that a text means in a type of CommonBehavior's list; None if it means none. A hidden secret stays."""
    return text if text == HIDDEN else texts.read(type_, text)


def same(type_: str, left: str, right: str) -> bool:
    """Whether two texts mean the same value, as far as a `float` can hold it."""
    first, second = texts.read(type_, left), texts.read(type_, right)
    if isinstance(first, float) and isinstance(second, (int, float)):
        return math.isclose(first, second, rel_tol=_ROUNDING)
    return first == second


def values(root: RecordType | None, listed: Mapping[str, Listed]) -> list[RunningValue]:
    """The values of a list of CommonBehavior. `root` is None if no document defines the parameters."""
    used = set[str]()
    rows = list(_rows(root, (), listed, used)) if root is not None else []
    for key, entry in listed.items():
        if key not in used:
            data = read(entry.type, entry.text)
            shown = data if not isinstance(data, str) else secrecy.shown(key.rpartition(".")[2], data)
            rows.append(RunningValue(key, shown, entry.type, editable=entry.editable))
    return rows


def _rows(type_: Type, path: Path, listed: Mapping[str, Listed], used: set[str]) -> Iterator[RunningValue]:
    key = dotted(path)
    if isinstance(type_, RecordType):
        for member in type_.members:
            yield from _rows(member.type, (*path, member.name), listed, used)
    elif isinstance(type_, (ListType, MapType)):
        sizes = f"{key}.{'size' if isinstance(type_, ListType) else 'keys'}"
        used.add(sizes)
        names = names_in(type_, key, listed)
        for name in names:
            yield from _rows(type_.element, (*path, name), listed, used)
        if not names and sizes in listed:
            empty: tuple[Any, str] = ([], "list") if isinstance(type_, ListType) else ({}, "map")
            yield RunningValue(in_words(path), *empty, editable=listed[sizes].editable)
    elif key in listed:
        used.add(key)
        data = _shown(type_, path, listed[key].text)
        yield RunningValue(in_words(path), data, type_.name, unit_of(type_), listed[key].editable)


def names_in(type_: ListType | MapType, key: str, listed: Mapping[str, Listed]) -> list[Step]:
    """The indexes of a list, or the keys of a map, at a dotted path."""
    if isinstance(type_, ListType):
        entry = listed.get(f"{key}.size")
        return list(range(texts.count(entry.text, 1_000_000) or 0)) if entry else []
    entry = listed.get(f"{key}.keys")
    return [paths.unescaped(name) for name in entry.text.split()] if entry else []


def data_at(type_: Type, path: Path, listed: Mapping[str, Listed]) -> Any:
    """The values at a path; None if there is none."""
    key = dotted(path)
    if isinstance(type_, RecordType):
        inner = {member.name: data_at(member.type, (*path, member.name), listed) for member in type_.members}
        return {name: value for name, value in inner.items() if value is not None}
    if isinstance(type_, ListType):
        return [data_at(type_.element, (*path, name), listed) for name in names_in(type_, key, listed)]
    if isinstance(type_, MapType):
        return {str(name): data_at(type_.element, (*path, name), listed) for name in names_in(type_, key, listed)}
    return _shown(type_, path, listed[key].text) if key in listed else None


def _shown(type_: Type, path: Path, text: str) -> Any:
    """A plain value as it may be shown, also by a component that does not hide its secrets."""
    if is_secret(type_):
        return HIDDEN if text else text
    data = read(type_.name, text) if isinstance(type_, BasicType) else text
    name = path[-1]
    return secrecy.shown(name if isinstance(name, str) else "", data) if isinstance(data, str) else data


def flat(type_: Type, data: Any, path: Path) -> Iterator[tuple[str, str]]:
    """Data as texts by dotted paths, as CommonBehavior lists them. What a record omits has its default."""
    if isinstance(type_, RecordType):
        for member in type_.members:
            default = member.default.data if member.default is not None else None
            value = data.get(member.name, default)
            if value is not None:
                yield from flat(member.type, value, (*path, member.name))
    elif isinstance(type_, ListType):
        yield f"{dotted(path)}.size", str(len(data))
        for at, item in enumerate(data):
            yield from flat(type_.element, item, (*path, at))
    elif isinstance(type_, MapType):
        yield f"{dotted(path)}.keys", " ".join(paths.escaped(name) for name in data)
        for name, item in data.items():
            yield from flat(type_.element, item, (*path, name))
    else:
        yield dotted(path), texts.spelled(data)


def missing_at(root: RecordType, steps: list[str], listed: Mapping[str, Listed]) -> int | None:
    """Which of the steps of a known path leads to an element of a list or map that is not there; None if none does."""
    typed = tuple(show.typed(root, steps))
    for depth, step in enumerate(typed):
        owner = show.type_at(root, steps[:depth])
        if isinstance(owner, (ListType, MapType)) and step not in names_in(owner, dotted(typed[:depth]), listed):
            return depth
    return None


def with_value(whole: Any, path: Path, data: Any) -> Any:
    """The data with another value at a path, which may be a further element."""
    if not path:
        return data
    first, *rest = path
    if isinstance(whole, list):
        assert isinstance(first, int)
        inner = whole[first] if first < len(whole) else None
        return [*whole[:first], with_value(inner, tuple(rest), data), *whole[first + 1 :]]
    made = dict(whole or {})
    made[first] = with_value(made.get(first), tuple(rest), data)
    return made


def without_hidden(data: Any) -> Any:
    """The data with None, which is unknown, for secrets."""
    if isinstance(data, dict):
        return {name: without_hidden(value) for name, value in data.items()}
    if isinstance(data, list):
        return [without_hidden(value) for value in data]
    return None if data == HIDDEN else data
