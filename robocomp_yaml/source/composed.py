"""From the nodes that the YAML parsers compose to the tree of a document.

This module resolves plain scalars, exactly by the core schema of YAML 1.2
(https://yaml.org/spec/1.2.2/#103-core-schema): `on`, `yes`, `12:30` and `1_000` are text.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, cast

from ruamel.yaml.nodes import MappingNode, ScalarNode, SequenceNode
from ruamel.yaml.nodes import Node as YamlNode

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import UNTAG, Edit, Fix, quoting, removal
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import syntax
from robocomp_yaml.source.nodes import TOP, Base, Mapping, Mark, Node, Scalar, Sequence, core, end_of
from robocomp_yaml.source.text import MAX_SCALAR, position, size_in_words

MAX_ALIASED = 100_000  # nodes that all aliases together may add

_ZEROS = pattern(r"[-+]?0[0-9]+\Z")
_SURROGATE = re.compile("[\ud800-\udfff]")
_PLAIN_TAGS = ("!!str", "!!int", "!!float", "!!bool", "!!null", "!!map", "!!seq")  # the tags that plain YAML implies
_CORE_START = frozenset("0123456789+-.~nNtTfF")  # the first characters of scalars that are not text


def _last_mark(text: str) -> Mark:
    """The end of a text whose last line has no end."""
    lines = re.split("\r\n|\r|\n", text)
    return Mark(len(lines) - 1, len(lines[-1]), len(text))


class TreeBuilder:
    """Converts composed nodes to Nodes, and collects the errors."""

    def __init__(self, path: str, text: str, base: Base = TOP) -> None:
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
