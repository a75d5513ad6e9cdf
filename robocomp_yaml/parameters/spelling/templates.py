"""How parameters are spelled as properties: by their paths, or as the legacy table says.

A shape says, for one parameter, which properties hold it; writing (`properties`) and reading (`reading`) both go by it.
"""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.parameters.specification.document import LegacySpelling
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    Type,
    leaves,
)
from robocomp_yaml.semantics.spellings import placeholders as placeholders_of


def fault(spelling: LegacySpelling, type_: Type) -> str:
    """Why a parameter of this type cannot be spelled so, or ''."""
    key, holes = spelling.key, placeholders_of(spelling.key)
    if isinstance(type_, RecordType) and type_.is_group:
        return "is a group's: spell what the group holds, such as period.compute"
    if isinstance(type_, MapType):
        return "is a map's; maps go by their paths"
    if spelling.fields and (key or spelling.columns or spelling.separators):
        return "has 'fields' beside 'key', 'columns' or 'separators'"
    if not spelling.fields and not key:
        return "has neither 'key' nor 'fields'"
    if isinstance(type_, BasicType | EnumType):
        plain = not (spelling.fields or spelling.columns or spelling.separators or spelling.count or holes)
        return "" if plain else "is for rows, and the parameter is one plain value"
    if isinstance(type_, RecordType):
        return (
            "is for a list, and the parameter is one record" if holes or spelling.count else _row(spelling, type_, ())
        )
    element = type_.element
    if spelling.separators:
        return _separated(spelling, type_, holes)
    if spelling.fields:
        return _fields(spelling, element)
    return _rows(spelling, element, holes)


def _rows(spelling: LegacySpelling, element: Type, holes: tuple[str, ...]) -> str:
    if not holes:
        return "needs {i}, the row's number, in its key (or 'separators', for a list in one property)"
    if isinstance(element, RecordType):
        if found := _row(spelling, element, tuple(hole for hole in holes if hole != "i")):
            return found
        return "has no row's number, so no 'count'" if "i" not in holes and spelling.count else ""
    if holes != ("i",):
        return "has holes other than {i}, and the entries are no records"
    if spelling.columns:
        return "has columns, and the entries are no records"
    return "" if isinstance(element, BasicType | EnumType) else "cannot nest lists or maps in rows"


def _row(spelling: LegacySpelling, record: RecordType, in_key: tuple[str, ...]) -> str:
    if not spelling.columns:
        return "needs 'columns': the members that a row holds, in order"
    for name in (*in_key, *spelling.columns):
        member = record.member(name)
        if member is None:
            return f"names '{name}', which is no member of {record.name}"
        if not isinstance(member.type, BasicType | EnumType):
            return f"has '{name}' in a row, which is no plain value"
    both = set(in_key) & set(spelling.columns)
    if both:
        return f"has '{min(both)}' both in the key and in the columns"
    return _left_out(record, {*in_key, *spelling.columns})


def _left_out(record: RecordType, named: set[str]) -> str:
    left = [member.name for member in record.members if member.name not in named and member.required]
    return f"leaves '{left[0]}' out, which has no default" if left else ""


def _fields(spelling: LegacySpelling, element: Type) -> str:
    if not isinstance(element, RecordType):
        return "has 'fields', and the entries are no records"
    for name, key in spelling.fields:
        member = element.member(name)
        if member is None:
            return f"names '{name}', which is no member of {element.name}"
        if not isinstance(member.type, BasicType | EnumType):
            return f"has '{name}' as a field, which is no plain value"
        if placeholders_of(key) != ("i",):
            return f"needs {{i}} once in the property of '{name}'"
    return _left_out(element, {name for name, _ in spelling.fields})


def _separated(spelling: LegacySpelling, type_: ListType, holes: tuple[str, ...]) -> str:
    if holes or spelling.count:
        return "has 'separators', and all in one property: so no {i} and no 'count'"
    depth, inner = 0, type_
    found: Type = inner
    while isinstance(found, ListType):
        depth, found = depth + 1, found.element
    if isinstance(found, RecordType):
        if fault_ := _row(spelling, found, ()):
            return fault_
        depth += 1
    elif spelling.columns:
        return "has columns, and the entries are no records"
    if not isinstance(found, BasicType | EnumType | RecordType):
        return "cannot nest maps in one property"
    if depth != len(spelling.separators):
        return f"needs {depth} separator{'' if depth == 1 else 's'}, one a level"
    return ""


def exact_keys(parameters: Parameters) -> Iterator[tuple[str, str, bool]]:
    """Each property that a parameter always has: (path, property, whether it is spelled by the table). For a list or
    map by its path it is the stem; rows have only their count."""
    for path, _ in leaves(parameters.root):
        spelling = parameters.spelling(path)
        if spelling is None:
            yield path, path, False
        else:
            if spelling.key and not placeholders_of(spelling.key):
                yield path, spelling.key, True
            if spelling.count:
                yield path, spelling.count, True


def row_keys(parameters: Parameters) -> Iterator[tuple[str, str]]:
    for path, _ in leaves(parameters.root):
        spelling = parameters.spelling(path)
        if spelling is not None:
            keys = [spelling.key] if spelling.key else [key for _, key in spelling.fields]
            for key in keys:
                if placeholders_of(key):
                    yield path, key
