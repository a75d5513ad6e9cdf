"""Several values in one property: rows of columns, and lists between separators.

What is split is stripped of blanks, as legacy files indent their rows; so a part cannot start or end with one.
"""

from __future__ import annotations

from typing import Any

from robocomp_yaml.parameters.specification.document import Spelling
from robocomp_yaml.parameters.types import ListType, RecordType, ScalarType, Type

_BLANKS = " \t"


def split(text: str, separator: str) -> list[str]:
    """The parts of a text; a separator of blanks stands for any run of them."""
    if not separator.strip(_BLANKS):
        return text.split()
    return [part.strip(_BLANKS) for part in text.split(separator.strip(_BLANKS))]


def columns(record: RecordType, names: tuple[str, ...]) -> list[tuple[str, ScalarType]]:
    """The members that a row holds."""
    found = [(name, record.member(name)) for name in names]
    return [(name, member.type) for name, member in found if member is not None]  # type: ignore[misc]


def is_optional(record: RecordType, name: str) -> bool:
    member = record.member(name)
    return member is not None and member.optional


def read_row(record: RecordType, names: tuple[str, ...], text: str, separator: str) -> dict[str, Any] | None:
    """The texts of a row by column; a column that is empty, and is no text, has no value. Optional columns at the end
    may be left out. None where the columns do not add up."""
    parts = split(text, separator)
    if len(parts) > len(names) or any(not is_optional(record, name) for name in names[len(parts) :]):
        return None
    found: dict[str, Any] = {}
    for name, part in zip(names, parts, strict=False):
        member = record.member(name)
        assert member is not None
        if part or (getattr(member.type, "name", "") == "string" and not member.optional):
            found[name] = part
    return found


def read_parts(type_: Type, text: str, spelling: Spelling, level: int = 0) -> Any:
    """Nested lists (and records, at the innermost level) between separators."""
    if isinstance(type_, RecordType):
        return read_row(type_, spelling.columns, text, spelling.separators[level])
    if not isinstance(type_, ListType):
        return text
    separator = spelling.separators[level]
    if level == 0 and spelling.trailing and text.rstrip(_BLANKS).endswith(separator.strip(_BLANKS)):
        text = text.rstrip(_BLANKS)[: -len(separator.strip(_BLANKS)) or None]
        if not text:
            return [] if not isinstance(type_.element, ListType) else [[]]
    elif not text:
        return []
    return [read_parts(type_.element, part, spelling, level + 1) for part in split(text, separator)]


def join_parts(texts: Any, spelling: Spelling, level: int = 0) -> str:
    """The text of nested lists of texts; the outermost separator stands once more at the end where it trails."""
    if isinstance(texts, str):
        return texts
    separator = spelling.separators[level]
    joined = separator.join(join_parts(part, spelling, level + 1) for part in texts)
    return joined + separator if level == 0 and spelling.trailing and texts else joined
