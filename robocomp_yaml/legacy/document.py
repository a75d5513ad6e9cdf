"""YAML documents to write: a tree of entries with comments, and its text.

Short mappings and lists are written on one line, in flow style; longer ones, and those with comments, in block style.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from collections.abc import Mapping as Mapping_
from functools import lru_cache
from typing import Any, cast

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.tree import Mapping, Node, Scalar, mapping_at, scalar_at, sequence_at, text_at
from robocomp_yaml.source.yaml_text import escaped, is_printable, text_of

WIDTH = 120
_NO_LOCATION = Span("")
GAP = None  # an empty line between comments; several are written as one
Line = str | None


class Notes(msgspec.Struct):
    """Comments of an entry, without '#': the lines above it ('' is an empty line), at its end, and below its content.
    `doc` are the lines of its doc comments."""

    head: list[str] = []
    tail: list[str] = []
    foot: list[str] = []
    doc: list[str] = []

    def __bool__(self) -> bool:
        return bool(self.head or self.tail or self.foot)

    def add(self, other: Notes) -> None:
        """Append the comments of another entry to the lines above this one."""
        self.head += [*other.head, *other.tail, *other.foot]


class Raw(msgspec.Struct, frozen=True):
    """A number or boolean as it is spelled."""

    lexeme: str


TRUE = Raw("true")


class ReferredName(msgspec.Struct):
    """A reference to a type. Its text is replaced when the reference is resolved."""

    text: str


class Doc(msgspec.Struct, frozen=True):
    """Documentation. It may be folded, because readers strip it."""

    text: str


class Map(msgspec.Struct):
    """`block`: never on one line. `limit`: the longest line, with the key, in characters."""

    entries: list[DocumentEntry] = []
    block: bool = False
    limit: int = WIDTH

    @classmethod
    def of(cls, values: Mapping_[str, Value], *, block: bool = False) -> Map:
        return cls([DocumentEntry(key, value) for key, value in values.items()], block)

    def put(self, key: str, value: Value, notes: Notes | None = None) -> DocumentEntry:
        entry = DocumentEntry(key, value, notes or Notes())
        self.entries.append(entry)
        return entry

    def get(self, key: str) -> Value:
        """Return the value of a key; None where the key is missing."""
        return next((entry.value for entry in self.entries if entry.key == key), None)

    def put_some(self, key: str, value: Value, notes: Notes | None = None) -> None:
        """As `put`, unless the value is empty: None, an empty text, a mapping or list without entries."""
        if value.entries if isinstance(value, Map) else value.items if isinstance(value, List) else value:
            self.put(key, value, notes)


class List(msgspec.Struct):
    items: list[DocumentEntry] = []
    block: bool = False

    @classmethod
    def of(cls, values: Iterable[Value]) -> List:
        return cls([DocumentEntry("", value) for value in values])

    def put(self, value: Value, notes: Notes | None = None) -> DocumentEntry:
        entry = DocumentEntry("", value, notes or Notes())
        self.items.append(entry)
        return entry


Value = str | Raw | ReferredName | Doc | Map | List | None


class DocumentEntry(msgspec.Struct):
    key: str
    value: Value
    notes: Notes = msgspec.field(default_factory=Notes)


def tree(document: Map) -> Mapping:
    """Return the tree that parsing the document's text would return, without locations."""
    entries = {entry.key: (_scalar(entry.key), _node(entry.value)) for entry in document.entries}
    return mapping_at(_NO_LOCATION, entries)


def data(document: Map) -> dict[str, Any]:
    """Return the document as plain data."""
    return cast("dict[str, Any]", tree(document).data)


def _node(value: Value) -> Node:
    if isinstance(value, (str, ReferredName, Doc)):
        return _scalar(_string(value))
    if isinstance(value, Map):
        return tree(value)
    if isinstance(value, List):
        return sequence_at(_NO_LOCATION, [_node(item.value) for item in value.items])
    return scalar_at(_NO_LOCATION, value.lexeme if value else "")


def _string(value: str | ReferredName | Doc) -> str:
    return value if isinstance(value, str) else value.text


@lru_cache(1024)  # most words of a document are repeated
def _scalar(text: str) -> Scalar:
    return text_at(_NO_LOCATION, text)


def text(document: Map, around: Notes) -> str:
    """Return the document's text; `around` are the comments above and below the document."""
    lines = [*_comments(around.head, ""), *_map(document, ""), *_comments(around.foot, "")]
    kept = [line for line, before in zip(lines, [GAP, *lines], strict=False) if line is not GAP or before is not GAP]
    return "\n".join(line or "" for line in kept).rstrip("\n") + "\n"


def _map(node: Map, indent: str) -> Iterator[Line]:
    for entry in node.entries:
        yield from _head(entry, entry is node.entries[0], indent)
        yield from _entry(entry, indent, f"{indent}{text_of(entry.key)}:")


def _list(node: List, indent: str) -> Iterator[Line]:
    for item in node.items:
        yield from _head(item, item is node.items[0], indent)
        start = f"{indent}-"
        body = item.value
        if isinstance(body, Map) and body.entries and _line(body, start) is None and not body.entries[0].notes.head:
            first, *rest = _map(body, indent + "  ")
            tail = "".join(f"  # {escaped(line)[0]}" for line in item.notes.tail)
            yield f"{start} {(first or '').lstrip()}{tail}"
            yield from rest
            yield from _comments(item.notes.foot, indent + "  ")
        else:
            yield from _entry(item, indent, start)


def _entry(entry: DocumentEntry, indent: str, start: str) -> Iterator[Line]:
    tail = "  # " + escaped(" # ".join(entry.notes.tail))[0] if entry.notes.tail else ""
    line = _line(entry.value, start)
    inner = indent + "  "
    if line is not None:
        yield line + tail
    elif isinstance(entry.value, Doc):
        header, body = _block_text(entry.value.text, inner)
        yield f"{start} {header}{tail}"
        yield from body
    elif isinstance(entry.value, (Map, List)):
        yield start + tail
        yield from _map(entry.value, inner) if isinstance(entry.value, Map) else _list(entry.value, inner)
    yield from _comments(entry.notes.foot, inner)


def _line(value: Value, start: str) -> str | None:
    """Return an entry on one line; None where it needs several."""
    if value is None:
        return start
    if isinstance(value, (Map, List)):
        line = _flow(value)
        limit = value.limit if isinstance(value, Map) else WIDTH
        empty = line in ("{}", "[]")
        return f"{start} {line}" if line is not None and (empty or len(start) + 1 + len(line) <= limit) else None
    if isinstance(value, Raw):
        return f"{start} {value.lexeme}"
    string = _string(value)
    line = f"{start} {text_of(string)}"
    as_block = isinstance(value, Doc) and ("\n" in string or (len(line) > WIDTH and " " in string))
    return None if as_block and is_printable(string) and not string[:1].isspace() else line


def _flow(value: Value) -> str | None:
    """Return a value in flow style; None where it cannot be written so."""
    if value is None:
        return "null"
    if isinstance(value, Raw):
        return value.lexeme
    if isinstance(value, (str, ReferredName, Doc)):
        string = _string(value)
        return None if isinstance(value, Doc) and "\n" in string else text_of(string, in_flow=True)
    entries = value.entries if isinstance(value, Map) else value.items
    if entries and (value.block or any(entry.notes for entry in entries)):
        return None
    parts: list[str] = []
    for entry in entries:
        inner = _flow(entry.value)
        if inner is None:
            return None
        parts.append(f"{text_of(entry.key, in_flow=True)}: {inner}" if isinstance(value, Map) else inner)
    return "{" + ", ".join(parts) + "}" if isinstance(value, Map) else "[" + ", ".join(parts) + "]"


def _block_text(value: str, indent: str) -> tuple[str, list[str]]:
    """Return a text as a block scalar: literal (`|`), or one long line folded (`>`)."""
    if "\n" in value or "  " in value or "\t" in value:
        return "|", [(indent + line).rstrip() for line in value.split("\n")]
    width = max(WIDTH - len(indent), 40)
    return ">", textwrap.wrap(
        value,
        width + len(indent),
        initial_indent=indent,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _head(entry: DocumentEntry, first: bool, indent: str) -> Iterator[Line]:
    """Yield the comments above an entry, without empty lines above the first entry of a block."""
    lines = entry.notes.head
    start = next((at for at, line in enumerate(lines) if line), 0) if first and indent else 0
    yield from _comments(lines[start:], indent)


def _comments(lines: list[str], indent: str) -> Iterator[Line]:
    for line in lines:
        yield f"{indent}# {escaped(line)[0]}".rstrip() if line else GAP
