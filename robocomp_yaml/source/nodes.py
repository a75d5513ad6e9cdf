"""The nodes of a document: values with their locations, and searches in them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reachable
from robocomp_yaml.patterns import pattern

if TYPE_CHECKING:
    from ruamel.yaml.nodes import MappingNode, ScalarNode, SequenceNode
    from ruamel.yaml.nodes import Node as YamlNode

_Result = TypeVar("_Result")
_INT = re.compile(r"[-+]?[0-9]+\Z")
_FLOAT = pattern(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?\Z")
_NAMED: dict[str, bool | float | None] = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_NAMED |= {word: word[0] in "tT" for word in ("true", "True", "TRUE", "false", "False", "FALSE")}
_NAMED |= {sign + dot: float(sign + "inf") for sign in ("", "+", "-") for dot in (".inf", ".Inf", ".INF")}
_NAMED |= {word: float("nan") for word in (".nan", ".NaN", ".NAN")}


class Base:
    """Where the text of a part begins that was parsed by itself: the number of lines before it, and of characters."""

    __slots__ = ("index", "line")

    def __init__(self, line: int = 0, index: int = 0) -> None:
        self.line, self.index = line, index


TOP = Base()


class Node:
    """A value with its location. `data` is the same value as plain Python data, recursively. `base` is where its part
    of the document begins; `made` is what was built from it."""

    __slots__ = ("_end", "_start", "base", "data", "file", "made")

    def __init__(self, file: str, node: YamlNode | _Made, data: object, base: Base = TOP) -> None:
        self.file, self._start, self._end, self.data, self.base = file, node.start_mark, node.end_mark, data, base
        self.made: Any = None

    @property
    def start(self) -> int:
        """The index of its first character in the text; `end` is the index after its last one."""
        return int(self._start.index) + self.base.index

    @property
    def end(self) -> int:
        return int(self._end.index) + self.base.index

    @property
    def span(self) -> Span:
        start, end, line = self._start, self._end, self.base.line + 1
        return Span(self.file, start.line + line, start.column + 1, end.line + line, end.column + 1)

    @property
    def start_mark(self) -> Mark:
        return Mark(self._start.line + self.base.line, self._start.column, self.start)

    @property
    def end_mark(self) -> Mark:
        return Mark(self._end.line + self.base.line, self._end.column, self.end)

    def get(self, key: str) -> Node | None:
        """The value of a mapping's key; None if it is missing or null, or if the node is not a mapping."""
        return None

    def children(self) -> Iterable[Node]:
        """The values of a mapping, or the items of a sequence."""
        return ()


class Scalar(Node):
    """`lexeme` is the text as written, without quotes; `quoted` is true for every style except plain."""

    __slots__ = ("lexeme", "quoted")

    def __init__(self, file: str, node: ScalarNode | _Made, value: object, base: Base = TOP) -> None:
        self.file, self._start, self._end, self.data, self.base = file, node.start_mark, node.end_mark, value, base
        self.made: Any = None
        self.lexeme: str = node.value
        self.quoted: bool = node.style is not None and node.style != ""


class Mapping(Node):
    """`entries` maps each key to (key, value), in the document's order."""

    __slots__ = ("entries", "is_flow")

    def __init__(
        self, file: str, node: MappingNode | _Made, entries: dict[str, tuple[Scalar, Node]], base: Base = TOP
    ) -> None:
        super().__init__(file, node, {key: value.data for key, (_, value) in entries.items()}, base)
        self.entries = entries
        self.is_flow = bool(node.flow_style)

    def get(self, key: str) -> Node | None:
        entry = self.entries.get(key)
        return entry[1] if entry and entry[1].data is not None else None

    def items(self) -> Iterator[tuple[Scalar, Node]]:
        return iter(self.entries.values())

    def children(self) -> Iterable[Node]:
        return [value for _, value in self.entries.values()]


class Sequence(Node):
    __slots__ = ("is_flow", "items")

    def __init__(self, file: str, node: SequenceNode | _Made, items: list[Node], base: Base = TOP) -> None:
        super().__init__(file, node, [item.data for item in items], base)
        self.items = items
        self.is_flow = bool(node.flow_style)

    def children(self) -> Iterable[Node]:
        return self.items


def once(make: Callable[..., _Result], key: Scalar, node: Node, *more: Any) -> _Result:
    """The result of `make` for an entry of a document, kept with its node: if the entry is the same after an edit, it
    is not made again. It depends on nothing else than the arguments."""
    if node.made is None:
        node.made = {}
    known = node.made.get(make)
    if known is None or known[0] is not key or known[1] != more:
        node.made[make] = known = key, more, make(key, node, *more)
    result: _Result = known[2]
    return result


def found_in(find: Callable[..., Iterable[_Result]], outer: Node, node: Node, *more: Any) -> Iterable[_Result]:
    """What a search finds in a node of `outer`; kept with the node if it is an entry that was parsed by itself. It
    depends on nothing else than the node and `more`. The last two searches are kept: a document is looked at by itself
    and with the others in turn."""
    if node.base is TOP or outer.base is not TOP:
        return find(node, *more)
    if node.made is None:
        node.made = {}
    known: tuple[tuple[tuple[Any, ...], tuple[_Result, ...]], ...] = node.made.get(find, ())
    for used, result in known:
        if used == more:
            return result
    made = tuple(find(node, *more))
    node.made[find] = (more, made), *known[:1]
    return made


def below(root: Node) -> Iterable[Node]:
    """A node and all nodes in it, each once."""
    return reachable([root], lambda node: node.children())


def pairs_below(root: Node) -> Iterator[tuple[Scalar, Node]]:
    """The keys and values of all mappings in a node."""
    return (pair for node in below(root) if isinstance(node, Mapping) for pair in node.items())


def last_end(node: Mapping) -> int | None:
    """The index after the last entry of a mapping; None if the mapping is empty."""
    end = None
    for key, value in node.entries.values():
        end = max(key.end, end_of(value))
        if isinstance(value, Scalar) and value.start == value.end:
            end = max(end, key.end + 1)  # the colon
    return end


def end_of(node: Node) -> int:
    """The index after a node's own text: libyaml ends block collections at the start of the next node."""
    if isinstance(node, Mapping) and node.entries and not node.is_flow:
        return last_end(node) or node.end
    if isinstance(node, Sequence) and node.items and not node.is_flow:
        return end_of(node.items[-1])
    return node.end


def not_plain(node: Node) -> str:
    """What a node is that has no plain value, in words; '' for one that has."""
    if isinstance(node, Mapping):
        return "a mapping"
    if isinstance(node, Sequence):
        return "a list"
    return "empty" if node.data is None else ""


def child(node: Node | None, step: str | int) -> tuple[Scalar | None, Node] | None:
    """The key and the node one step below: an entry of a mapping, or an item of a sequence, which has no key; None if
    there is none."""
    if isinstance(node, Mapping) and isinstance(step, str):
        return node.entries.get(step)
    if isinstance(node, Sequence) and isinstance(step, int) and step < len(node.items):
        return None, node.items[step]
    return None


def node_at(root: Node, steps: Iterable[str | int]) -> Node | None:
    """The node at these steps below a root; None if there is none."""
    node: Node | None = root
    for step in steps:
        found = child(node, step)
        node = found[1] if found is not None else None
    return node


def value_at(root: Node | None, *keys: str) -> Node | None:
    """The value at these keys below a root; None if one is missing or null."""
    for key in keys:
        root = root.get(key) if root is not None else None
    return root


class Mark(msgspec.Struct, frozen=True):
    line: int
    column: int
    index: int = -1


class _Made(msgspec.Struct, frozen=True):
    """Replaces the composed node in nodes that are not in a document."""

    start_mark: Mark
    end_mark: Mark
    value: str = ""
    style: str | None = None
    flow_style: bool | None = None


@lru_cache(16)  # many nodes are made for the same location
def _marks(span: Span) -> tuple[Mark, Mark]:
    return Mark(span.line - 1, span.column - 1), Mark(span.end_line - 1, span.end_column - 1)


def text_at(span: Span, text: str) -> Scalar:
    """A text node that is not in a document, at the location of what it is derived from."""
    return Scalar(span.file, _Made(*_marks(span), text), text)


def mapping_at(span: Span, entries: dict[str, tuple[Scalar, Node]]) -> Mapping:
    return Mapping(span.file, _Made(*_marks(span)), entries)


def sequence_at(span: Span, items: list[Node]) -> Sequence:
    return Sequence(span.file, _Made(*_marks(span)), items)


def scalar_at(span: Span, lexeme: str) -> Scalar:
    """A plain scalar that is not in a document, with its value by the core schema."""
    return Scalar(span.file, _Made(*_marks(span), lexeme), core(lexeme))


def core(lexeme: str) -> object:
    """The value of a plain scalar by YAML 1.2's core schema."""
    if lexeme in _NAMED:
        return _NAMED[lexeme]
    if _INT.match(lexeme):
        return int(lexeme) if len(lexeme.lstrip("+-")) <= 4000 else float(lexeme)
    if _FLOAT.match(lexeme):
        return float(lexeme)
    for prefix, base in (("0x", 16), ("0o", 8)):
        if lexeme.startswith(prefix):
            try:
                return int(lexeme[2:], base) if lexeme.isascii() and lexeme[2:].isalnum() else lexeme
            except ValueError:
                return lexeme
    return lexeme


def whole(path: str, entries: dict[str, tuple[Scalar, Node]], end: Node) -> Mapping:
    """A mapping in a block of a document, of parts. It ends where the node `end` begins, or at the end of it, if that
    is the last value."""
    first = next(iter(entries.values()))[0]
    return Mapping(path, _Made(first.start_mark, end.end_mark, flow_style=False), entries)
