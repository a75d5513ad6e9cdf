"""Values from defaults alone."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.types import ListType, MapType, Parameters, RecordType, Type

PERIOD, EMERGENCY = 100, 500
"""The default periods of compute() and emergency(), in milliseconds."""


def period(parameters: Parameters) -> int:
    """The period of compute() that the defaults set, in milliseconds."""
    group = defaults(parameters.root).get("period")
    return int(group.get("compute", PERIOD)) if isinstance(group, dict) else PERIOD


def defaults(record: RecordType) -> dict[str, Any]:
    """The values of a record that no document sets. Members without a default are omitted."""
    data: dict[str, Any] = {}
    for member in record.members:
        if member.default is not None:
            data[member.name] = with_defaults(member.type, member.default.data)
        elif isinstance(member.type, RecordType) and member.type.is_group:
            data[member.name] = defaults(member.type)
    return data


def with_defaults(type_: Type, data: Any) -> Any:
    """A value, completed with defaults at every level."""
    match type_:
        case RecordType() if isinstance(data, dict):
            own = {m.name: with_defaults(m.type, data[m.name]) for m in type_.members if m.name in data}
            return {**defaults(type_), **own}
        case ListType(element=element) if isinstance(data, list):
            return [with_defaults(element, item) for item in data]
        case MapType(element=element) if isinstance(data, dict):
            return {key: with_defaults(element, item) for key, item in data.items()}
        case _:
            return data
