"""A fast test whether properties can certainly hold values, so that `check` does not have to write them.

Only texts, empty values and rows of `legacy:` can be a problem; numbers are skipped.
"""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedMember,
    Type,
    leaves,
)
from robocomp_yaml.source.properties import unwritable

_ODD = frozenset('\r\n\0\t\ufeff$"')
Known = dict[str, list[ResolvedMember]]
"""The members of structs, by name, that can be a problem."""


def is_surely_writable(parameters: Parameters, data: dict[str, Any]) -> bool:
    """Whether every value can certainly be written as a property."""
    spelled = {spelling.path for spelling in parameters.spellings}
    if any(
        path in spelled and not isinstance(member.type, (BasicType, EnumType))
        for path, member in leaves(parameters.root)
    ):
        return False
    return _record(parameters.root, data, {})


def _record(record: RecordType, data: dict[str, Any], known: Known) -> bool:
    for member in _risky_members(record, known):
        if member.name in data:
            value = data[member.name]
            if value in ("", [], {}) and (member.optional or member.default is not None):
                return False
            if not _value(member.type, value, known):
                return False
    return True


def _value(type_: Type, value: Any, known: Known) -> bool:
    if isinstance(value, str):
        return _ODD.isdisjoint(value)
    if isinstance(type_, RecordType):
        return _record(type_, value, known)
    if isinstance(type_, ListType):
        element = type_.element
        return not _is_risky(element, known) or all(_value(element, item, known) for item in value)
    if isinstance(type_, MapType):
        element = type_.element
        return all(not unwritable(key or "x", "x") and _value(element, item, known) for key, item in value.items())
    return True


def _risky_members(record: RecordType, known: Known) -> list[ResolvedMember]:
    if record.name not in known:
        found = [member for member in record.members if _is_risky(member.type, known)]
        return known.setdefault(record.name, found) if record.name else found
    return known[record.name]


def _is_risky(type_: Type, known: Known) -> bool:
    if isinstance(type_, RecordType):
        return bool(_risky_members(type_, known))
    return isinstance(type_, (ListType, MapType)) or (isinstance(type_, BasicType) and type_.name == "string")
