"""A place in a file."""

from __future__ import annotations

import msgspec


class Span(msgspec.Struct, frozen=True, order=True):
    """From (line, column) to (end_line, end_column) of a file; lines and columns count from 1, in characters.

    The end is exclusive: a one-letter word at the start of a file is 1:1–1:2. `file` is the path as the user gave it
    (or as found from there), so that it can be opened from the user's folder.
    """

    file: str
    line: int = 1
    column: int = 1
    end_line: int = 1
    end_column: int = 1

    def holds(self, other: Span) -> bool:
        """Whether another place is this one, or lies in it."""
        first, last = (self.line, self.column), (self.end_line, self.end_column)
        start, end = (other.line, other.column), (other.end_line, other.end_column)
        return self.file == other.file and first <= start <= end <= last

    def inside(self, text: str, start: int, end: int) -> Span:
        """The place of some characters of the text that stands here, bare or in quotes; the whole place where it is
        spelled otherwise than it reads: with escapes, or on several lines."""
        spare = self.end_column - self.column - len(text)
        if self.line != self.end_line or spare not in (0, 2):
            return self
        begin = self.column + spare // 2 + start
        return Span(self.file, self.line, begin, self.line, begin + max(end - start, 1))
