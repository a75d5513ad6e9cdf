"""YAML documents to be written: a tree of entries with their comments, and its text.

Short mappings and lists stand on one line, in flow style; what is longer, or holds comments, stands in block style.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, cast

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.tree import Mapping, Node, Scalar, mapping_at, scalar_at, sequence_at, text_at
from robocomp_yaml.source.yaml_text import escaped, is_printable, text_of

WIDTH = 120
_NOWHERE = Span("")
GAP = None  # an empty line between comments; several are one
Line = str | None


class Notes(msgspec.Struct):
    """Comments of an entry, without '#': lines above it ('' is an empty line), at its end, and below all it holds.
    `doc` are the lines of its doc comments."""

    head: list[str] = []
    tail: list[str] = []
    foot: list[str] = []
    doc: list[str] = []

    def __bool__(self) -> bool:
        return bool(self.head or self.tail or self.foot)

    def add(self, other: Notes) -> None:
        """Takes over another entry's comments, which now stand above this one's."""
        self.head += [*other.head, *other.tail, *other.foot]


class Raw(msgspec.Struct, frozen=True):
    """A scalar as it is spelled: a number, a boolean."""

    lexeme: str


TRUE = Raw("true")


class ReferredName(msgspec.Struct):
    """The name of something, which may turn out to be spelled in another way."""

    text: str


class Doc(msgspec.Struct, frozen=True):
    """A text for people: if it is long it may be folded, and what reads it strips it."""

    text: str


class Map(msgspec.Struct):
    """`block`: never on one line. `limit`: the longest line that it may stand on, with its key."""

    entries: list[DocumentEntry] = []
    block: bool = False
    limit: int = WIDTH

    def put(self, key: str, value: Value, notes: Notes | None = None) -> DocumentEntry:
        entry = DocumentEntry(key, value, notes or Notes())
        self.entries.append(entry)
        return entry

    def get(self, key: str) -> Value:
        """The value of a key; None where it is missing."""
        return next((entry.value for entry in self.entries if entry.key == key), None)

    def put_some(self, key: str, value: Value, notes: Notes | None = None) -> None:
        """As `put`, but for what says nothing: None, an empty text, what has no entries."""
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
    """What reading the document's text would give, for what needs no places in it."""
    entries = {entry.key: (_scalar(entry.key), _node(entry.value)) for entry in document.entries}
    return mapping_at(_NOWHERE, entries)


def data(document: Map) -> dict[str, Any]:
    """The same as plain data."""
    return cast("dict[str, Any]", tree(document).data)


def _node(value: Value) -> Node:
    if isinstance(value, str | ReferredName | Doc):
        return _scalar(_string(value))
    if isinstance(value, Map):
        return tree(value)
    if isinstance(value, List):
        return sequence_at(_NOWHERE, [_node(item.value) for item in value.items])
    return scalar_at(_NOWHERE, value.lexeme if value else "")


def _string(value: str | ReferredName | Doc) -> str:
    return value if isinstance(value, str) else value.text


@lru_cache(1024)  # most of a document are words that come again
def _scalar(text: str) -> Scalar:
    return text_at(_NOWHERE, text)


def text(document: Map, around: Notes) -> str:
    """The document's text; `around` are the comments above and below all."""
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
    elif isinstance(entry.value, Map | List):
        yield start + tail
        yield from _map(entry.value, inner) if isinstance(entry.value, Map) else _list(entry.value, inner)
    yield from _comments(entry.notes.foot, inner)


def _line(value: Value, start: str) -> str | None:
    """An entry on one line, where it can stand on one."""
    if value is None:
        return start
    if isinstance(value, Map | List):
        line = _flow(value)
        limit = value.limit if isinstance(value, Map) else WIDTH
        empty = line in ("{}", "[]")
        return f"{start} {line}" if line is not None and (empty or len(start) + 1 + len(line) <= limit) else None
    if isinstance(value, Raw):
        return f"{start} {value.lexeme}"
    told = _string(value)
    line = f"{start} {text_of(told)}"
    as_block = isinstance(value, Doc) and ("\n" in told or (len(line) > WIDTH and " " in told))
    return None if as_block and is_printable(told) and not told[:1].isspace() else line


def _flow(value: Value) -> str | None:
    """A value within a line; None where it cannot be."""
    if value is None:
        return "null"
    if isinstance(value, Raw):
        return value.lexeme
    if isinstance(value, str | ReferredName | Doc):
        said = _string(value)
        return None if isinstance(value, Doc) and "\n" in said else text_of(said, in_flow=True)
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
    """A text as a block: kept line by line (`|`), or one long line folded (`>`)."""
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
    """The comments above an entry; the first one of a block stands close to what opens it."""
    lines = entry.notes.head
    start = next((at for at, line in enumerate(lines) if line), 0) if first and indent else 0
    yield from _comments(lines[start:], indent)


def _comments(lines: list[str], indent: str) -> Iterator[Line]:
    for line in lines:
        yield f"{indent}# {escaped(line)[0]}".rstrip() if line else GAP
