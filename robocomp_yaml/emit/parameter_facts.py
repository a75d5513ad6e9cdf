"""What generators of accessors need to know of parameters: what is said of each, and which records they use."""

from __future__ import annotations

from robocomp_yaml.parameters.hidden import hidden
from robocomp_yaml.parameters.json_schema import shortened
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Member,
    RecordType,
    Type,
    is_secret,
    unit_of,
)


def facts(member: Member) -> str:
    """Limits, unit, default and whether it may change, in one line; '' where there is nothing to say."""
    found = [*_limits(member.type)]
    if not found and (unit := unit_of(member.type)):
        found.append(f"in {unit}")
    if member.default is not None:
        found.append(f"default: {shortened(hidden(member.type, member.default.data))}")
    if member.optional:
        found.append("optional")
    if member.editable and not member.is_group:
        found.append("may change while the component runs")
    if is_secret(member.type):
        found.append("secret")
    line = "; ".join(found)
    return f"{line[:1].upper()}{line[1:]}." if line else ""


def _limits(type_: Type) -> list[str]:
    match type_:
        case BasicType():
            unit = f" {type_.unit}" if type_.unit else ""
            if type_.values:
                return [f"one of {', '.join(value.lexeme for value in type_.values)}{unit}"]
            if type_.range is not None:
                return [f"{type_.range.in_words}{unit}"]
            return [f"matches {type_.pattern.text}"] if type_.pattern is not None else []
        case EnumType(allowed=allowed):
            return [f"one of {', '.join(allowed)}"] if allowed != type_.names else []
        case ListType(element=element, size=size) | MapType(element=element, size=size):
            found = [f"{size.in_words} entries"] if size.least or size.most is not None else []
            if isinstance(type_, ListType) and type_.unique:
                found.append("all different")
            return found + [f"each {limit}".replace("each each", "each of these") for limit in _limits(element)]
        case _:
            return []


def records(root: RecordType) -> tuple[list[tuple[str, RecordType]], list[EnumType]]:
    """The records that parameters use, those inside first, by name (a group by its path in code behind a dot, the root
    by a dot); and the enums."""
    found: dict[str, RecordType] = {}
    enums: dict[str, EnumType] = {}

    def visit(type_: Type, path: str) -> None:
        match type_:
            case EnumType(name=name):
                enums.setdefault(name, type_)
            case ListType(element=element) | MapType(element=element):
                visit(element, "")
            case RecordType(name=name, members=members):
                if (name or path) in found:
                    return
                for member in members:
                    visit(member.type, "" if name else inside(path, member.code_name))
                found[name or path] = type_

    visit(root, ".")
    return list(found.items()), list(enums.values())


def inside(group: str, name: str) -> str:
    """The path of a group in a group."""
    return f".{name}" if group == "." else f"{group}.{name}"
