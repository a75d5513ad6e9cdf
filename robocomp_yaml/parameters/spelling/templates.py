"""How properties spell parameters: by their paths, or by the entries of `legacy:`."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling
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
    """Why a spelling does not fit the type of its parameter, or ''."""
    key, placeholders = spelling.key, placeholders_of(spelling.key)
    if isinstance(type_, RecordType) and type_.is_group:
        return "is for a group: spell the members of the group, such as period.compute"
    if isinstance(type_, MapType):
        return "is for a map, and maps are spelled by their paths"
    if spelling.fields and (key or spelling.columns or spelling.separators):
        return "cannot have 'fields' together with 'key', 'columns' or 'separators'"
    if not spelling.fields and not key:
        return "has neither 'key' nor 'fields'"
    if isinstance(type_, (BasicType, EnumType)):
        plain = not (spelling.fields or spelling.columns or spelling.separators or spelling.count or placeholders)
        return "" if plain else "is for rows, and the parameter is one plain value"
    if isinstance(type_, RecordType):
        return (
            "is for a list, and the parameter is one record"
            if placeholders or spelling.count
            else _row(spelling, type_, ())
        )
    element = type_.element
    if spelling.separators:
        return _separated(spelling, type_, placeholders)
    if spelling.fields:
        return _fields(spelling, element)
    return _rows(spelling, element, placeholders)


def _rows(spelling: LegacySpelling, element: Type, placeholders: tuple[str, ...]) -> str:
    if not placeholders:
        return "needs the row number {i} in its key, or 'separators' for a list in one property"
    if isinstance(element, RecordType):
        if found := _row(spelling, element, tuple(name for name in placeholders if name != "i")):
            return found
        return "has no row number {i}, so it cannot have 'count'" if "i" not in placeholders and spelling.count else ""
    if placeholders != ("i",):
        return "has placeholders other than {i}, and the elements are not records"
    if spelling.columns:
        return "has columns, and the elements are not records"
    return "" if isinstance(element, (BasicType, EnumType)) else "cannot nest lists or maps in rows"


def _row(spelling: LegacySpelling, record: RecordType, in_key: tuple[str, ...]) -> str:
    if not spelling.columns:
        return "needs 'columns': the members in a row, in order"
    for name in (*in_key, *spelling.columns):
        member = record.member(name)
        if member is None:
            return f"names unknown member '{name}' of {record.name}"
        if not isinstance(member.type, (BasicType, EnumType)):
            return f"has '{name}' in a row, which is not a plain value"
    both = set(in_key) & set(spelling.columns)
    if both:
        return f"has '{min(both)}' both in the key and in the columns"
    return _omitted(record, {*in_key, *spelling.columns})


def _omitted(record: RecordType, named: set[str]) -> str:
    left = [member.name for member in record.members if member.name not in named and member.required]
    return f"omits '{left[0]}', which has no default" if left else ""


def _fields(spelling: LegacySpelling, element: Type) -> str:
    if not isinstance(element, RecordType):
        return "has 'fields', and the elements are not records"
    for name, key in spelling.fields:
        member = element.member(name)
        if member is None:
            return f"names unknown member '{name}' of {element.name}"
        if not isinstance(member.type, (BasicType, EnumType)):
            return f"has '{name}' as a field, which is not a plain value"
        if placeholders_of(key) != ("i",):
            return f"needs {{i}} once in the property of '{name}'"
    return _omitted(element, {name for name, _ in spelling.fields})


def _separated(spelling: LegacySpelling, type_: ListType, placeholders: tuple[str, ...]) -> str:
    if placeholders or spelling.count:
        return "has 'separators' for one property, so it cannot have {i} or 'count'"
    depth, inner = 0, type_
    found: Type = inner
    while isinstance(found, ListType):
        depth, found = depth + 1, found.element
    if isinstance(found, RecordType):
        if fault_ := _row(spelling, found, ()):
            return fault_
        depth += 1
    elif spelling.columns:
        return "has columns, and the elements are not records"
    if not isinstance(found, (BasicType, EnumType, RecordType)):
        return "cannot nest maps in one property"
    if depth != len(spelling.separators):
        return f"needs {depth} separator{'' if depth == 1 else 's'}, one for each level"
    return ""


def exact_keys(parameters: Parameters) -> Iterator[tuple[str, str, bool]]:
    """The properties that parameters always have: (path, property, whether `legacy:` spells it). A list or map that is
    spelled by its path has the stem of its properties; rows have only their count."""
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
    """The names of properties with placeholders: (path, name)."""
    for path, _ in leaves(parameters.root):
        spelling = parameters.spelling(path)
        if spelling is not None:
            keys = [spelling.key] if spelling.key else [key for _, key in spelling.fields]
            for key in keys:
                if placeholders_of(key):
                    yield path, key
