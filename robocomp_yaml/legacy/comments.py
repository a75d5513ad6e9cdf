"""Where each comment of a legacy file belongs: above, at the end of, or below a construct, or into its `doc:`."""

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
    """A construct that comments can belong to; `parent` is the one around it."""

    start: int
    end: int
    rule: str
    parent: _Construct | None
    notes: Notes


class PlacedComments(msgspec.Struct, frozen=True):
    """The notes of each construct, by its rule and its place, and those around the whole file."""

    by_place: dict[tuple[str, int, int], Notes] = {}
    around: Notes = msgspec.field(default_factory=Notes)
    diagnostics: list[Diagnostic] = []

    def of(self, tree: Tree[Token]) -> Notes:
        found = None if tree.meta.empty else self.by_place.get(_key(tree))
        return Notes() if found is None else found


def _key(tree: Tree[Token]) -> tuple[str, int, int]:
    meta = tree.meta
    return str(tree.data), meta.start_pos, meta.end_pos


def place(tree: Tree[Token], comments: Sequence[Token], source: SourceText, rules: Rules) -> PlacedComments:
    """Every comment ends in the notes of exactly one construct, or around the file."""
    placed = PlacedComments()
    places: list[_Construct] = []
    _collect(tree, None, rules, places, placed)
    starts = [at.start for at in places]
    for comment in _grouped([_Comment(token, source) for token in comments]):
        if comment.bad:
            placed.diagnostics.append(
                codes.REPAIRED.at(source.span(comment.start, comment.end), what=rules.repairs["lenient_control"])
            )
        if comment.lines:
            _put(comment, places, starts, placed, source, rules)
    return placed


def _collect(
    tree: Tree[Token], parent: _Construct | None, rules: Rules, places: list[_Construct], placed: PlacedComments
) -> None:
    for child in tree.children:
        if isinstance(child, Tree):
            inner = parent
            if child.data in rules.places and not child.meta.empty:
                inner = _Construct(child.meta.start_pos, child.meta.end_pos, str(child.data), parent, Notes())
                places.append(inner)
                placed.by_place[_key(child)] = inner.notes
            _collect(child, inner, rules, places, placed)


class _Comment:
    """A comment's lines without their marks, and how it stands among the lines of the file."""

    def __init__(self, token: Token, source: SourceText) -> None:
        text = str(token)
        self.start, self.end = token.start_pos or 0, token.end_pos or 0
        self.block = text.startswith(("/*", "<!--"))
        self.doc = bool(_DOC.match(text))
        self.behind = bool(_BEHIND.match(text))
        raw = _block_lines(text) if self.block else [_one_line(text)]
        told = [escaped(line) for line in raw]
        self.lines, self.bad = [line for line, _ in told], any(bad for _, bad in told)
        self.first, self.last = source.line(self.start), source.line(self.end)
        self.alone = not source.before(self.start).strip()
        self.more = self.block and bool(source.line_text(self.last)[len(source.before(self.end)) :].strip(" \t;,"))
        self.gap_before = self.first > 1 and not source.line_text(self.first - 1).strip()
        self.gap_after = self.last < source.lines and not source.line_text(self.last + 1).strip()

    def as_head(self) -> list[str]:
        return [line or " " for line in self.lines]

    def goes_on_in(self, other: _Comment) -> bool:
        """Whether another one is the next line of the same."""
        same = (self.block, self.doc, self.behind) == (False, other.doc, other.behind) and not other.block
        return same and self.alone and other.alone and other.first == self.last + 1


def _grouped(comments: Sequence[_Comment]) -> list[_Comment]:
    """Comments of one line each that stand directly below each other as one, without the indentation they share."""
    groups: list[_Comment] = []
    for comment in comments:
        if groups and groups[-1].goes_on_in(comment):
            last = groups[-1]
            last.lines = last.lines + comment.lines
            last.end, last.last, last.bad = comment.end, comment.last, last.bad or comment.bad
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
    if text[0] == "#":  # of which each may be meant: `#~`, `##`
        body = text[1:].removeprefix(" ")
    else:
        body = re.sub(r"^///?<?", "", text) if _DOC.match(text) else text.lstrip("/")
    indent = len(body) - len(body.lstrip())
    return (body[:indent].expandtabs(4) + body[indent:]).rstrip()


def _block_lines(text: str) -> list[str]:
    """The lines of a `/* */` or `<!-- -->`; none of a banner, which has nothing but stars."""
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


def _put(
    comment: _Comment,
    places: list[_Construct],
    starts: list[int],
    placed: PlacedComments,
    source: SourceText,
    rules: Rules,
) -> None:
    before, around, after = _neighbours(comment, places, starts)
    behind = before is not None and source.line(before.end) == comment.first and not comment.alone
    touching = before is not None and behind and source.text[before.end : comment.start].strip() in ("", ";")
    inline = after is not None and comment.more and source.line(after.start) == comment.last and not touching
    if before is not None and behind and not inline:
        if source.line(before.start) != comment.first and source.text[before.end - 1] == "}":
            before.notes.foot += comment.as_head()
        else:
            _at_end(comment, before, rules)
    elif around is not None and before is None and not comment.alone and not inline:
        _at_end(comment, around, rules)
    elif after is not None:
        first = before is None and around is None
        _above(comment, after, placed.around if first else after.notes, before is not None, rules)
    else:
        _below(comment, around.notes if around else placed.around)


def _neighbours(
    comment: _Comment, places: list[_Construct], starts: list[int]
) -> tuple[_Construct | None, _Construct | None, _Construct | None]:
    """The construct that ended last before a comment, the one around it, and the next one that is inside of that."""
    index = bisect.bisect_left(starts, comment.start)
    before: _Construct | None = None
    around = places[index - 1] if index else None
    while around is not None and around.end <= comment.start:
        before, around = around, around.parent
    after = places[index] if index < len(places) else None
    if after is not None and around is not None and after.start >= around.end:
        after = None
    return before, around, after


def _above(comment: _Comment, target: _Construct, notes: Notes, not_first: bool, rules: Rules) -> None:
    """`notes` take plain comments: those of the construct below, or at the top of the file, the file's."""
    if comment.doc and not comment.behind and rules.places[target.rule] == "doc":
        doc = target.notes.doc
        doc += [*([""] if doc else []), *comment.lines]
        return
    if comment.gap_before and ((notes.head and notes.head[-1]) or (not notes.head and not_first)):
        notes.head.append("")
    notes.head += comment.as_head()
    if comment.gap_after:
        notes.head.append("")


def _at_end(comment: _Comment, target: _Construct, rules: Rules) -> None:
    if comment.doc and rules.places[target.rule] == "doc" and not target.notes.doc:
        target.notes.doc += comment.lines
        return
    text = " ".join(line.strip() for line in comment.lines).strip()
    if text:
        target.notes.tail.append(text)


def _below(comment: _Comment, notes: Notes) -> None:
    if comment.gap_before and notes.foot and notes.foot[-1]:
        notes.foot.append("")
    notes.foot += comment.as_head()
