"""The one layout of a document: same keys, order, line breaks, comments and values; other blanks and quotes.

The text is cut into YAML's tokens (https://yaml.org/spec/1.2.2/#chapter-5-character-productions). Each is written
again, with normal blanks before it:

- Indentation is two blanks; a list below a key is indented, too.
- Within a line: `key: value`, `- item`, `{a: b, c: d}`, `[a, b]`.
- Text has quotes only where it would be read as something else without them; these are double.
- No more than one blank line, none at the beginning and the end, and no blanks at the end of lines.

What is kept: flow or block, line breaks, spelling of numbers and booleans, anchors, directives, the text of comments.
Comments behind values that stand in one column, on neighbouring lines or not, still do so afterwards.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.tokens import (
    AliasToken,
    AnchorToken,
    BlockEndToken,
    BlockEntryToken,
    BlockMappingStartToken,
    BlockSequenceStartToken,
    DirectiveToken,
    DocumentEndToken,
    DocumentStartToken,
    FlowEntryToken,
    FlowMappingEndToken,
    FlowMappingStartToken,
    FlowSequenceEndToken,
    FlowSequenceStartToken,
    KeyToken,
    ScalarToken,
    StreamEndToken,
    StreamStartToken,
    TagToken,
    ValueToken,
)

from robocomp_yaml.grouping import grouped
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import syntax
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence
from robocomp_yaml.source.yaml_text import is_plain, quoted

STEP = 2
_OPENING, _CLOSING = (FlowMappingStartToken, FlowSequenceStartToken), (FlowMappingEndToken, FlowSequenceEndToken)
_MARKERS = (DirectiveToken, DocumentStartToken, DocumentEndToken)
_HEADER = pattern(r"([|>])([-+]?)([1-9]?)([-+]?)[ \t]*(#[^\n]*)?")
_BLANKS = " \t\n"  # a no-break space is text
_ODD_BACKSLASHES = pattern(r"(?<!\\)(?:\\\\)*\\\Z")


class Unformattable(Exception):
    """The layout of a text cannot be normalized: it is broken, or has a construct that this module does not know."""


def formatted(text: str) -> str:
    """The text in the normal layout. Raises Unformattable."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    safe, back = syntax.stand_ins(text)
    try:
        return _Layout(safe, back).text().translate(back)
    except MarkedYAMLError as error:
        raise Unformattable(str(error.problem)) from None


def same_content(before: Node | None, after: Node | None) -> bool:
    """Whether two documents say the same: keys in their order, values, and how numbers and booleans are spelled."""
    todo = [(before, after)]
    while todo:
        old, new = todo.pop()
        if type(old) is not type(new):
            return False
        if isinstance(old, Mapping) and isinstance(new, Mapping):
            if list(old.entries) != list(new.entries):
                return False
            todo += zip(old.children(), new.children(), strict=True)
        elif isinstance(old, Sequence) and isinstance(new, Sequence):
            if len(old.items) != len(new.items):
                return False
            todo += zip(old.items, new.items, strict=True)
        elif isinstance(old, Scalar) and isinstance(new, Scalar):
            if old.lexeme != new.lexeme or type(old.data) is not type(new.data):
                return False
    return True


class _Block(msgspec.Struct):
    """A block collection: its columns before and after. `is_implied`: a list at the column of the key above it, which
    ends without a token of its own."""

    old: int
    new: int
    is_mapping: bool
    is_implied: bool = False


class _Line(msgspec.Struct):
    """A line of the result. `column` is that of its comment before, -1 where it has none, `gap` the blanks before it.
    `is_content`: a blank line of a text, which means something."""

    text: str
    comment: str = ""
    column: int = -1
    gap: int = 0
    is_content: bool = False


class _Layout:
    def __init__(self, source: str, back: dict[int, str]) -> None:
        self.source, self.back = source, back
        self.lines: list[_Line] = []
        self.blocks: list[_Block] = []
        self.closed: list[_Block] = []  # since the last token was written
        self.flows: list[int] = []  # the indentation of what is in each open bracket
        self.inner = -1  # that of what is in the bracket that closes
        self.end = 0  # of what has been written, in the source
        self.before: Any = None  # the token that was written last
        self.is_key = False  # whether the next token begins a key of a block mapping
        self.indent = 0  # of the current line

    def text(self) -> str:
        for token in _tokens(self.source):
            self._take(token)
        self._gap(len(self.source), 0, 0)
        while self.lines and not self.lines[-1].text and not self.lines[-1].is_content:
            self.lines.pop()
        return "".join(f"{line}\n" for line in _with_comments(self.lines))

    def _take(self, token: Any) -> None:
        match token:
            case StreamStartToken() | StreamEndToken():
                pass
            case BlockMappingStartToken() | BlockSequenceStartToken():
                self.blocks.append(_Block(token.start_mark.column, self._inner(), _is_mapping(token)))
            case BlockEndToken():
                self._end_implied()
                self.closed.append(self.blocks.pop())
            case BlockEntryToken():
                if not self.blocks or self.blocks[-1].is_mapping:
                    self.blocks.append(_Block(token.start_mark.column, self._inner(), False, True))
                self._write(token, "-", self.blocks[-1].new)
            case KeyToken() | ValueToken():
                self._key_or_value(token)
            case _ if isinstance(token, _OPENING):
                self._write(token, token_text(self.source, token), self._value_column())
                self.flows.append(max(self.indent, self.blocks[-1].new if self.blocks else 0) + STEP)
            case _ if isinstance(token, _CLOSING):
                self.inner = self.flows.pop()
                if isinstance(self.before, FlowEntryToken) and not self._is_on_new_line(token):
                    line = self.lines[-1]
                    line.text = line.text.removesuffix(",")
                    if not line.text.strip():  # the comma was alone in its line
                        line.text, self.indent = " " * (self.inner - STEP), self.inner - STEP
                self._write(token, token_text(self.source, token), self.inner - STEP)
                self.inner = -1
            case _ if isinstance(token, _MARKERS):
                self.blocks.clear()
                self._write(token, token_text(self.source, token).rstrip(_BLANKS), 0)
            case ScalarToken():
                self._scalar(token)
            case FlowEntryToken() | AliasToken() | AnchorToken() | TagToken():
                self._write(token, token_text(self.source, token), self._value_column())
            case _:
                raise Unformattable(f"{type(token).__name__} is unknown")

    def _key_or_value(self, token: Any) -> None:
        is_written = token.start_mark.index < token.end_mark.index
        if isinstance(token, KeyToken) and not self.flows:
            self._end_implied()
            self.is_key = True
        elif not self.flows and self._is_on_new_line(token):
            self._end_implied()  # `? key`, and `: value` on the next line
        if is_written:
            column = self._value_column() if self.flows else self.blocks[-1].new if self.blocks else 0
            self._write(token, token_text(self.source, token), column)

    def _end_implied(self) -> None:
        if self.blocks and self.blocks[-1].is_implied:
            self.closed.append(self.blocks.pop())

    def _inner(self) -> int:
        """The column of a block collection that begins here."""
        return self.blocks[-1].new + STEP if self.blocks else 0

    def _value_column(self) -> int:
        """The column of what begins a line here and is neither a key nor an element of a block list."""
        if self.flows:
            return self.flows[-1]
        if self.is_key:
            return self.blocks[-1].new if self.blocks else 0
        return self._inner()

    def _is_on_new_line(self, token: Any) -> bool:
        return "\n" in self.source[self.end : token.start_mark.index]

    def _write(self, token: Any, text: str, column: int) -> None:
        """Adds a token of one line: behind the last one, or at a column where it began a line before."""
        if self.before is None or self._is_on_new_line(token):
            self._gap(token.start_mark.index, token.start_mark.column, column)
            self.lines.append(_Line(" " * column + text))
            self.indent = column
        else:
            self.lines[-1].text += (" " if _is_apart(self.before, token) else "") + text
        self.end, self.before, self.is_key = token.end_mark.index, token, False
        self.closed.clear()

    def _scalar(self, token: Any) -> None:
        column = self._value_column()
        if token.style in ("|", ">"):
            self._block_scalar(token, column)
            return
        text = token_text(self.source, token).rstrip(_BLANKS)
        first, *more = (text if "\n" in text else self._requoted(token, text)).split("\n")
        if token.style == "'" and more:
            first, *more = _doubled(text).split("\n")
        inner = self.flows[-1] if self.flows else self._inner()
        self._write(token, _end_of_line(first) if more else first, column)
        for number, line in enumerate(more):
            line = line.strip(" \t") if number == len(more) - 1 else _end_of_line(line.lstrip(" \t"))
            self.lines.append(_Line(f"{' ' * inner}{line}" if line else ""))
            self.indent = inner
        self.end = token.start_mark.index + len(text)

    def _requoted(self, token: Any, text: str) -> str:
        if not token.style:
            return text
        meant = token.value.translate(self.back)
        if is_plain(meant, in_flow=bool(self.flows)) and meant.isprintable():
            return str(meant)  # invisible characters stay in quotes
        return text if token.style == '"' else quoted(meant)

    def _block_scalar(self, token: Any, column: int) -> None:
        start = token.start_mark.index
        header_end = _line_end(self.source, start)
        header = _HEADER.match(self.source[start:header_end])
        assert header is not None
        said = (self.blocks[-1].old if self.blocks else 0) + int(header[3]) if header[3] else -1
        body, self_end = _body(self.source, header_end, token.value, said, keeps="+" in header[2] + header[4])
        inner = self._inner()
        needs_digit = next((line for line in body if line), "").startswith(" ")
        digit = str(inner - (self.blocks[-1].new if self.blocks else 0)) if needs_digit else ""
        ends = header[2] or header[4]
        if body and not token.value.endswith("\n"):
            ends = "-"  # the document has no line break at its end, and gets one
        text = f"{header[1]}{digit}{ends}"
        self._write(token, text, column)
        if header[5]:
            self._comment_behind(header[5].rstrip(_BLANKS), start + header.start(5))
        self.lines += [_Line(f"{' ' * inner}{line}" if line else "", is_content=not line) for line in body]
        self.end = self_end

    def _gap(self, to: int, old: int, new: int) -> None:
        """The comments and the blank lines up to a token that begins a line, whose columns are given."""
        behind, *whole = self.source[self.end : to].split("\n")
        if self.before is None:
            whole = [behind, *whole]
        elif behind.strip(_BLANKS):
            self._comment_behind(behind.strip(_BLANKS), self.end + len(behind) - len(behind.lstrip(_BLANKS)))
        for line in whole[: None if to == len(self.source) else -1]:
            comment = line.strip(_BLANKS)
            if comment:
                column = self._comment_column(
                    len(line) - len(line.lstrip(_BLANKS)), old, new, is_last=to == len(self.source)
                )
                self.lines.append(_Line(" " * column + comment))
            elif self.lines and self.lines[-1].text:
                self.lines.append(_Line(""))

    def _comment_behind(self, comment: str, index: int) -> None:
        line = self.lines[-1]
        line.comment = comment
        line.column = index - (self.source.rfind("\n", 0, index) + 1)
        before = self.source[index - line.column : index]
        line.gap = max(1, len(before) - len(before.rstrip(" \t")))

    def _comment_column(self, column: int, old: int, new: int, *, is_last: bool) -> int:
        """The column of a comment on a line of its own: that of the token or collection that it lined up with."""
        if self.inner >= 0 or self.flows:
            return self.inner if self.inner >= 0 else self.flows[-1]
        if column == old and not is_last:
            return new
        known = [(block.old, block.new) for block in (*self.closed, *self.blocks) if block.old <= column]
        return max(known, default=(0, 0))[1]


def token_text(source: str, token: Any) -> str:
    return source[token.start_mark.index : token.end_mark.index]


def _tokens(source: str) -> Iterator[Any]:
    try:
        tokens = list(syntax.tokens(source))
    except MarkedYAMLError:
        tokens = list(syntax.tokens_as_1_2(source))
    yield from tokens


def _is_mapping(token: Any) -> bool:
    return isinstance(token, BlockMappingStartToken)


def _is_apart(before: Any, token: Any) -> bool:
    """Whether there is a blank between two tokens of one line."""
    if isinstance(before, _OPENING) or isinstance(token, (*_CLOSING, FlowEntryToken)):
        return isinstance(before, ValueToken)  # `{a: , b: }`
    if isinstance(token, ValueToken):
        return isinstance(before, (AliasToken, AnchorToken, TagToken))
    return True


def _line_end(source: str, start: int) -> int:
    end = source.find("\n", start)
    return len(source) if end < 0 else end


def _body(source: str, start: int, value: str, said: int, *, keeps: bool) -> tuple[list[str], int]:
    """The lines of a block scalar without their indentation, and where they end. `start` is the end of its header,
    `said` the column that the header gives, or -1; `keeps`: the blank lines at its end belong to it."""
    first = next((line for line in value.split("\n") if line.strip()), "")
    lines: list[str] = []
    indent, end, last = said, start, start
    while end + 1 < len(source):
        line = source[end + 1 : (line_end := _line_end(source, end + 1))]
        if line.strip(" "):
            blanks = len(line) - len(line.lstrip(" "))
            if indent < 0:
                indent = blanks - (len(first) - len(first.lstrip(" "))) if first else blanks + 1
            if blanks < indent:
                break
            lines.append(line[indent:])
            last = line_end
        else:
            lines.append(line[indent:] if 0 <= indent < len(line) else "")
            last = line_end if lines[-1] else last
        end = line_end
    if keeps:
        if lines and not lines[-1] and end == len(source) and not source.endswith("\n"):
            lines.pop()  # blanks at the end of the document are no line
        return lines, min(end, len(source))
    while lines and not lines[-1]:
        lines.pop()
    return lines, last


def _doubled(text: str) -> str:
    """A text in single quotes, in double ones."""
    inner = text[1:-1].replace("''", "'").replace("\\", "\\\\").replace('"', '\\"')
    return f'"{inner}"'


def _end_of_line(line: str) -> str:
    """A line of a scalar of several lines without the blanks at its end, but for an escaped one."""
    bare = line.rstrip(" \t")
    return line[: len(bare) + 1] if len(bare) < len(line) and _ODD_BACKSLASHES.search(bare) else bare


def _with_comments(lines: list[_Line]) -> Iterator[str]:
    """The lines with the comments behind them: those of one column before are in one column again."""
    columns = grouped((line.column, line) for line in lines if line.comment)
    for together in columns.values():
        if len(together) > 1:
            to = max(len(line.text) for line in together) + min(line.gap for line in together)
            for line in together:
                line.gap = to - len(line.text)
    for line in lines:
        yield f"{line.text}{' ' * line.gap}{line.comment}" if line.comment else line.text
