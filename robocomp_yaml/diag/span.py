"""A location with an end."""

from __future__ import annotations

import msgspec


class Span(msgspec.Struct, frozen=True, order=True):
    """From (line, column) to (end_line, end_column) of a file; lines and columns count from 1, in characters.

    The end is exclusive: a one-letter word at the start of a file is 1:1–1:2. `file` is the path as written by the
    user, or a path below it, so that it can be opened from the working folder.
    """

    file: str
    line: int = 1
    column: int = 1
    end_line: int = 1
    end_column: int = 1

    def holds(self, other: Span) -> bool:
        """Whether the other span is equal to this one, or inside of it."""
        first, last = (self.line, self.column), (self.end_line, self.end_column)
        start, end = (other.line, other.column), (other.end_line, other.end_column)
        return self.file == other.file and first <= start <= end <= last

    def inside(self, text: str, start: int, end: int) -> Span:
        """The span of the characters text[start:end] of a text at this span, with or without quotes; this span if the
        text is written with escapes, or on several lines."""
        spare = self.end_column - self.column - len(text)
        if self.line != self.end_line or spare not in (0, 2):
            return self
        begin = self.column + spare // 2 + start
        return Span(self.file, self.line, begin, self.line, begin + max(end - start, 1))
