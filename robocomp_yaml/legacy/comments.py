"""Assign each comment of a legacy file to a construct: above it, at its end, below it, or in its `doc:`."""

from __future__ import annotations

import bisect
import re
from collections.abc import Sequence

import msgspec
from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.source.yaml_text import escaped

_DOC = re.compile(r"///(?!/)|/\*\*(?![*/])")
_BEHIND = re.compile(r"///<|/\*\*<")


class _Construct(msgspec.Struct, eq=False):
    """A construct that can have comments. `parent` is the construct that contains it."""

    start: int
    end: int
    rule: str
    parent: _Construct | None
    notes: Notes


class PlacedComments(msgspec.Struct, frozen=True):
    """The comments of each construct, by its rule and location, and those around the whole file."""

    by_construct: dict[tuple[str, int, int], Notes] = {}
    around: Notes = msgspec.field(default_factory=Notes)
    diagnostics: list[Diagnostic] = []

    def of(self, tree: Tree[Token]) -> Notes:
        notes = None if tree.meta.empty else self.by_construct.get(_key(tree))
        return Notes() if notes is None else notes


def _key(tree: Tree[Token]) -> tuple[str, int, int]:
    meta = tree.meta
    return str(tree.data), meta.start_pos, meta.end_pos


def place(tree: Tree[Token], comments: Sequence[Token], source: SourceText, rules: Rules) -> PlacedComments:
    """Assign every comment to exactly one construct, or to the file."""
    placer = _CommentPlacer(tree, source, rules)
    for comment in _grouped([_Comment(token, source) for token in comments]):
        placer.put(comment)
    return placer.placed


class _CommentPlacer:
    """Assigns comments to the constructs of a tree."""

    def __init__(self, tree: Tree[Token], source: SourceText, rules: Rules) -> None:
        self.source, self.rules, self.placed = source, rules, PlacedComments()
        self.constructs: list[_Construct] = []
        self._collect(tree, None)
        self.starts = [construct.start for construct in self.constructs]

    def _collect(self, tree: Tree[Token], parent: _Construct | None) -> None:
        for child in tree.children:
            if isinstance(child, Tree):
                inner = parent
                if child.data in self.rules.places and not child.meta.empty:
                    inner = _Construct(child.meta.start_pos, child.meta.end_pos, str(child.data), parent, Notes())
                    self.constructs.append(inner)
                    self.placed.by_construct[_key(child)] = inner.notes
                self._collect(child, inner)

    def put(self, comment: _Comment) -> None:
        if comment.has_controls:
            what = self.rules.repairs["lenient_control"]
            self.placed.diagnostics.append(codes.REPAIRED.at(self.source.span(comment.start, comment.end), what=what))
        if not comment.lines:
            return
        source = self.source
        before, around, after = self._neighbours(comment)
        follows = before is not None and source.line(before.end) == comment.first and not comment.is_alone
        touching = before is not None and follows and source.text[before.end : comment.start].strip() in ("", ";")
        precedes = after is not None and comment.precedes_code and source.line(after.start) == comment.last
        inline = precedes and not touching
        if before is not None and follows and not inline:
            if source.line(before.start) != comment.first and source.text[before.end - 1] == "}":
                before.notes.foot += comment.as_head()
            else:
                self._at_end(comment, before)
        elif around is not None and before is None and not comment.is_alone and not inline:
            self._at_end(comment, around)
        elif after is not None:
            first = before is None and around is None
            self._above(comment, after, self.placed.around if first else after.notes, before is not None)
        else:
            _below(comment, around.notes if around else self.placed.around)

    def _neighbours(self, comment: _Comment) -> tuple[_Construct | None, _Construct | None, _Construct | None]:
        """Return the last construct before a comment, the construct that contains the comment, and the next one in
        that."""
        index = bisect.bisect_left(self.starts, comment.start)
        before: _Construct | None = None
        around = self.constructs[index - 1] if index else None
        while around is not None and around.end <= comment.start:
            before, around = around, around.parent
        after = self.constructs[index] if index < len(self.constructs) else None
        if after is not None and around is not None and after.start >= around.end:
            after = None
        return before, around, after

    def _above(self, comment: _Comment, target: _Construct, notes: Notes, not_first: bool) -> None:
        """Add a comment above a construct. Plain comments go to `notes`: the construct's, or at the top of the file,
        the file's."""
        if comment.doc and not comment.is_trailing and self.rules.places[target.rule] == "doc":
            doc = target.notes.doc
            doc += [*([""] if doc else []), *comment.lines]
            return
        if comment.gap_before and ((notes.head and notes.head[-1]) or (not notes.head and not_first)):
            notes.head.append("")
        notes.head += comment.as_head()
        if comment.gap_after:
            notes.head.append("")

    def _at_end(self, comment: _Comment, target: _Construct) -> None:
        if comment.doc and self.rules.places[target.rule] == "doc" and not target.notes.doc:
            target.notes.doc += comment.lines
            return
        text = " ".join(line.strip() for line in comment.lines).strip()
        if text:
            target.notes.tail.append(text)


class _Comment:
    """A comment's lines without comment marks, and its position relative to code and empty lines."""

    def __init__(self, token: Token, source: SourceText) -> None:
        text = str(token)
        self.start, self.end = token.start_pos or 0, token.end_pos or 0
        is_metadata = token.type == "METADATA"
        self.block = is_metadata or text.startswith(("/*", "<!--"))
        self.doc = bool(_DOC.match(text))
        self.is_trailing = bool(_BEHIND.match(text))
        texts = [" ".join(text.split())] if is_metadata else _block_lines(text) if self.block else [_one_line(text)]
        pairs = [escaped(line) for line in texts]
        self.lines, self.has_controls = [line for line, _ in pairs], any(bad for _, bad in pairs)
        self.first, self.last = source.line(self.start), source.line(self.end)
        self.is_alone = not source.before(self.start).strip()
        rest = source.line_text(self.last)[len(source.before(self.end)) :]
        self.precedes_code = self.block and bool(rest.strip(" \t;,"))
        self.gap_before = self.first > 1 and not source.line_text(self.first - 1).strip()
        self.gap_after = self.last < source.lines and not source.line_text(self.last + 1).strip()

    def as_head(self) -> list[str]:
        return [line or " " for line in self.lines]

    def continues_in(self, other: _Comment) -> bool:
        """Whether another comment is the next line of this one."""
        same = (self.block, self.doc, self.is_trailing) == (False, other.doc, other.is_trailing) and not other.block
        return same and self.is_alone and other.is_alone and other.first == self.last + 1


def _grouped(comments: Sequence[_Comment]) -> list[_Comment]:
    """Join comments of one line each on adjacent lines, and remove their common indentation."""
    groups: list[_Comment] = []
    for comment in comments:
        if groups and groups[-1].continues_in(comment):
            last = groups[-1]
            last.lines = last.lines + comment.lines
            last.end, last.last = comment.end, comment.last
            last.has_controls = last.has_controls or comment.has_controls
            last.gap_after = comment.gap_after
        else:
            groups.append(comment)
    for group in groups:
        if not group.block:
            group.lines = _dedented(group.lines)
    return groups


def _dedented(lines: list[str]) -> list[str]:
    margin = min((len(line) - len(line.lstrip()) for line in lines if line), default=0)
    return [line[margin:] for line in lines]


def _one_line(text: str) -> str:
    if text[0] == "#":  # further marks may be content: `#~`, `##`
        body = text[1:].removeprefix(" ")
    else:
        body = re.sub(r"^///?<?", "", text) if _DOC.match(text) else text.lstrip("/")
    indent = len(body) - len(body.lstrip())
    return (body[:indent].expandtabs(4) + body[indent:]).rstrip()


def _block_lines(text: str) -> list[str]:
    """Return the lines of a `/* */` or `<!-- -->`; none of a banner, which consists of stars."""
    is_xml = text.startswith("<!--")
    body = text[4:-3] if is_xml else re.sub(r"^\*+<?", "", re.sub(r"\*+$", "", text[1:-1]))
    lines = [line.expandtabs(4).rstrip() for line in body.split("\n")]
    lines[0] = lines[0].strip()
    rest = [line for line in lines[1:] if line.strip()]
    starred = rest and all(line.lstrip().startswith("*") for line in rest)
    if starred:
        lines[1:] = [re.sub(r"^\s*\*+ ?", "", line) for line in lines[1:]]
    if not (starred and lines[0]):
        lines[1:] = _dedented(lines[1:])
    while lines and not lines[0].strip():
        del lines[0]
    while lines and not lines[-1].strip():
        del lines[-1]
    return lines


def _below(comment: _Comment, notes: Notes) -> None:
    if comment.gap_before and notes.foot and notes.foot[-1]:
        notes.foot.append("")
    notes.foot += comment.as_head()
