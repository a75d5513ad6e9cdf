"""Several values in one property, by their types. `semantics.rows` splits them."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling
from robocomp_yaml.parameters.types import BasicType, ListType, RecordType, Type
from robocomp_yaml.semantics import rows, texts


def read_row(record: RecordType, names: tuple[str, ...], text: str, separator: str) -> rows.Row:
    """The texts of a row by member; None if the number of columns is wrong."""
    members = record.by_name
    return rows.row(
        text, separator, names, lambda name: members[name].optional, lambda name: _is_string(members[name].type)
    )


def _is_string(type_: Type) -> bool:
    return isinstance(type_, BasicType) and type_.name == "string"


def read_parts(type_: Type, text: str, spelling: LegacySpelling) -> Any:
    """Nested lists of texts (and of rows, at the innermost level) between separators."""
    levels = 0
    while isinstance(type_, ListType):
        levels, type_ = levels + 1, type_.element
    return _parts(type_, rows.nested(text, spelling.separators, levels, spelling.trailing), spelling, levels)


def _parts(type_: Type, parts: Any, spelling: LegacySpelling, levels: int) -> Any:
    if isinstance(parts, list):
        return [_parts(type_, part, spelling, levels) for part in parts]
    if isinstance(type_, RecordType):
        return read_row(type_, spelling.columns, parts, spelling.separators[levels])
    return parts


def as_read(type_: Type, parts: Any, spelling: LegacySpelling) -> Any:
    """Nested lists of texts, where a record is the list of its columns, as `read_parts` returns them."""
    if isinstance(type_, ListType):
        return [as_read(type_.element, part, spelling) for part in parts]
    if not isinstance(type_, RecordType):
        return parts
    keep_empty = {member.name for member in type_.members if _is_string(member.type) and not member.optional}
    return {name: text for name, text in zip(spelling.columns, parts, strict=True) if text or name in keep_empty}


def typed(type_: Type, read: Any) -> Any:
    """The values that texts spell. Raises ValueError where one spells none."""
    if isinstance(type_, ListType):
        return [typed(type_.element, part) for part in read]
    if isinstance(type_, RecordType):
        if read is None:
            raise ValueError("the number of columns is wrong")
        return {name: typed(type_.by_name[name].type, text) for name, text in read.items()}
    found = texts.read(type_.name, read) if isinstance(type_, BasicType) else read
    if found is None:
        raise ValueError(f"'{read}' is not a value of its type")
    return found
