"""Properties back to typed values: the reverse of `write`, by the same table.

Generated components read their properties as this module does. Every value is text at first; Cerberus coerces it,
fills defaults in, and judges.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from robocomp_yaml.parameters.layers.rules import ParameterValidator, Reference, as_data, rules_of
from robocomp_yaml.parameters.specification.document import Spelling
from robocomp_yaml.parameters.spelling import references, rows
from robocomp_yaml.parameters.spelling.paths import unescaped
from robocomp_yaml.parameters.spelling.templates import Template
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Member,
    Parameters,
    RecordType,
    ScalarType,
    Type,
)
from robocomp_yaml.source.properties import unquoted
from robocomp_yaml.source.regular import regular


def properties_to_values(
    parameters: Parameters, properties: Mapping[str, str], *, quoted: bool = False, resolve: bool = False
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The values that a property set gives, and Cerberus's errors by parameter (none: all is well).

    `quoted`: text stands in double quotes, as in flat TOML. `resolve`: references are followed; else they stay
    references.
    """
    texts = _Reader(properties, parameters, quoted, resolve).record(parameters.root, "", "", top=True)
    validator = ParameterValidator(rules_of(parameters.root, from_text=True))
    validator.validate(texts)
    return as_data(parameters.root, validator.document), validator.errors


class _Reader:
    def __init__(self, properties: Mapping[str, str], parameters: Parameters, quoted: bool, resolve: bool) -> None:
        self.properties, self.parameters = properties, parameters
        self.quoted, self.resolve = quoted, resolve
        # every beginning of a name, so that "is there anything below this path" is one look-up
        self.stems: set[str] = set()
        for key in properties:
            at = key.find(".")
            while at >= 0:
                self.stems.add(key[:at])
                at = key.find(".", at + 1)

    def record(self, type_: RecordType, key: str, dotted: str, *, top: bool) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for member in type_.members:
            stem = f"{key}.{member.name}" if key else member.name
            name = f"{dotted}.{member.name}" if dotted else member.name
            if member.is_group and isinstance(member.type, RecordType):
                found[member.name] = self.record(member.type, stem, name, top=top)
                continue
            spelling = self.parameters.spelling(name) if top else None
            value = self.value(member.type, stem) if spelling is None else self.spelled(spelling, member.type)
            if value is None and _reads_as_empty(member):
                value = _empty(member.type)
            if value is not None:
                found[member.name] = value
        return found

    def value(self, type_: Type, key: str) -> Any:
        """What stands under a path, as text; None where nothing does."""
        match type_:
            case BasicType() | EnumType():
                return self.scalar(type_, key)
            case ListType():
                return self.list(type_, key)
            case MapType(element=element):
                keys = self.properties.get(f"{key}.keys")
                if keys is None:
                    return None
                return {unescaped(name): self.entry(element, f"{key}.{name}") for name in keys.split()}
            case _:
                return self.record(type_, key, "", top=False) if key in self.stems else None

    def list(self, type_: ListType, key: str) -> Any:
        size = self.properties.get(f"{key}.size")
        count = self.count(size) if size else 0
        if count is None:
            return size  # no list: refused
        if not size:
            while f"{key}.{count}" in self.stems or f"{key}.{count}" in self.properties:
                count += 1
            if not count:
                return None
        return [self.entry(type_.element, f"{key}.{index}") for index in range(count)]

    def count(self, text: str) -> int | None:
        """How many entries a count asks for; None where it is no count, or more than there could be."""
        count = int(text) if _is_digits(text) and len(text) < 10 else None
        return None if count is None or count > len(self.properties) + 1_000_000 else count

    def entry(self, type_: Type, key: str) -> Any:
        """An entry of a list or map is there, whether or not it has a property."""
        value = self.value(type_, key)
        return _empty(type_) if value is None else value

    def scalar(self, type_: ScalarType, key: str) -> Any:
        text = self.properties.get(key)
        return None if text is None else self.text(type_, text)

    def text(self, type_: ScalarType, text: str) -> Any:
        is_text = isinstance(type_, EnumType) or type_.name == "string"
        if self.quoted and is_text:
            text = unquoted(text)
        found = references.read(text)
        if found is None:
            return text
        return _resolved(found) if self.resolve else Reference(found)

    def spelled(self, spelling: Spelling, type_: Type) -> Any:
        if isinstance(type_, BasicType | EnumType):
            return self.scalar(type_, spelling.key)
        if isinstance(type_, RecordType):
            text = self.properties.get(spelling.key)
            return None if text is None else self.row(spelling, type_, text)
        assert isinstance(type_, ListType)
        if spelling.separators:
            text = self.properties.get(spelling.key)
            return None if text is None else self.texts(type_, rows.read_parts(type_, text, spelling))
        if spelling.fields or "i" in Template(spelling.key).holes:
            return self.numbered(spelling, type_)
        return self.keyed(spelling, type_)

    def row(self, spelling: Spelling, record: RecordType, text: str) -> Any:
        found = rows.read_row(record, spelling.columns, text, spelling.separator)
        return text if found is None else self.texts(record, found)  # text is no record: refused

    def texts(self, type_: Type, read: Any) -> Any:
        """References in what was split."""
        if isinstance(type_, RecordType) and isinstance(read, dict):
            return {m.name: self.texts(m.type, read[m.name]) for m in type_.members if m.name in read}
        if isinstance(type_, ListType) and isinstance(read, list):
            return [self.texts(type_.element, part) for part in read]
        return self.text(type_, read) if isinstance(read, str) and isinstance(type_, BasicType | EnumType) else read

    def numbered(self, spelling: Spelling, type_: ListType) -> Any:
        """Rows by their numbers: as many as the count says, else until one is missing."""
        counted = self.properties.get(spelling.count) if spelling.count else None
        count = self.count(counted) if counted else None
        if counted and count is None:
            return counted  # no list: refused
        found: list[Any] = []
        while count is None or len(found) < count:
            row = self.numbered_row(spelling, type_, str(spelling.first + len(found)))
            if row is None and count is None:
                break
            found.append(_empty(type_.element) if row is None else row)
        return None if count is None and not found else found

    def numbered_row(self, spelling: Spelling, type_: ListType, number: str) -> Any:
        element = type_.element
        if spelling.fields:
            assert isinstance(element, RecordType)
            row = {}
            for name, key in spelling.fields:
                text = self.properties.get(Template(key).fill({"i": number}))
                member = element.member(name)
                if text is not None and member is not None:
                    row[name] = self.texts(member.type, text)
            return {**_emptiness(element), **row} if row else None
        text = self.properties.get(Template(spelling.key).fill({"i": number}))
        if text is None:
            return None
        return self.row(spelling, element, text) if isinstance(element, RecordType) else self.texts(element, text)

    def keyed(self, spelling: Spelling, type_: ListType) -> Any:
        """Rows whose key holds members: in the order of these, since properties have none."""
        element, template = type_.element, Template(spelling.key)
        assert isinstance(element, RecordType)
        pattern, found = template.pattern(), []
        for key, text in self.properties.items():
            if in_key := pattern.match(key):
                row = self.row(spelling, element, text)
                if isinstance(row, dict):
                    row |= dict(zip(template.holes, in_key.groups(), strict=True))
                found.append((tuple(map(_by_number, in_key.groups())), row))
        return [row for _, row in sorted(found, key=lambda pair: pair[0])] if found else None


def _resolved(reference: dict[str, str]) -> str | None:
    """What a reference stands for, here and now; None where nothing does."""
    if references.ENV in reference:
        return os.environ.get(reference[references.ENV])
    try:
        with open(os.path.expanduser(reference[references.FILE]), encoding="utf-8", newline="", opener=regular) as file:
            text = file.read()
    except (OSError, ValueError):
        return None
    return text.removesuffix("\n").removesuffix("\r") if text.endswith("\n") else text


def _is_digits(text: str) -> bool:
    return text.isascii() and text.isdigit()


def _by_number(text: str) -> tuple[bool, int, str]:
    """Numbers first, in their order, however long they are; then words."""
    if not _is_digits(text):
        return True, 0, text
    digits = text.lstrip("0")
    return False, len(digits), digits


def _empty(type_: Type) -> Any:
    """What is there, and has no property."""
    match type_:
        case BasicType(name="string"):
            return ""
        case ListType():
            return []
        case MapType():
            return {}
        case RecordType():
            return _emptiness(type_)
        case _:
            return None


def _emptiness(record: RecordType) -> dict[str, Any]:
    """The members of a record that read as empty where they have no property."""
    found = {member.name: _empty(member.type) for member in record.members if _reads_as_empty(member)}
    return {name: value for name, value in found.items() if value is not None}


def _reads_as_empty(member: Member) -> bool:
    return member.default is None and not member.optional
