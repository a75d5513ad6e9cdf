"""Parses YAML text to a tree of nodes with locations.

libyaml composes the nodes in C. Text that libyaml rejects, because it knows only the syntax of YAML 1.1, is parsed by
ruamel.yaml's own YAML 1.2 parser, which is twenty times slower. This module resolves plain scalars, exactly by the core
schema of YAML 1.2 (https://yaml.org/spec/1.2.2/#103-core-schema): `on`, `yes`, `12:30` and `1_000` are text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from typing import Any, TypeVar, cast

import msgspec
from ruamel.yaml.nodes import MappingNode, ScalarNode, SequenceNode
from ruamel.yaml.nodes import Node as YamlNode

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import UNTAG, Edit, Fix, quoting, removal
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reachable
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import syntax
from robocomp_yaml.source.text import MAX_SCALAR, position, size_in_words

_Result = TypeVar("_Result")
MAX_ALIASED = 100_000  # nodes that all aliases together may add

_INT = re.compile(r"[-+]?[0-9]+\Z")
_ZEROS = pattern(r"[-+]?0[0-9]+\Z")
_FLOAT = pattern(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?\Z")
_NAMED: dict[str, bool | float | None] = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_NAMED |= {word: word[0] in "tT" for word in ("true", "True", "TRUE", "false", "False", "FALSE")}
_NAMED |= {sign + dot: float(sign + "inf") for sign in ("", "+", "-") for dot in (".inf", ".Inf", ".INF")}
_NAMED |= {word: float("nan") for word in (".nan", ".NaN", ".NAN")}
_SURROGATE = re.compile("[\ud800-\udfff]")
_PLAIN_TAGS = ("!!str", "!!int", "!!float", "!!bool", "!!null", "!!map", "!!seq")  # the tags that plain YAML implies
_CORE_START = frozenset("0123456789+-.~nNtTfF")  # the first characters of scalars that are not text


class Base:
    """Where the text of a part begins that was parsed by itself: the number of lines before it, and of characters."""

    __slots__ = ("index", "line")

    def __init__(self, line: int = 0, index: int = 0) -> None:
        self.line, self.index = line, index


_TOP = Base()


class Node:
    """A value with its location. `data` is the same value as plain Python data, recursively. `base` is where its part
    of the document begins; `made` is what was built from it."""

    __slots__ = ("_end", "_start", "base", "data", "file", "made")

    def __init__(self, file: str, node: YamlNode | _Made, data: object, base: Base = _TOP) -> None:
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
    def start_mark(self) -> _Mark:
        return _Mark(self._start.line + self.base.line, self._start.column, self.start)

    @property
    def end_mark(self) -> _Mark:
        return _Mark(self._end.line + self.base.line, self._end.column, self.end)

    def get(self, key: str) -> Node | None:
        """The value of a mapping's key; None if it is missing or null, or if the node is not a mapping."""
        return None

    def children(self) -> Iterable[Node]:
        """The values of a mapping, or the items of a sequence."""
        return ()


class Scalar(Node):
    """`lexeme` is the text as written, without quotes; `quoted` is true for every style except plain."""

    __slots__ = ("lexeme", "quoted")

    def __init__(self, file: str, node: ScalarNode | _Made, value: object, base: Base = _TOP) -> None:
        self.file, self._start, self._end, self.data, self.base = file, node.start_mark, node.end_mark, value, base
        self.made: Any = None
        self.lexeme: str = node.value
        self.quoted: bool = node.style is not None and node.style != ""


class Mapping(Node):
    """`entries` maps each key to (key, value), in the document's order."""

    __slots__ = ("entries", "is_flow")

    def __init__(
        self, file: str, node: MappingNode | _Made, entries: dict[str, tuple[Scalar, Node]], base: Base = _TOP
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

    def __init__(self, file: str, node: SequenceNode | _Made, items: list[Node], base: Base = _TOP) -> None:
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
    depends on nothing else than the node and `more`."""
    if node.base is _TOP or outer.base is not _TOP:
        return find(node, *more)
    if node.made is None:
        node.made = {}
    known = node.made.get(find)
    if known is None or known[0] != more:
        node.made[find] = known = more, tuple(find(node, *more))
    result: tuple[_Result, ...] = known[1]
    return result


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


class _Mark(msgspec.Struct, frozen=True):
    line: int
    column: int
    index: int = -1


class _Made(msgspec.Struct, frozen=True):
    """Replaces the composed node in nodes that are not in a document."""

    start_mark: _Mark
    end_mark: _Mark
    value: str = ""
    style: str | None = None
    flow_style: bool | None = None


@lru_cache(16)  # many nodes are made for the same location
def _marks(span: Span) -> tuple[_Mark, _Mark]:
    return _Mark(span.line - 1, span.column - 1), _Mark(span.end_line - 1, span.end_column - 1)


def _last_mark(text: str) -> _Mark:
    """The end of a text whose last line has no end."""
    lines = re.split("\r\n|\r|\n", text)
    return _Mark(len(lines) - 1, len(lines[-1]), len(text))


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
                return int(lexeme[2:], base) if "_" not in lexeme and lexeme[2:].isalnum() else lexeme
            except ValueError:
                return lexeme
    return lexeme


def parse(path: str, text: str) -> tuple[Node | None, list[Diagnostic]]:
    """The tree of a document's text, or None with all errors."""
    try:
        root = syntax.compose(path, text)
    except syntax.SyntaxFault as fault:
        return None, [fault.diagnostic]
    if root is None:
        return None, [codes.EMPTY.at(Span(path))]
    builder = _TreeBuilder(path, text)
    tree = builder.build(root)
    return (None if builder.diagnostics else tree), builder.diagnostics


def part(path: str, text: str, base: Base) -> Mapping | None:
    """The tree of a text that is a part of a document, and begins at `base`; None if it is no mapping without any
    error."""
    try:
        root = syntax.compose(path, text)
    except syntax.SyntaxFault:
        return None
    builder = _TreeBuilder(path, text, base)
    tree = builder.build(root) if root is not None else None
    return tree if isinstance(tree, Mapping) and not builder.diagnostics else None


def whole(path: str, entries: dict[str, tuple[Scalar, Node]], end: Node) -> Mapping:
    """A mapping in a block of a document, of parts. It ends where the node `end` begins, or at the end of it, if that
    is the last value."""
    first = next(iter(entries.values()))[0]
    return Mapping(path, _Made(first.start_mark, end.end_mark, flow_style=False), entries)


class _TreeBuilder:
    """Converts composed nodes to Nodes, and collects the errors."""

    def __init__(self, path: str, text: str, base: Base = _TOP) -> None:
        self.path, self.text, self.base = path, text, base
        self.has_anchors = "&" in text
        self.last = None if text.endswith("\n") else _last_mark(text)  # libyaml ends blocks in the line after it
        self.diagnostics: list[Diagnostic] = []
        self.known: dict[YamlNode, tuple[Node, int]] = {}  # the Node, and the number of nodes with aliases expanded
        self.open: set[YamlNode] = set()
        self.size = 0
        self.aliased = 0

    def build(self, node: YamlNode) -> Node:
        known = self.known.get(node)
        if known is not None:
            self._alias(node, known[1])
            return known[0]
        if node.ctag is not syntax.UNTAGGED:
            self._explicit_tag(node)
        before = self.size
        self.size += 1
        if isinstance(node, ScalarNode):
            built: Node = self._scalar(node)
        elif node in self.open:
            self._say(codes.ALIASES, node, problem="an alias is inside of the value that it repeats")
            return Scalar(self.path, ScalarNode(None, "", node.start_mark, node.end_mark), None)
        else:
            self.open.add(node)
            built = (
                self._mapping(node)
                if isinstance(node, MappingNode)
                else Sequence(
                    self.path, cast("SequenceNode", node), [self.build(item) for item in node.value], self.base
                )
            )
            self.open.discard(node)
        if self.last is not None and built._end.line > self.last.line:
            built._end = self.last
        if self.has_anchors:  # composed nodes do not record whether they have one
            self.known[node] = (built, self.size - before)
        return built

    def _alias(self, node: YamlNode, size: int) -> None:
        self.size += size
        too_many = self.aliased <= MAX_ALIASED < self.aliased + size
        self.aliased += size
        if too_many:
            self._say(
                codes.ALIASES,
                node,
                problem=f"aliases of this anchor make the document too large: more than "
                f"{MAX_ALIASED} values are repeats",
                hint="write the values out, or repeat less",
            )

    def _scalar(self, node: ScalarNode) -> Scalar:
        lexeme = node.value
        if len(lexeme) > MAX_SCALAR:
            self._say(
                codes.TOO_LARGE,
                node,
                what="this text",
                size=size_in_words(len(lexeme)),
                limit=size_in_words(MAX_SCALAR),
            )
        if node.style is not None and node.style != "":
            return self._quoted(node)
        if lexeme and lexeme[0] not in _CORE_START:
            return Scalar(self.path, node, lexeme, self.base)
        return Scalar(self.path, node, self._core(node, lexeme), self.base)

    def _quoted(self, node: ScalarNode) -> Scalar:
        """A text in quotes. An escape sequence in it may be a surrogate, which is not a character."""
        surrogate = None if node.value.isascii() else _SURROGATE.search(node.value)
        if surrogate:
            self._say(codes.BINARY, node, byte=f"U+{ord(surrogate[0]):04X}", hint="write the character itself")
        return Scalar(self.path, node, node.value, self.base)

    def _core(self, node: ScalarNode, lexeme: str) -> object:
        """The value of a plain scalar. Reports leading zeros, which YAML 1.1 reads as octal."""
        data = core(lexeme)
        if _ZEROS.match(lexeme):
            digits = lexeme.lstrip("+-")
            zeros = digits.lstrip("0") or "0"
            self._say(
                codes.LEADING_ZEROS,
                node,
                lexeme=lexeme,
                hint=f'write "{lexeme}" for text, or {lexeme[: len(lexeme) - len(digits)]}{zeros} for a number',
                fixes=[quoting(self._span(node), safe=False)],
            )
        return data

    def _mapping(self, node: MappingNode) -> Mapping:
        entries: dict[str, tuple[Scalar, Node]] = {}
        for key_node, value_node in node.value:
            value = self.build(value_node)
            if not isinstance(key_node, ScalarNode):
                kind = "a mapping" if isinstance(key_node, MappingNode) else "a list"
                self._say(codes.KEY_TYPE, key_node, what=kind)
                continue
            key = self._key(node, key_node, value)
            if key.lexeme in entries:
                first = entries[key.lexeme][0]
                self._say(
                    codes.DUPLICATE_KEY,
                    key_node,
                    key=key.lexeme,
                    related=[Related("first written here", first.span)],
                    fixes=self._without_second(first, entries[key.lexeme][1], key, value),
                )
                continue
            entries[key.lexeme] = (key, value)
        return Mapping(self.path, node, entries, self.base)

    def _key(self, mapping: MappingNode, node: ScalarNode, value: Node) -> Scalar:
        """A key is the text as written: `2d`, `on` and `1` are keys like any other."""
        if node.ctag is not syntax.UNTAGGED:
            self._explicit_tag(node)
        if not node.value and not node.style:
            self._say(codes.KEY_TYPE, node, what="empty", hint="write a name before the colon")
        if not node.style and mapping.flow_style and ":" in node.value:
            missing_value = value.data is None and isinstance(value, Scalar) and not value.lexeme
            if node.value.endswith(":") or missing_value:
                head, _, tail = node.value.partition(":")
                span = self._span(node).inside(node.value, len(head) + 1, len(head) + 2)
                after = Span(span.file, span.line, span.column, span.line, span.column)
                is_plain = tail.strip(":") and not tail.startswith(":") and span.column != node.start_mark.column + 1
                self._say(
                    codes.KEY_COLON,
                    node,
                    key=node.value,
                    hint=f"write '{head}: {tail.lstrip(':')}'".rstrip(),
                    fixes=[Fix("insert a blank after the colon", (Edit(after, " "),), True)] if is_plain else [],
                )
        return self._quoted(node)

    def _explicit_tag(self, node: YamlNode) -> None:
        tag = str(node.tag).replace("tag:yaml.org,2002:", "!!")
        self._say(
            codes.TAG,
            node,
            tag=tag,
            hint="remove the tag" + (", and use quotes" if tag == "!!str" else ""),
            fixes=[Fix("remove the tag", (Edit(self._span(node), how=UNTAG),), True)] if tag in _PLAIN_TAGS else [],
        )

    def _without_second(self, key: Scalar, value: Node, again: Scalar, other: Node) -> list[Fix]:
        """The fix that removes a second entry with the same text as the first one; none if the texts differ."""
        spelled, same = (
            self.text[at.end : max(end_of(what), at.end)].rstrip() for at, what in ((key, value), (again, other))
        )
        if spelled != same or other.start < again.end or "&" in spelled:
            return []
        end = max(end_of(other), again.end + 1)
        end = len(self.text[:end].rstrip())
        line, column = position(self.text, end)
        span = again.span
        return [removal(Span(self.path, span.line, span.column, line, column))]

    def _span(self, node: YamlNode) -> Span:
        start, end = node.start_mark, node.end_mark
        end = self.last if self.last is not None and end.line > self.last.line else end
        return Span(self.path, start.line + 1, start.column + 1, end.line + 1, end.column + 1)

    def _say(
        self,
        code: Code,
        node: YamlNode,
        *,
        hint: str = "",
        related: list[Related] | None = None,
        fixes: Iterable[Fix] = (),
        **facts: Any,
    ) -> None:
        self.diagnostics.append(code.at(self._span(node), hint=hint, related=related or (), fixes=fixes, **facts))
