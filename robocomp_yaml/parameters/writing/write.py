"""Effective values as properties: by their paths, or as `legacy:` spells them.

A value that no property can hold is reported at its location. Rows are read back to verify them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import msgspec

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.defaults import with_defaults
from robocomp_yaml.parameters.hidden import holds_secret
from robocomp_yaml.parameters.layers.merge import MergedValue, Origin, node_of, span_of, step
from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling
from robocomp_yaml.parameters.spelling import references, rows
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    Parameters,
    RecordType,
    ResolvedMember,
    Type,
    is_secret,
    is_text,
)
from robocomp_yaml.parameters.writing.sections import Property
from robocomp_yaml.semantics import spellings
from robocomp_yaml.semantics.paths import Path, Step, escaped, in_words
from robocomp_yaml.semantics.references import FILE, is_reference
from robocomp_yaml.semantics.references import read as reference_of
from robocomp_yaml.semantics.rows import joined
from robocomp_yaml.semantics.texts import spelled, unquoted
from robocomp_yaml.source.properties import unwritable
from robocomp_yaml.source.tree import Scalar

_EMPTY_OPTIONAL = "an empty optional value would be read as a missing one"


class _Position(msgspec.Struct, frozen=True):
    """The origin of a value, and its path."""

    where: Origin
    path: Path = ()

    def child(self, name: Step, otherwise: Origin = None) -> _Position:
        """The position one step below. `otherwise` is the origin of a value that no document sets."""
        inner = step(self.where, name)
        return _Position(inner if inner is not None else otherwise, (*self.path, name))

    def member(self, member: ResolvedMember) -> _Position:
        return self.child(member.name, member.default.node if member.default else None)


class Writer(msgspec.Struct):
    """Writes parameters. `only_set`: defaults are omitted. `quote`: text is in double quotes, as in flat TOML.
    `unquotes`: readers of the file remove such quotes. `head` is the location of faults without a location of their
    own. `folder` is the folder of the file; None if it is unknown."""

    parameters: Parameters
    head: Span
    only_set: bool = False
    quote: bool = False
    unquotes: bool = False
    folder: str | None = None
    faults: list[Diagnostic] = []

    def write(self, data: dict[str, Any], merged: MergedValue | None) -> list[Property]:
        return list(self.record(self.parameters.root, data, _Position(merged), "", is_top=True))

    def record(
        self, type_: RecordType, data: dict[str, Any], at: _Position, key: str, *, is_top: bool
    ) -> Iterator[Property]:
        """`is_top`: the record is the root or a group, so that `legacy:` may spell its members."""
        for member in type_.members:
            own = at.child(member.name)
            if member.name not in data or (is_top and self.only_set and own.where is None):
                continue
            value, stem = data[member.name], f"{key}.{member.name}" if key else member.name
            if member.is_group and isinstance(member.type, RecordType):
                yield from self.record(member.type, value, own, stem, is_top=is_top)
                continue
            inner, spelling = at.member(member), self.parameters.spelling(stem) if is_top else None
            if spelling is None:
                written = self.value(member.type, value, inner, stem)
            else:
                written = self.spelled(spelling, member.type, value, inner)
            yield from self.checked_member(member, value, inner, written)

    def checked_member(
        self, member: ResolvedMember, value: Any, at: _Position, written: Iterator[Property]
    ) -> Iterator[Property]:
        """The properties of a member. An empty value has none: a fault if a missing one means another value."""
        before, made = len(self.faults), list(written)
        yield from made
        is_empty = value in ([], {}) or (value == "" and not self.quote) or not made
        if before < len(self.faults) or not is_empty:
            return
        if member.optional:
            self.fault(at, _EMPTY_OPTIONAL)
        elif member.default is not None and not _is_default(member, value):
            self.fault(at, "it is empty, but its default is not")

    def value(self, type_: Type, data: Any, at: _Position, key: str) -> Iterator[Property]:
        match type_:
            case BasicType() | EnumType():
                yield from self.scalar(type_, data, at, key)
            case ListType(element=element):
                yield Property(f"{key}.size", str(len(data)), span_of(at.where))
                for index, item in enumerate(data):
                    yield from self.value(element, item, at.child(index), f"{key}.{index}")
            case MapType(element=element):
                if data:
                    yield Property(f"{key}.keys", " ".join(escaped(name) for name in data), span_of(at.where))
                for name, item in data.items():
                    yield from self.value(element, item, at.child(name), f"{key}.{escaped(name)}")
            case _:
                yield from self.record(type_, data, at, key, is_top=False)

    def scalar(self, type_: Type, data: Any, at: _Position, key: str) -> Iterator[Property]:
        text = self.text(type_, data, at)
        if text is None or (text == "" and not self.quote):
            return
        read: Callable[[str], Any] | None = None if is_text(type_) else lambda other: rows.typed(type_, other)
        if self.quote and is_text(type_) and '"' not in text:
            text, read = f'"{text}"', unquoted
        yield from self.checked(key, text, at, read, is_secret(type_) and not is_reference(data))

    def checked(
        self, key: str, text: str, at: _Position, read: Callable[[str], Any] | None, secret: bool
    ) -> Iterator[Property]:
        if problem := unwritable(key, text):
            self.fault(at, problem.replace("a property's value", "it").replace("a property", "it"))
        else:
            yield Property(key, text, span_of(at.where), read, secret)

    def text(self, type_: Type, data: Any, at: _Position) -> str | None:
        """The text of a plain value; None, with a fault, if there is none."""
        node = node_of(at.where)
        if isinstance(data, dict):
            return references.text(data, node, self.folder)
        if isinstance(data, str):
            if problem := self.misread(data):
                self.fault(at, problem)
                return None
            return data
        if isinstance(type_, BasicType) and type_.is_integer:
            return str(int(data))
        if isinstance(node, Scalar) and node.data == data and not node.lexeme.startswith(("0x", "0o")):
            return node.lexeme
        return spelled(data)

    def misread(self, text: str) -> str:
        """Why a property cannot hold a text, or ''."""
        if "\0" in text:
            return "it contains a NUL"
        if any(char in text for char in "\r\n"):
            return "it contains a line end"
        if reference := reference_of(text):
            return f"it would be read as a reference to {'a file' if FILE in reference else 'the environment'}"
        is_unquoted = (self.quote or self.unquotes) and unquoted(text) != text
        return "its quotes would be removed when it is read" if is_unquoted else ""

    def spelled(self, spelling: LegacySpelling, type_: Type, data: Any, at: _Position) -> Iterator[Property]:
        if isinstance(type_, (BasicType, EnumType)):
            yield from self.scalar(type_, data, at, spelling.key)
        elif isinstance(type_, RecordType):
            yield from self.row(spelling, spelling.key, type_, data, at)
        elif spelling.separators:
            yield from self.separated(spelling, type_, data, at)
        else:
            yield from self.rows(spelling, type_.element, data, at)
            if spelling.count:
                yield Property(spelling.count, str(len(data)), span_of(at.where))

    def rows(self, spelling: LegacySpelling, element: Type, data: Any, at: _Position) -> Iterator[Property]:
        keys = set()
        for index, item in enumerate(data):
            inner, number, before = at.child(index), str(index + spelling.first), len(self.faults)
            written = list(self.numbered_row(spelling, element, item, inner, number))
            if not written and not spelling.count and before == len(self.faults):
                self.fault(inner, "its row would be empty")
            for made in written:
                if made.key in keys:
                    self.fault(inner, f"another row already uses the property {made.key}")
                keys.add(made.key)
                yield made

    def numbered_row(
        self, spelling: LegacySpelling, element: Type, item: Any, at: _Position, number: str
    ) -> Iterator[Property]:
        if not isinstance(element, RecordType):
            yield from self.scalar(element, item, at, spellings.filled(spelling.key, {"i": number}))
        elif spelling.fields:
            yield from self.fields(spelling, element, item, at, number)
        elif key := self.row_key(spelling, element, item, at, number):
            yield from self.row(spelling, key, element, item, at)

    def row_key(
        self, spelling: LegacySpelling, record: RecordType, item: Any, at: _Position, number: str
    ) -> str | None:
        names, found = spellings.placeholders(spelling.key), {"i": number}
        for name in names:
            member = record.member(name)
            if member is not None:
                where = _Position(step(at.where, name), at.path)
                found[name] = self.text(member.type, item.get(name, ""), where) or ""
        key = spellings.filled(spelling.key, found)
        read = spellings.pattern(spelling.key).match(key)
        if read is None or read.groups() != tuple(found[name] for name in names):
            self.fault(at, f"its key, {key}, would be read differently")
            return None
        return key

    def row(
        self, spelling: LegacySpelling, key: str, record: RecordType, item: Any, at: _Position
    ) -> Iterator[Property]:
        texts = self.columns(spelling, record, item, at)
        if texts is None:
            return
        filled, members = list(texts.values()), record.by_name
        while filled and not filled[-1] and members[spelling.columns[len(filled) - 1]].optional:
            del filled[-1]  # optional columns at the end of a row may be missing
        text = spelling.separator.join(filled)
        read = rows.read_row(record, spelling.columns, text, spelling.separator)
        if read is None or any(
            read.get(name, "") != column or (name not in read and members[name].default is not None)
            for name, column in texts.items()
        ):
            shown = "" if holds_secret(record) else f", '{text}',"
            self.fault(at, f"its row{shown} would be read differently")
        elif text:
            yield from self.checked(
                key, text, at,
                lambda other: rows.typed(record, rows.read_row(record, spelling.columns, other, spelling.separator)),
                holds_secret(record),
            )  # fmt: skip

    def columns(self, spelling: LegacySpelling, record: RecordType, item: Any, at: _Position) -> dict[str, str] | None:
        """The texts of a row by column; None, with a fault, if one has none."""
        members = {member.name: member for member in record.members if member.name in item}
        named = {*spelling.columns, *spellings.placeholders(spelling.key)}
        for name, member in members.items():
            if name not in named and not _is_default(member, item[name]):
                self.fault(at.child(name, at.where), "its rows have no column for it")
                return None
        texts = dict.fromkeys(spelling.columns, "")
        for name in texts:
            if name in members:
                text = self.text(members[name].type, item[name], at.member(members[name]))
                if text == "" and members[name].optional:
                    self.fault(at.child(name), _EMPTY_OPTIONAL)
                    return None
                if text is None:
                    return None
                texts[name] = text
        return texts

    def fields(
        self, spelling: LegacySpelling, record: RecordType, item: Any, at: _Position, number: str
    ) -> Iterator[Property]:
        keys = dict(spelling.fields)
        for member in record.members:
            if member.name not in item:
                continue
            value, inner = item[member.name], at.member(member)
            if member.name in keys:
                key = spellings.filled(keys[member.name], {"i": number})
                yield from self.checked_member(member, value, inner, self.scalar(member.type, value, inner, key))
            elif not _is_default(member, value):
                self.fault(_Position(inner.where or at.where, inner.path), "its rows have no property for it")

    def separated(self, spelling: LegacySpelling, type_: Type, data: Any, at: _Position) -> Iterator[Property]:
        parts = self.texts(spelling, type_, data, at)
        if parts is None:
            return
        text = joined(parts, spelling.separators, spelling.trailing)
        if rows.read_parts(type_, text, spelling) != rows.as_read(type_, parts, spelling):
            shown = "it" if holds_secret(type_) else f"'{text}'"
            self.fault(at, f"its separators cannot spell {shown}")
        elif text:
            yield from self.checked(
                spelling.key, text, at,
                lambda other: rows.typed(type_, rows.read_parts(type_, other, spelling)), holds_secret(type_),
            )  # fmt: skip

    def texts(self, spelling: LegacySpelling, type_: Type, data: Any, at: _Position) -> Any:
        """Nested lists of texts, where a record is the list of its columns; None, with a fault, if a value has no
        text."""
        if isinstance(type_, RecordType):
            row = self.columns(spelling, type_, data, at)
            return None if row is None else list(row.values())
        if not isinstance(type_, ListType):
            return self.text(type_, data, at)
        parts = [self.texts(spelling, type_.element, item, at.child(index)) for index, item in enumerate(data)]
        return None if any(part is None for part in parts) else parts

    def fault(self, at: _Position, problem: str) -> None:
        span = span_of(at.where) or self.head
        self.faults.append(codes.NOT_FOR_ICE.at(span, path=in_words(at.path), problem=problem))


def _is_default(member: ResolvedMember, value: Any) -> bool:
    return member.default is not None and with_defaults(member.type, member.default.data) == value
