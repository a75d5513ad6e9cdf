"""Effective values as properties: by their paths, or as the legacy table spells them.

What no property can say is a fault at its line. Rows are read back before they are believed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.defaults import with_defaults
from robocomp_yaml.parameters.hidden import holds_secret
from robocomp_yaml.parameters.layers.merge import Place, child
from robocomp_yaml.parameters.specification.document import Spelling
from robocomp_yaml.parameters.spelling import references, rows
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
from robocomp_yaml.secrets import HIDDEN
from robocomp_yaml.semantics import spellings
from robocomp_yaml.semantics.paths import Step, escaped, in_words
from robocomp_yaml.semantics.references import FILE, is_reference
from robocomp_yaml.semantics.references import read as reference_of
from robocomp_yaml.semantics.rows import joined
from robocomp_yaml.semantics.texts import spelled, unquoted
from robocomp_yaml.source.properties import unwritable
from robocomp_yaml.source.tree import Node, Scalar

Where = Place | Node | None
Path = tuple[Step, ...]
_EMPTY_OPTIONAL = "an optional one that is empty cannot be told from one that is left out"


class Property(msgspec.Struct, frozen=True):
    """One line of a property file. `read` gives what a text in its place would mean (None for texts that mean just
    themselves), so that another spelling of the same value can stand there. `secret`: its value is not to be shown."""

    key: str
    value: str
    span: Span | None = None
    read: Callable[[str], Any] | None = None
    secret: bool = False

    def hidden(self) -> Property:
        """The line as it may be shown."""
        return replace(self, value=HIDDEN if self.secret else secrets.value(self.key, self.value))


class Writer(msgspec.Struct):
    """Writes the parameters. `only_given`: defaults are left out. `quote`: text stands in double quotes, as in flat
    TOML. `unquotes`: whoever reads the file takes such quotes away. `head` is where faults are shown that have no line
    of their own; `folder` is that of the file to be, None where it may be put anywhere."""

    parameters: Parameters
    head: Span
    only_given: bool = False
    quote: bool = False
    unquotes: bool = False
    folder: str | None = None
    faults: list[Diagnostic] = []

    def write(self, data: dict[str, Any], place: Place | None) -> list[Property]:
        return list(self.record(self.parameters.root, data, place, (), "", "", top=True))

    def record(
        self, type_: RecordType, data: dict[str, Any], where: Where, path: Path, key: str, dotted: str, *, top: bool
    ) -> Iterator[Property]:
        """`dotted` is the path in the legacy table, as long as `top` holds: in groups."""
        for member in type_.members:
            if member.name not in data:
                continue
            given = step(where, member.name)
            is_group = member.is_group and isinstance(member.type, RecordType)
            if self.only_given and given is None and top:
                continue
            here = given if given is not None else member.default.node if member.default else None
            inner = (*path, member.name)
            stem = f"{key}.{member.name}" if key else member.name
            name = f"{dotted}.{member.name}" if dotted else member.name
            if is_group:
                assert isinstance(member.type, RecordType)
                yield from self.record(member.type, data[member.name], given, inner, stem, name, top=top)
                continue
            spelling, told = self.parameters.spelling(name) if top else None, len(self.faults)
            if spelling is None:
                written = list(self.value(member.type, data[member.name], here, inner, stem))
            else:
                written = list(self.spelled(spelling, member.type, data[member.name], here, inner))
            yield from written
            if told == len(self.faults):
                self.check_empty(member, data[member.name], bool(written), here, inner)

    def check_empty(self, member: Member, value: Any, is_written: bool, where: Where, path: Path) -> None:
        """What is empty has no property (or, as a list, must not count on one), and reads as if it were not given."""
        empty = value in ([], {}) or (value == "" and not self.quote) or not is_written
        if not empty:
            return
        if member.optional:
            self.fault(where, path, _EMPTY_OPTIONAL)
        elif member.default is not None and with_defaults(member.type, member.default.data) != value:
            self.fault(where, path, "it is empty, and its default is not")

    def value(self, type_: Type, data: Any, where: Where, path: Path, key: str) -> Iterator[Property]:
        match type_:
            case BasicType() | EnumType():
                yield from self.scalar(type_, data, where, path, key)
            case ListType(element=element):
                yield self.own(f"{key}.size", str(len(data)), where)
                for index, item in enumerate(data):
                    yield from self.value(element, item, step(where, index), (*path, index), f"{key}.{index}")
            case MapType(element=element):
                if data:
                    yield self.own(f"{key}.keys", " ".join(escaped(name) for name in data), where)
                for name, item in data.items():
                    yield from self.value(element, item, step(where, name), (*path, name), f"{key}.{escaped(name)}")
            case _:
                yield from self.record(type_, data, where, path, key, "", top=False)

    def own(self, key: str, value: str, where: Where) -> Property:
        return Property(key, value, span_of(where))

    def scalar(self, type_: ScalarType, data: Any, where: Where, path: Path, key: str) -> Iterator[Property]:
        text = self.text(type_, data, where, path)
        if text is None or (text == "" and not self.quote):
            return
        is_text = isinstance(type_, EnumType) or type_.name == "string"
        read: Callable[[str], Any] | None = None if is_text else lambda other: rows.plain(type_, other)
        if self.quote and is_text and '"' not in text:
            text, read = f'"{text}"', unquoted
        is_secret = type_.secret and not is_reference(data)
        yield from self.checked(Property(key, text, span_of(where), read, is_secret), where, path)

    def checked(self, made: Property, where: Where, path: Path) -> Iterator[Property]:
        if problem := unwritable(made.key, made.value):
            self.fault(where, path, problem.replace("a property's value", "it").replace("a property", "it"))
        else:
            yield made

    def text(self, type_: ScalarType, data: Any, where: Where, path: Path) -> str | None:
        """The text of a plain value; None where none can be."""
        if isinstance(data, dict):
            return references.text(data, node_of(where), self.folder)
        if isinstance(data, str):
            if any(char in data for char in "\r\n\0"):
                self.fault(where, path, "it holds a line end")
                return None
            if reference := reference_of(data):
                what = "a file" if FILE in reference else "the environment"
                self.fault(where, path, f"it would be read as a reference to {what}")
                return None
            if (self.quote or self.unquotes) and unquoted(data) != data:
                self.fault(where, path, "in quotes, it would be read without them")
                return None
            return data
        if isinstance(type_, BasicType) and type_.is_integer:
            return str(int(data))
        node = node_of(where)
        if isinstance(node, Scalar) and node.data == data and not node.lexeme.startswith(("0x", "0o")):
            return node.lexeme
        return spelled(data)

    def spelled(self, spelling: Spelling, type_: Type, data: Any, where: Where, path: Path) -> Iterator[Property]:
        if isinstance(type_, BasicType | EnumType):
            yield from self.scalar(type_, data, where, path, spelling.key)
        elif isinstance(type_, RecordType):
            yield from self.row(spelling, spelling.key, type_, data, where, path)
        elif spelling.separators:
            yield from self.separated(spelling, type_, data, where, path)
        else:
            assert isinstance(type_, ListType)
            yield from self.rows(spelling, type_, data, where, path)
            if spelling.count:
                yield self.own(spelling.count, str(len(data)), where)

    def rows(self, spelling: Spelling, type_: ListType, data: Any, where: Where, path: Path) -> Iterator[Property]:
        element, keys = type_.element, set()
        for index, item in enumerate(data):
            here, inner, number = step(where, index), (*path, index), str(index + spelling.first)
            told = len(self.faults)
            if spelling.fields:
                assert isinstance(element, RecordType)
                written = list(self.fields(spelling, element, item, here, inner, number))
            elif isinstance(element, RecordType):
                key = self.row_key(spelling, element, item, here, inner, number)
                written = list(self.row(spelling, key, element, item, here, inner)) if key else []
            else:
                assert isinstance(element, BasicType | EnumType)
                key = spellings.filled(spelling.key, {"i": number})
                written = list(self.scalar(element, item, here, inner, key))
            if not written and not spelling.count and told == len(self.faults):
                self.fault(here, inner, "its row would be empty")
            for made in written:
                if made.key in keys:
                    self.fault(here, inner, f"another row is the property {made.key} already")
                keys.add(made.key)
                yield made

    def row_key(
        self, spelling: Spelling, record: RecordType, item: Any, where: Where, path: Path, number: str
    ) -> str | None:
        holes, found = spellings.holes(spelling.key), {"i": number}
        for hole in holes:
            member = record.member(hole)
            if member is not None:
                assert isinstance(member.type, BasicType | EnumType)
                found[hole] = self.text(member.type, item.get(hole, ""), step(where, hole), path) or ""
        key = spellings.filled(spelling.key, found)
        read = spellings.pattern(spelling.key).match(key)
        if read is None or read.groups() != tuple(found[hole] for hole in holes):
            self.fault(where, path, f"its key, {key}, would be read differently")
            return None
        return key

    def row(
        self, spelling: Spelling, key: str, record: RecordType, item: Any, where: Where, path: Path
    ) -> Iterator[Property]:
        texts = self.columns(spelling, record, item, where, path)
        if texts is None:
            return
        filled = list(texts.values())
        while filled and not filled[-1] and rows.is_optional(record, spelling.columns[len(filled) - 1]):
            del filled[-1]  # what is optional at the end of a row may be left out
        text = spelling.separator.join(filled)
        if not self.reads_back(rows.read_row(record, spelling.columns, text, spelling.separator), texts, record):
            said = "" if holds_secret(record) else f", '{text}',"
            self.fault(where, path, f"its row{said} would be read differently")
            return
        if text:
            yield from self.checked(
                Property(
                    key,
                    text,
                    span_of(where),
                    lambda other: self.meaning(
                        record, rows.read_row(record, spelling.columns, other, spelling.separator)
                    ),
                    holds_secret(record),
                ),
                where,
                path,
            )

    def columns(
        self, spelling: Spelling, record: RecordType, item: Any, where: Where, path: Path
    ) -> dict[str, str] | None:
        """The texts of a row by column; None where one cannot be."""
        said = {*spelling.columns, *spellings.holes(spelling.key)}
        for member in record.members:
            if member.name in item and member.name not in said:
                default = member.default
                if default is None or with_defaults(member.type, default.data) != item[member.name]:
                    here = step(where, member.name) or where
                    self.fault(here, (*path, member.name), "its rows have no column for it")
                    return None
        texts: dict[str, str] = {}
        for name, type_ in rows.columns(record, spelling.columns):
            text = self.text(type_, item[name], self.here(record, where, name), (*path, name)) if name in item else ""
            if text is None:
                return None
            column = record.member(name)
            if name in item and text == "" and column is not None and column.optional:
                self.fault(step(where, name), (*path, name), _EMPTY_OPTIONAL)
                return None
            texts[name] = text
        return texts

    def here(self, record: RecordType, where: Where, name: str) -> Where:
        given, member = step(where, name), record.member(name)
        return given if given is not None or member is None or member.default is None else member.default.node

    def reads_back(self, read: dict[str, Any] | None, texts: dict[str, str], record: RecordType) -> bool:
        if read is None:
            return False
        return all(read.get(name, "") == text for name, text in texts.items()) and not any(
            name not in read and (member := record.member(name)) is not None and member.default is not None
            for name in texts
        )

    def meaning(self, record: RecordType, read: dict[str, Any] | None) -> Any:
        if read is None:
            raise ValueError("the columns do not add up")
        types = {member.name: member.type for member in record.members}
        return {name: self.typed(types[name], text) for name, text in read.items()}

    def fields(
        self, spelling: Spelling, record: RecordType, item: Any, where: Where, path: Path, number: str
    ) -> Iterator[Property]:
        keys = dict(spelling.fields)
        for member in record.members:
            if member.name not in item:
                continue
            value, here = item[member.name], self.here(record, where, member.name)
            inner = (*path, member.name)
            if member.name not in keys:
                default = member.default
                if default is None or with_defaults(member.type, default.data) != value:
                    self.fault(here or where, inner, "its rows have no property for it")
                continue
            assert isinstance(member.type, BasicType | EnumType)
            key, told = spellings.filled(keys[member.name], {"i": number}), len(self.faults)
            written = list(self.scalar(member.type, value, here, inner, key))
            yield from written
            if told == len(self.faults):
                self.check_empty(member, value, bool(written), here, inner)

    def separated(self, spelling: Spelling, type_: Type, data: Any, where: Where, path: Path) -> Iterator[Property]:
        parts = self.texts(spelling, type_, data, where, path)
        if parts is None:
            return
        text = joined(parts, spelling.separators, spelling.trailing)
        if rows.read_parts(type_, text, spelling) != self.as_read(spelling, type_, parts):
            said = "it" if holds_secret(type_) else f"'{text}'"
            self.fault(where, path, f"its separators cannot say {said}")
        elif text:
            yield from self.checked(
                Property(
                    spelling.key,
                    text,
                    span_of(where),
                    lambda other: self.typed(type_, rows.read_parts(type_, other, spelling)),
                    holds_secret(type_),
                ),
                where,
                path,
            )

    def texts(self, spelling: Spelling, type_: Type, data: Any, where: Where, path: Path) -> Any:
        """Nested lists of texts, a record as the list of its columns; None where one cannot be."""
        if isinstance(type_, RecordType):
            row = self.columns(spelling, type_, data, where, path)
            return None if row is None else list(row.values())
        if not isinstance(type_, ListType):
            assert isinstance(type_, BasicType | EnumType)
            return self.text(type_, data, where, path)
        parts = [
            self.texts(spelling, type_.element, item, step(where, index), (*path, index))
            for index, item in enumerate(data)
        ]
        return None if any(part is None for part in parts) else parts

    def as_read(self, spelling: Spelling, type_: Type, texts: Any) -> Any:
        if isinstance(type_, RecordType):
            read = dict(zip(spelling.columns, texts, strict=True))
            return {name: text for name, text in read.items() if text or rows.keeps_empty(type_, name)}
        if isinstance(type_, ListType):
            return [self.as_read(spelling, type_.element, part) for part in texts]
        return texts

    def typed(self, type_: Type, read: Any) -> Any:
        if isinstance(type_, RecordType):
            return self.meaning(type_, read)
        if isinstance(type_, ListType):
            return [self.typed(type_.element, part) for part in read]
        assert isinstance(type_, BasicType | EnumType)
        return rows.plain(type_, read)

    def fault(self, where: Where, path: Path, problem: str) -> None:
        self.faults.append(codes.NOT_FOR_ICE.at(span_of(where) or self.head, path=in_words(path), problem=problem))


def step(where: Where, name: Step) -> Where:
    """One step further down: the merged entry, or the node."""
    if isinstance(where, Place):
        if where.entries is not None:
            return where.entries.get(name) if isinstance(name, str) else None
        where = where.node
    found = child(where, name)
    return None if found is None or found[1].data is None else found[1]


def node_of(where: Where) -> Node | None:
    return where.node if isinstance(where, Place) else where


def span_of(where: Where) -> Span | None:
    """A value's place; its key's where it fills many lines."""
    node = node_of(where)
    if node is None:
        return None
    span = node.span
    key = where.key if isinstance(where, Place) else None
    return key.span if key is not None and span.line != span.end_line else span
