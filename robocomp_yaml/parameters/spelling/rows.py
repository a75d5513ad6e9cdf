"""Several values in one property, by their types; `semantics.rows` says how they are split."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.specification.document import Spelling
from robocomp_yaml.parameters.types import EnumType, ListType, RecordType, ScalarType, Type
from robocomp_yaml.semantics import rows, texts


def columns(record: RecordType, names: tuple[str, ...]) -> list[tuple[str, ScalarType]]:
    """The members that a row holds."""
    found = [(name, record.member(name)) for name in names]
    return [(name, member.type) for name, member in found if member is not None]  # type: ignore[misc]


def is_optional(record: RecordType, name: str) -> bool:
    member = record.member(name)
    return member is not None and member.optional


def is_text(record: RecordType, name: str) -> bool:
    member = record.member(name)
    return member is not None and getattr(member.type, "name", "") == "string"


def keeps_empty(record: RecordType, name: str) -> bool:
    """Whether an empty column has a value: the empty text."""
    return is_text(record, name) and not is_optional(record, name)


def read_row(record: RecordType, names: tuple[str, ...], text: str, separator: str) -> rows.Row:
    return rows.row(text, separator, names, lambda name: is_optional(record, name), lambda name: is_text(record, name))


def read_parts(type_: Type, text: str, spelling: Spelling) -> Any:
    """Nested lists (and records, at the innermost level) between separators."""
    levels = 0
    while isinstance(type_, ListType):
        levels, type_ = levels + 1, type_.element
    return _parts(type_, rows.nested(text, spelling.separators, levels, spelling.trailing), spelling, levels)


def _parts(type_: Type, parts: Any, spelling: Spelling, levels: int) -> Any:
    if isinstance(parts, list):
        return [_parts(type_, part, spelling, levels) for part in parts]
    if isinstance(type_, RecordType):
        return read_row(type_, spelling.columns, parts, spelling.separators[levels])
    return parts


def plain(type_: ScalarType, text: str) -> Any:
    """The value that a text spells. Raises ValueError where it spells none."""
    found = text if isinstance(type_, EnumType) else texts.read(type_.name, text)
    if found is None:
        raise ValueError(f"'{text}' is no {type_.name}")
    return found
