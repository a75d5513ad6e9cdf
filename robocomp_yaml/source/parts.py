"""Parses a long document again after an edit: only the entries whose text or line changed.

A document is cut into the entries of its top-level mapping, and those of long blocks below them, by indentation alone.
Each entry is parsed by itself, followed by the beginning of the next one, so that it ends where it ends in the whole.
If an entry is not YAML, the text from there on is parsed as if it began there: all before it is complete. Whatever else
is not certain (an anchor, an entry that is no single pair) is left to the parser of whole texts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import syntax
from robocomp_yaml.source.tree import Base, Mapping, Node, Scalar, parse, part, whole

LONG = 4_000  # characters: shorter documents are parsed as a whole
FEW = 8  # entries of a block that is not cut
_UNCERTAIN = pattern(r"[&*\t\x85\u2028\u2029\ufeff]|\r(?!\n)|^(?:---|\.\.\.|%|\?)", re.MULTILINE)
_TOP = pattern(r"^[^\s#\-?:,\[\]{}&*!|>%@`]", re.MULTILINE)
_HEAD = pattern(r"[^\s#:'\"\[\]{}]+:[ ]*(?:#[^\n]*)?\r?\n")
_FIRST = pattern(r"(?:[ ]*(?:#[^\n]*)?\r?\n)*(?P<indent>[ ]+)[^\s#\-?:,\[\]{}&*!|>%@`]")
Entry = tuple[Scalar, Node]


class Part(msgspec.Struct):
    """An entry that was parsed by itself. `block` is the mapping around it, which ends where that of the whole does,
    if this is its last entry."""

    key: Scalar
    value: Node
    base: Base
    block: Node


Parts = dict[tuple[str, int, int], Part]
"""The parts of a document by their text, the number of their first line, and the indentation of the next entry."""


def parse_in_parts(path: str, text: str, known: Parts) -> Mapping | None:
    """The tree of a document, with the parts in `known` that are the same; these are replaced by the parts of this
    text. None if the text has to be parsed as a whole. Raises SyntaxFault if it is not YAML."""
    if len(text) < LONG or not text.endswith("\n") or _UNCERTAIN.search(text):
        return None
    parts = _Parts(path, text, known)
    root = parts.root()
    known.clear()
    if root is not None:
        known.update(parts.used)
    return root


class PartsParser:
    """Parses the versions of a document one after the other. A tree may be used until the next version is parsed."""

    def __init__(self) -> None:
        self._known = Parts()

    def parse(self, path: str, text: str) -> tuple[Node | None, list[Diagnostic]]:
        """The tree of a document's text, or None with all errors."""
        try:
            root = parse_in_parts(path, text, self._known)
        except syntax.SyntaxFault as fault:
            return None, [fault.diagnostic]
        return (root, []) if root is not None else parse(path, text)


class _Parts:
    def __init__(self, path: str, text: str, known: Parts) -> None:
        self.path, self.text, self.known, self.used = path, text, known, Parts()
        self.failed: tuple[int, int, int] | None = None  # the entry below a key that is no part: see `_check`

    def root(self) -> Mapping | None:
        starts = [found.start() for found in _TOP.finditer(self.text)]
        if not starts or re.search(r"^[ ]*[^#\s]", self.text[: starts[0]], re.MULTILINE):
            return None
        entries: dict[str, Entry] = {}
        line = self.text.count("\n", 0, starts[0])
        found: Part | None = None
        for start, end in zip(starts, [*starts[1:], len(self.text)], strict=True):
            follows = 0 if end < len(self.text) else -1
            self.failed = None
            found = self._section(start, end, line, follows)
            if found is None and self.failed is not None:
                self._check(*self.failed)
            found = found or self._entry(start, end, line, 0, follows)
            if found is None and entries:  # before that, it may be no mapping at all
                self._check(start, line, 0)
            if found is None or found.key.lexeme in entries:
                return None
            entries[found.key.lexeme] = found.key, found.value
            line += self.text.count("\n", start, end)
        return whole(self.path, entries, found.block) if found is not None else None

    def _check(self, start: int, line: int, indent: int) -> None:
        """Raises SyntaxFault if the text is not YAML from an entry on that begins in a line (from 0). It is parsed
        behind another entry."""
        head = f"{_OUTER}{' ' * indent}{_NEXT}" if indent else _OUTER
        try:
            syntax.compose(self.path, head + self.text[start:])
        except syntax.SyntaxFault as fault:
            raise syntax.SyntaxFault(_below(fault.diagnostic, line - head.count("\n"))) from None

    def _section(self, start: int, end: int, line: int, follows: int) -> Part | None:
        """A top-level entry whose value is a long block of entries, each in lines of its own."""
        head = _HEAD.match(self.text, start, end)
        first = _FIRST.match(self.text, head.end(), end) if head is not None else None
        if head is None or first is None:
            return None
        indent = len(first["indent"])
        starts = list(self._starts(first.start("indent"), end, indent))
        if len(starts) < FEW:
            return None
        # The key, with the first entry, so that it ends where it ends in the whole.
        opened = self._entry(start, starts[1], line, 0, indent)
        if opened is None or not isinstance(opened.value, Mapping):
            return None
        entries = {name: entry for name, entry in opened.value.entries.items() if name != "Z"}
        line += self.text.count("\n", start, starts[1])
        last = opened
        for begin, stop in zip(starts[1:], [*starts[2:], end], strict=True):
            found = self._entry(begin, stop, line, indent, indent if stop < end else follows)
            if found is None:
                self.failed = begin, line, indent
            if found is None or found.key.lexeme in entries:
                return None
            entries[found.key.lexeme], last = (found.key, found.value), found
            line += self.text.count("\n", begin, stop)
        return Part(opened.key, whole(self.path, entries, last.block), last.base, last.block)

    def _starts(self, start: int, end: int, indent: int) -> Iterator[int]:
        """Where the entries of a block begin; nothing if a line is indented less."""
        found = []
        line = re.compile(rf"^(?P<less>[ ]{{0,{indent - 1}}})(?=[^\s#])|^[ ]{{{indent}}}(?=[^\s#])", re.MULTILINE)
        for match in line.finditer(self.text, start, end):
            if match["less"] is not None or self.text[match.end()] in "-?:,[]{}&*!|>%@`":
                return
            found.append(match.start())
        yield from found

    def _entry(self, start: int, end: int, line: int, indent: int, follows: int) -> Part | None:
        """One entry, in lines from `line` (from 0) on, before an entry that is indented by `follows` (-1: before the
        end of the text)."""
        text = self.text[start:end]
        key = text, line, follows
        found = self.known.get(key)
        if found is None:
            found = self._made(text, line, indent, follows)
            if found is None:
                return None
        found.base.index = start - (_LENGTH if indent else 0)
        self.used[key] = found
        return found

    def _made(self, text: str, line: int, indent: int, follows: int) -> Part | None:
        """An entry, parsed below a key if it is indented, and before the next one."""
        base = Base(line - (1 if indent else 0))
        tail = f"{' ' * follows}{_NEXT}" if follows >= 0 else ""
        inside = not indent and follows > 0  # a section with its first entry: the next one is inside
        root = part(self.path, f"{_OUTER if indent else ''}{text}{tail}", base)
        if root is None:
            return None
        node: Node = root
        if indent:
            if len(root.entries) != (2 if follows == 0 else 1) or "P" not in root.entries:
                return None
            node = root.entries["P"][1]
            expected = 2 if follows == indent else 1
        elif inside:
            if len(root.entries) != 1:
                return None
            key, block = next(iter(root.entries.values()))
            is_pair = isinstance(block, Mapping) and list(block.entries)[1:] == ["Z"]
            return Part(key, block, base, block) if is_pair else None
        else:
            expected = 1 if follows < 0 else 2
        if not isinstance(node, Mapping) or len(node.entries) != expected:
            return None
        if expected == 2 and list(node.entries)[1] != "Z":
            return None
        return Part(*next(iter(node.entries.values())), base, node)


def _below(one: Diagnostic, lines: int) -> Diagnostic:
    """A diagnostic of a text that begins so many lines further down."""

    def moved(span: Span) -> Span:
        return replace(span, line=span.line + lines, end_line=span.end_line + lines)

    fixes = tuple(
        replace(fix, edits=tuple(replace(edit, span=moved(edit.span)) for edit in fix.edits)) for fix in one.fixes
    )
    return replace(one, span=moved(one.span), fixes=fixes)


_OUTER, _NEXT = "P:\n", "Z:\n"
_LENGTH = len(_OUTER)
