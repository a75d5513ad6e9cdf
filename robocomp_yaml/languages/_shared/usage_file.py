"""One file of a user as tree-sitter parses it: its words with their locations, for readers of chains."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property

import msgspec
from tree_sitter import Node, Tree

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.specific.code import lines_of, location, text
from robocomp_yaml.emit.usage.code import Arguments, Constant, Step, Word

WORD = re.compile(r"\b[A-Za-z_]\w*")
TEXT = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


class UsageFile:
    """A file, parsed when its tree is first used."""

    def __init__(self, path: str, source: str, parse: Callable[[str], Tree]) -> None:
        self.path, self._source, self._parse = path, source, parse
        self._bytes = source.encode()

    @cached_property
    def _tree(self) -> Tree:
        return self._parse(self._source)

    @cached_property
    def _lines(self) -> list[str]:
        return lines_of(self._source)

    def _found(self, name: str, start: int, end: int) -> Iterator[Node]:
        """The innermost nodes between two positions in bytes that contain this word."""
        for found in re.compile(rb"\b%s\b" % re.escape(name.encode())).finditer(self._bytes, start, end):
            node = self._tree.root_node.descendant_for_byte_range(found.start(), found.end())
            if node is not None:
                yield node

    def _word(self, node: Node) -> Word:
        return Word(text(node), msgspec.structs.replace(location(node, self._lines), file=self.path))

    def _index(self, key: Constant | None = None, *, is_each: bool = False) -> Step:
        """The step to an element, with its key if that is a literal text; `is_each` in a loop over all."""
        word = self._inner(key) if key is not None and isinstance(key.value, str) else Word("", Span(self.path))
        return Step(word, is_index=True, is_each=is_each)

    def _value_of(self, node: Node) -> str | int | float | None:
        """A literal number, text or truth value."""
        raise NotImplementedError

    def _literal(self, node: Node) -> Constant | None:
        """A literal of one line with its location."""
        value = self._value_of(node)
        if value is None or node.start_point[0] != node.end_point[0]:
            return None
        return Constant(value, self._word(node).span)

    def _inner(self, constant: Constant) -> Word:
        """The text of a literal, without its quotes."""
        span = constant.span
        return Word(str(constant.value), Span(self.path, span.line, span.column + 1, span.line, span.end_column - 1))

    def _arguments_of(self, nodes: Sequence[Node], is_exact: bool, keys: tuple[Word, ...] = ()) -> Arguments:
        """The arguments of a call, with the literals at both ends."""
        first = self._literal(nodes[0]) if nodes else None
        last = self._literal(nodes[-1]) if nodes else None
        word = self._inner(first) if first is not None and isinstance(first.value, str) else None
        constant = last if last is not None and (word is None or len(nodes) > 1) else None
        return Arguments(len(nodes), (), is_exact, word, keys, constant, tuple(map(self._literal, nodes)))


def workers_of(classes: Iterable[tuple[str, list[str]]]) -> set[str]:
    """The classes, each given with its bases, that are derived from the generic worker and from nothing else, also by
    other classes of the code."""
    bases_of = dict(classes)
    return {name for name in bases_of if _is_worker(name, bases_of)}


def _is_worker(name: str, bases_of: Mapping[str, list[str]]) -> bool:
    bases, seen = bases_of[name], {name}
    while len(bases) == 1 and bases[0] in bases_of and bases[0] not in seen:
        seen.add(bases[0])
        bases = bases_of[bases[0]]
    return bases == ["GenericWorker"]


def unused(methods: Sequence[Word], sources: Iterable[str], pattern: re.Pattern[str]) -> tuple[Word, ...]:
    """The methods whose names, which match the pattern, stand in the code no more often than they are defined."""
    found = Counter(word for source in sources for word in pattern.findall(_COMMENT.sub("", TEXT.sub('""', source))))
    written = Counter(word.text for word in methods)
    return tuple(word for word in methods if found[word.text] <= written[word.text])
