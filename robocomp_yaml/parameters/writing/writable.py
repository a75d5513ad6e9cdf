"""A quick look whether properties can hold values at all events, so that `check` need not write them to know.

Only text and what is empty can be trouble, and rows of the legacy table; numbers are not looked at.
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
"""Of structs, which stand in many places, the members that can be trouble."""


def is_surely_writable(parameters: Parameters, data: dict[str, Any]) -> bool:
    """Whether every value has a property that says it, whatever else there is."""
    spelled = {spelling.path for spelling in parameters.spellings}
    if any(
        path in spelled and not isinstance(member.type, BasicType | EnumType)
        for path, member in leaves(parameters.root)
    ):
        return False
    return _record(parameters.root, data, {})


def _record(record: RecordType, data: dict[str, Any], known: Known) -> bool:
    for member in _troublesome(record, known):
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
        return not _can_be_trouble(element, known) or all(_value(element, item, known) for item in value)
    if isinstance(type_, MapType):
        element = type_.element
        return all(not unwritable(key or "x", "x") and _value(element, item, known) for key, item in value.items())
    return True


def _troublesome(record: RecordType, known: Known) -> list[ResolvedMember]:
    if record.name not in known:
        found = [member for member in record.members if _can_be_trouble(member.type, known)]
        return known.setdefault(record.name, found) if record.name else found
    return known[record.name]


def _can_be_trouble(type_: Type, known: Known) -> bool:
    if isinstance(type_, RecordType):
        return bool(_troublesome(type_, known))
    return isinstance(type_, ListType | MapType) or (isinstance(type_, BasicType) and type_.name == "string")
