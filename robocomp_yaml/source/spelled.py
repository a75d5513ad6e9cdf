"""Translates fixes to edits of a document's text: with quotes where YAML needs them, and no other change.

A check knows the intended meaning and the location of a fault, but not the text. A fix that cannot be translated is
dropped.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import pairwise

from msgspec.structs import replace

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import IMPORT, LIST, QUOTE, UNQUOTE, UNTAG, VALUE, WORD, Edit, Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar, core, end_of, parse
from robocomp_yaml.source.tree import Sequence as SequenceNode
from robocomp_yaml.source.yaml_text import quoted, single_quoted

_LINE_END = pattern("\r\n|\r|\n")
_MARKS = pattern(r"(?:[&!]\S*[ \t]+)+")  # anchor and tag before a value
_IN_A_TEXT = pattern(r"[\w ./+@=<>-]+")  # allowed in any text, whatever its quotes
_PLAIN = pattern(r"[\w./](?:[\w ./+-]*[\w./+-])?")  # needs no quotes, unless it is not text by the core schema
_ITEM = pattern(r"[ ]*-[ \t]+")


def spelled(diagnostics: Iterable[Diagnostic], texts: DocumentTexts) -> Iterator[Diagnostic]:
    """The diagnostics with fixes whose edits are texts."""
    for diagnostic in diagnostics:
        if all(fix.is_spelled for fix in diagnostic.fixes):
            yield diagnostic
            continue
        fixes = [made for fix in diagnostic.fixes if (made := _spelled(fix, texts))]
        yield replace(diagnostic, fixes=tuple(dict.fromkeys(fixes)))


def _spelled(fix: Fix, texts: DocumentTexts) -> Fix | None:
    edits: list[Edit] = []
    for edit in fix.edits:
        text = texts.get(edit.span.file)
        made = [edit] if not edit.how else text.spelled(edit) if text is not None else []
        if not made:
            return None
        edits += made
    return replace(fix, edits=tuple(edits))


class DocumentTexts:
    """The texts of a run's documents. `contents` maps paths to bytes, `trees` maps paths to parsed trees."""

    def __init__(self, contents: Mapping[str, bytes], trees: Mapping[str, Node | None]) -> None:
        self.contents, self._trees = contents, trees
        self._known: dict[str, DocumentText | None] = {}

    def get(self, file: str) -> DocumentText | None:
        """The text of a document; None if it is unknown or not text."""
        if file not in self._known:
            raw = self.contents.get(file)
            text = decode(file, raw)[0] if raw is not None else None
            self._known[file] = made = DocumentText(file, text) if text is not None else None
            if made is not None and file in self._trees:
                made.tree = self._trees[file]
        return self._known[file]


class DocumentText:
    """A document's text, with conversions between spans and indices."""

    def __init__(self, file: str, text: str) -> None:
        self.file, self.text = file, text
        self.is_yaml = file.endswith((".yaml", ".yml"))
        self._inside: dict[Node, tuple[list[Node], list[int]]] = {}

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(end.end() for end in _LINE_END.finditer(self.text))]

    @property
    def lines(self) -> list[str]:
        """The lines without their ends."""
        return _LINE_END.split(self.text)

    def index(self, line: int, column: int) -> int:
        """The index of a line and column (both from 1); at most the length of the text."""
        if line > len(self._starts):
            return len(self.text)
        return min(self._starts[line - 1] + column - 1, len(self.text))

    def span(self, start: int, end: int) -> Span:
        first, last = (bisect_right(self._starts, at) for at in (start, end))
        return Span(
            self.file, first, start - self._starts[first - 1] + 1, last, end - self._starts[last - 1] + 1
        )  # fmt: skip

    def edit(self, start: int, end: int, new: str) -> Edit:
        return Edit(self.span(start, end), new)

    @cached_property
    def tree(self) -> Node | None:
        return parse(self.file, self.text)[0] if self.is_yaml else None

    def spelled(self, edit: Edit) -> list[Edit]:
        """The text edits for an edit by its meaning; none if it cannot be translated."""
        start = self.index(edit.span.line, edit.span.column)
        end = self.index(edit.span.end_line, edit.span.end_column)
        if edit.how == WORD:
            return self._word(start, end, edit.word, edit.text)
        if edit.how in (QUOTE, LIST):
            return self._around(start, end, edit.how)
        if edit.how == VALUE:
            node = self._scalar(start)
            return [self.edit(*self._inner(node), edit.text)] if node is not None else []
        if edit.how == UNTAG:
            return self._untagged(start, end)
        if edit.how == IMPORT:
            return self._importing(edit.text)
        return self._unquoted(start) if edit.how == UNQUOTE else self._without(start, end)

    def _word(self, start: int, end: int, word: str, meant: str) -> list[Edit]:
        node = self._scalar(start)
        begin, finish = (self._inner(node)) if node is not None else (start, end)
        is_whole = node is not None and node.lexeme == word
        # Braces that a text has inside, such as the `{i}` of instances, need no quotes in another text there, either.
        letters = meant.replace("{", "").replace("}", "") if "{" in word and meant[:1] not in "{}" else meant
        if is_whole and (is_plain := not _is_quoted(self.text, begin)):
            if self.text[begin:finish] == word:
                return [self.edit(begin, finish, meant if _is_text(letters) else quoted(meant))]
        elif is_whole and not is_plain:
            inner = self.text[begin + 1 : finish - 1]
            if inner == word and _IN_A_TEXT.fullmatch(letters):
                return [self.edit(begin + 1, finish - 1, meant)]
            if self.text[begin] in "'\"":
                return [self.edit(begin, finish, (single_quoted if self.text[begin] == "'" else quoted)(meant))]
        at = self._where(max(start, begin), begin, finish, word)
        if at is None or not _IN_A_TEXT.fullmatch(letters):
            return []
        return [self.edit(at, at + len(word), meant)]

    def _where(self, start: int, begin: int, end: int, word: str) -> int | None:
        """The index of a word: at `start`, or where it occurs once in the text around it, or at the end of that text,
        as in a path."""
        places = [begin + match.start() for match in re.finditer(_whole(word), self.text[begin:end])]
        if start in places or not places:
            return start if places else None
        is_last = self.text[places[-1] + len(word) : end].strip("'\" \t") == ""
        return places[-1] if len(places) == 1 or is_last else None

    def _around(self, start: int, end: int, how: str) -> list[Edit]:
        node = self._scalar(start)
        start, end = self._inner(node) if node is not None else (self._behind_marks(start), end)
        old = self.text[start:end]
        if not old or len(old.splitlines()) > 1 or (how == QUOTE and old[0] in "'\"|>[{"):
            return []
        left, right = ('"', '"') if how == QUOTE else ("[", "]")
        if how == QUOTE and ('"' in old or "\\" in old):
            return [self.edit(start, end, quoted(old))]
        return [self.edit(start, start, left), self.edit(end, end, right)]

    def _unquoted(self, start: int) -> list[Edit]:
        node = self._scalar(start)
        if node is None or not _is_quoted(self.text, self._inner(node)[0]):
            return []
        return [self.edit(*self._inner(node), node.lexeme.strip())]

    def _untagged(self, start: int, end: int) -> list[Edit]:
        match = re.compile(r"(?:&\S+[ \t]+)?(!\S+)[ \t]+").match(self.text, start)
        if match is None:
            return []
        tag = self.edit(match.start(1), match.end(), "")
        is_bare_text = match[1] == "!!str" and self.text[match.end() : match.end() + 1] not in ("'", '"', "|", ">")
        quotes = self._around(match.end(), end, QUOTE) if is_bare_text else []
        return [tag, *quotes] if quotes or not is_bare_text else []

    def _without(self, start: int, end: int) -> list[Edit]:
        """Removes the element that begins at `start`; a comment after it stays."""
        entry = _entry(self.tree, start)
        if entry is None and self.tree is None and not self.text[start : start + 1].isspace():
            return self._without_entry(start, end)
        if entry is None or self.text[start : start + 1] in "&*!":
            return []
        at, nodes, is_flow = entry
        end = nodes[at].end
        if is_flow:
            before = self.text[nodes[at - 1].end : start] if at else ""
            if at and "\n" not in before and "#" not in before:
                return [self.edit(nodes[at - 1].end, end, "")]
            comma = re.compile(r"[ \t]*,[ \t]*").match(self.text, end)
            return [self.edit(start, comma.end() if comma else end, "")]
        return without_lines(self, start, end)

    def _importing(self, name: str) -> list[Edit]:
        """Adds an import after the last one, or, if there is none, after `language:` or the first key."""
        root = self.tree
        if not isinstance(root, MappingNode) or root.is_flow or not root.entries:
            return []
        new = name if _is_text(name) else quoted(name)
        if (imports := root.entries.get("imports")) is None:
            head = root.entries.get("language") or next(iter(root.entries.values()))
            at = self._end_of_line(max(end_of(head[1]), head[0].end + 1))
            return [self.edit(at, at, f"{self._line_end}imports: [{new}]")]
        value = imports[1]
        if isinstance(value, SequenceNode) and value.is_flow:
            at = value.items[-1].end if value.items else value.start + 1
            return [self.edit(at, at, f", {new}" if value.items else new)]
        if isinstance(value, SequenceNode):
            last = value.items[-1]
            line = self.index(last.span.line, 1)
            at = self._end_of_line(end_of(last))
            is_plain = _ITEM.fullmatch(self.text[line : last.start]) and isinstance(last, Scalar)
            return [self.edit(at, at, f"{self._line_end}{self.text[line : last.start]}{new}")] if is_plain else []
        return []

    @property
    def _line_end(self) -> str:
        match = _LINE_END.search(self.text)
        return match[0] if match else "\n"

    def _end_of_line(self, index: int) -> int:
        rest = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?=[\r\n]|\Z)").match(self.text, index)
        return rest.end() if rest else index

    def _without_entry(self, start: int, end: int) -> list[Edit]:
        """Removes an entry of a mapping."""
        before = self.text[:start].rstrip(" \t")
        if before.endswith(","):
            return [self.edit(len(before) - 1, end, "")]
        return without_lines(self, start, end)

    def _scalar(self, index: int) -> Scalar | None:
        """The key or value at an index."""
        node = self.tree
        while node is not None and not isinstance(node, Scalar):
            node = self._child(node, index)
        return node

    def _child(self, node: Node, index: int) -> Node | None:
        """The key or value of a collection at an index."""
        if node not in self._inside:
            children = list(_children(node))
            apart = all(max(one.end, one.start + 1) <= other.start for one, other in pairwise(children))
            # What an alias means is where its anchor is.
            self._inside[node] = children, [child.start for child in children] if apart else []
        children, starts = self._inside[node]
        at = bisect_right(starts, index) - 1
        found = children if not starts else children[at : at + 1] if at >= 0 else []
        return next((child for child in found if _has(child, index)), None)

    def _inner(self, node: Scalar) -> tuple[int, int]:
        """The start and end of a scalar, without anchor and tag."""
        return self._behind_marks(node.start), node.end

    def _behind_marks(self, start: int) -> int:
        marks = _MARKS.match(self.text, start)
        return marks.end() if marks else start


def without_lines(text: DocumentText, start: int, end: int) -> list[Edit]:
    """Removes an entry that shares its lines with no other entry; a comment after it stays, on a line of its own."""
    whole = text.text
    line = max(whole.rfind("\n", 0, start), whole.rfind("\r", 0, start)) + 1
    before = whole[line:start]
    if before.strip() and not _ITEM.fullmatch(before):
        return []
    while end > start and whole[end - 1] in "\r\n \t":
        end -= 1
    rest = re.compile(r"[ \t]*(#[^\r\n]*)?(\r\n|\r|\n|\Z)").match(whole, end)
    if rest is None:
        return []
    if rest[1]:
        indent = re.match(r"[ ]*", before)
        return [text.edit(line + len(indent[0] if indent else ""), rest.start(1), "")]
    return [text.edit(line, rest.end(), "")]


def _has(node: Node, index: int) -> bool:
    return node.start <= index < max(node.end, node.start + 1)


def _children(node: Node) -> Iterator[Node]:
    if isinstance(node, MappingNode):
        for key, value in node.items():
            yield key
            yield value
    elif isinstance(node, SequenceNode):
        yield from node.items


def _entry(node: Node | None, start: int) -> tuple[int, list[Node], bool] | None:
    """The element of a list that begins at an index: its position in the list, all elements, and whether the list is
    in brackets."""
    while node is not None:
        if isinstance(node, SequenceNode):
            for at, item in enumerate(node.items):
                if item.start == start:
                    return at, node.items, node.is_flow
        node = next((child for child in _children(node) if child.start <= start < child.end), None)
    return None


def _whole(word: str) -> str:
    """A pattern of a word that is not part of a longer one."""
    left = r"(?<!\w)" if word[:1].isalnum() or word[:1] == "_" else ""
    right = r"(?!\w)" if word[-1:].isalnum() or word[-1:] == "_" else ""
    return f"{left}{re.escape(word)}{right}"


def _is_quoted(text: str, start: int) -> bool:
    return text[start : start + 1] in ("'", '"', "|", ">")


def _is_text(meant: str) -> bool:
    """Whether YAML reads it as this text without quotes, in every position."""
    return _PLAIN.fullmatch(meant) is not None and not meant.startswith("...") and core(meant) == meant
