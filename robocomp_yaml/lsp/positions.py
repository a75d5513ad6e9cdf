"""Positions of the protocol. It counts lines and columns from 0, and columns in the units of an encoding: of UTF-16
unless the client and the server agree on UTF-8 or UTF-32. Our columns are characters."""

from __future__ import annotations

import re

from lsprotocol import types

from robocomp_yaml.diag.span import Span

UTF8, UTF16, UTF32 = "utf-8", "utf-16", "utf-32"
_LINE_END = re.compile("\r\n|\r|\n")


class TextLines:
    """The lines of a text, as the protocol and YAML count them."""

    def __init__(self, text: str, encoding: str) -> None:
        self._lines, self._encoding = _LINE_END.split(text), encoding

    def range(self, span: Span) -> types.Range:
        return types.Range(self.position(span.line, span.column), self.position(span.end_line, span.end_column))

    def position(self, line: int, column: int) -> types.Position:
        """The position of a line and column, which both count from 1. A position behind the text is its end."""
        if line > len(self._lines):
            return types.Position(len(self._lines) - 1, self._units(self._lines[-1]))
        return types.Position(line - 1, self._units(self._lines[line - 1][: column - 1]))

    def place(self, position: types.Position) -> tuple[int, int]:
        """The line and column (from 1) of a position of the protocol."""
        if position.line >= len(self._lines):
            return len(self._lines), len(self._lines[-1]) + 1
        text, units = self._lines[position.line], 0
        for column, character in enumerate(text, 1):
            if units >= position.character:
                return position.line + 1, column
            units += self._units(character)
        return position.line + 1, len(text) + 1

    def line(self, number: int) -> str:
        """The text of a line, which counts from 1."""
        return self._lines[number - 1] if number <= len(self._lines) else ""

    def end(self) -> types.Position:
        return self.position(len(self._lines) + 1, 1)

    def _units(self, text: str) -> int:
        if text.isascii() or self._encoding == UTF32:
            return len(text)
        if self._encoding == UTF8:
            return len(text.encode("utf-8", "surrogatepass"))
        return len(text) + sum(character > "\uffff" for character in text)
