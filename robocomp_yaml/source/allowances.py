"""Comments that suppress a diagnostic in their own line or in the next one: `# rcyaml: allow RC1234 -- reason`."""

from __future__ import annotations

import re
from collections.abc import Collection

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix, Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Node, Scalar, below, pairs_below

_BEGIN = r"#[ \t]*(?:rcyaml[ \t]*:|(?i:rcyaml[ \t]*:?[ \t]*allow\b))"
OURS = re.compile(_BEGIN.encode())
"""A document that does not match has no such comment."""

_COMMENT = pattern(rf"(?:(?<=[ \t])|(?<![^\r\n])){_BEGIN}[^\r\n]*")
_PARTS = pattern(
    r"#[ \t]*(?i:rcyaml)(?P<colon>[ \t]*:)?[ \t]*(?P<verb>\w*)(?P<codes>.*?)(?:(?<=[ \t])--(?P<reason>.*))?"
)
_WORD = pattern(r"[^\s,]+")
_CODE = pattern(r"(?i:RC\d{4})|[A-Z]{2,}\d{3,4}")
GUESSED = "guessed"
"""`migrate` marks its guesses for readers with `# rcyaml: guessed`. This comment suppresses nothing."""
_FORM = "write `# rcyaml: allow RC1234 -- reason`"
_EMPTY_LINE = pattern(r"[ \t]*(?:#.*|---[ \t]*(?:#.*)?|%.*)?")


class Allowance(msgspec.Struct, frozen=True):
    """A code that a comment suppresses from line `first` to line `last`. `span` is the code's location, `whole` that of
    the comment; `others`: the comment names further codes."""

    code: str
    span: Span
    first: int
    last: int
    whole: Span
    others: bool = False

    def covers(self, location: Span) -> bool:
        return self.first <= location.line <= self.last

    def removal(self, text: DocumentText) -> Fix:
        """The fix that removes the code, or the whole comment if it names no other code."""
        span = self.span if self.others else self.whole
        start, end = (text.index(span.line, at) for at in (span.column, span.end_column))
        if not self.others:
            start = len(text.text[:start].rstrip(" \t"))
            line_end = re.compile(r"\r\n|\r|\n|\Z").match(text.text, end)
            if line_end and (start == 0 or text.text[start - 1] in "\r\n"):  # the comment has a line of its own
                end = line_end.end()
        elif gap := re.compile(r"[ \t]*,[ \t]*|[ \t]+(?!--)").match(text.text, end):
            end = gap.end()
        else:  # the last code
            start = len(text.text[:start].rstrip(" \t,"))
        return Fix("remove it", (text.edit(start, end, ""),))


def allowances(
    text: DocumentText, more: Collection[str] = (), *, whole: bool = True
) -> tuple[list[Allowance], list[Diagnostic]]:
    """The codes that the comments of a document suppress, and diagnostics about the comments; none if the document is
    not YAML. `more` are the codes of plug-ins; `whole`: no other codes exist, so that unknown codes are reported."""
    allowed: list[Allowance] = []
    diagnostics: list[Diagnostic] = []
    if text.tree is None:
        return allowed, diagnostics
    keys = (key for key, _ in pairs_below(text.tree))
    texts = [node for node in (*below(text.tree), *keys) if _is_long(node)]
    for comment in _COMMENT.finditer(text.text):
        if any(node.start <= comment.start() < node.end for node in texts if isinstance(node, Scalar)):
            continue
        if re.fullmatch(rf"#[ \t]*rcyaml[ \t]*:[ \t]*{GUESSED}\s*", comment[0]):
            continue
        made, wrong = _read(text, comment, more)
        first, last = _lines(text, comment, texts)
        if not whole:
            wrong = [one for one in wrong if one.code != codes.ALLOW_UNKNOWN.id]
        allowed += [
            Allowance(word, span, first, last, text.span(*comment.span()), len(made) > 1) for word, span in made
        ]
        diagnostics += wrong
    return allowed, diagnostics


def _read(
    text: DocumentText, comment: re.Match[str], more: Collection[str]
) -> tuple[list[tuple[str, Span]], list[Diagnostic]]:
    """The codes that a comment names, with their locations, and diagnostics about the comment."""
    whole = text.span(*comment.span())
    parts = _PARTS.fullmatch(comment[0].rstrip())
    assert parts is not None  # each of its parts may be empty
    diagnostics: list[Diagnostic] = []
    if parts["colon"] is None:
        at = comment.start() + parts.start("verb")
        colon = text.edit(comment.start() + comment[0].lower().index("rcyaml") + len("rcyaml"), at, ": ")
        diagnostics.append(
            codes.ALLOW_MALFORMED.at(
                whole,
                problem="a ':' is missing after `rcyaml`",
                hint=_FORM,
                fixes=[Fix("insert it", (colon,), True)],
            )
        )
    if parts["verb"].lower() != "allow":
        verb = text.span(comment.start() + parts.start("verb"), comment.start() + parts.end("verb"))
        hint = Hint(_FORM, parts["verb"], "allow") if _CODE.search(parts["codes"]) and parts["verb"] else _FORM
        fixes = [Fix("write 'allow'", (Edit(verb, "allow"),))] if isinstance(hint, Hint) else []
        problem = "this comment contains no instruction after `rcyaml:`"
        if parts["verb"]:
            problem = f"unknown comment `rcyaml: {parts['verb']}`"
        return [], [*diagnostics, codes.ALLOW_MALFORMED.at(whole, problem=problem, hint=_FORM, fixes=fixes)]
    made: list[tuple[str, Span]] = []
    for word in _WORD.finditer(parts["codes"]):
        place = [comment.start() + parts.start("codes") + at for at in word.span()]
        if _CODE.fullmatch(word[0]) is None and word[0].upper() not in more:
            before = Fix("insert -- before it", (text.edit(place[0], place[0], "-- "),), True)
            diagnostics.append(
                codes.ALLOW_MALFORMED.at(
                    text.span(*place),
                    problem=f"'{word[0]}' is not a code",
                    hint="write the reason after `--`",
                    fixes=[before] if made and parts["reason"] is None else [],
                )
            )
            return (made if parts["colon"] else []), diagnostics
        if word[0].upper() not in table() and word[0].upper() not in more:
            span = text.span(*place)
            diagnostics.append(codes.ALLOW_UNKNOWN.at(span, name=word[0], hint="`rcyaml explain` lists all codes"))
        elif parts["colon"]:
            made.append((word[0].upper(), text.span(*place)))
    if not made and not diagnostics:
        diagnostics.append(codes.ALLOW_MALFORMED.at(whole, problem="this comment allows no code", hint=_FORM))
    elif made and not (parts["reason"] or "").strip():
        listed = ", ".join(code for code, _ in made)
        diagnostics.append(codes.ALLOW_NO_REASON.at(whole, codes=listed, hint="write it after `--`"))
    return made, diagnostics


def _lines(text: DocumentText, comment: re.Match[str], texts: list[Node]) -> tuple[int, int]:
    """The first and last line that a comment applies to: its own line, or the next one, extended by the texts and
    brackets that begin there. A comment at the top of a document also applies to line 1, the location of diagnostics
    about the whole document."""
    lines = text.lines
    here = text.span(*comment.span()).line
    line, first = here, here
    if not lines[here - 1].partition("#")[0].strip():
        while line < len(lines) and _EMPTY_LINE.fullmatch(lines[line - 1]):
            line += 1
        is_head = all(_EMPTY_LINE.fullmatch(each) for each in lines[: here - 1])
        first = 1 if is_head else here
    last = max((_last_line(node) for node in texts if node.span.line == line), default=line)
    ending = [node.span.line for node in texts if isinstance(node, Scalar) and _last_line(node) == here]
    first = min(ending, default=first)
    return first, max(line, last)


def _last_line(node: Node) -> int:
    """The last line of a node; the span of a block scalar ends at the start of the next line."""
    span = node.span
    return span.end_line - 1 if span.end_column == 1 and span.end_line > span.line else span.end_line


def _is_long(node: Node) -> bool:
    """Whether several lines of the node count as one: those of a text, or of brackets."""
    return (isinstance(node, Scalar) or bool(getattr(node, "is_flow", False))) and node.span.line < node.span.end_line
