"""Defaults filled in by hand: what there is when nobody gives a value."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.types import ListType, MapType, Parameters, RecordType, Type

PERIOD, EMERGENCY = 100, 500
"""How often compute() and emergency() run where nobody says it, in milliseconds."""


def period(parameters: Parameters) -> int:
    """How often compute() runs where no values say it, in milliseconds."""
    given = defaults(parameters.root).get("period")
    return int(given.get("compute", PERIOD)) if isinstance(given, dict) else PERIOD


def defaults(record: RecordType) -> dict[str, Any]:
    """The values that there are when nobody gives any; what has no default is left out."""
    data: dict[str, Any] = {}
    for member in record.members:
        if member.default is not None:
            data[member.name] = with_defaults(member.type, member.default.data)
        elif isinstance(member.type, RecordType) and member.type.is_group:
            data[member.name] = defaults(member.type)
    return data


def with_defaults(type_: Type, data: Any) -> Any:
    """A value with the defaults of what it leaves out."""
    match type_:
        case RecordType() if isinstance(data, dict):
            given = {m.name: with_defaults(m.type, data[m.name]) for m in type_.members if m.name in data}
            return {**defaults(type_), **given}
        case ListType(element=element) if isinstance(data, list):
            return [with_defaults(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            return {key: with_defaults(element, item) for key, item in data.items()}
        case _:
            return data
