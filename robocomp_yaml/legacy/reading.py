"""Read legacy files as text: byte order marks, line ends, Latin-1, and binary files."""

from __future__ import annotations

import bisect

import msgspec

from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.text import read_bytes

MAX_SOURCE = 4 << 20
"""In bytes. The largest known legacy file has 20 KiB."""


class SourceText(msgspec.Struct, eq=False):
    """A legacy file's text, with '\\n' as its only line end, and the locations in it."""

    path: str
    text: str
    _starts: list[int] = []

    def __post_init__(self) -> None:
        self._starts = [0, *(at + 1 for at, char in enumerate(self.text) if char == "\n")]

    @property
    def lines(self) -> int:
        """The number of lines. The last one counts if it is not empty."""
        return len(self._starts) - (self._starts[-1] == len(self.text))

    def line(self, at: int) -> int:
        """Return the line of a character; lines count from 1."""
        return bisect.bisect_right(self._starts, at)

    def line_text(self, number: int) -> str:
        end = self._starts[number] - 1 if number < len(self._starts) else len(self.text)
        return self.text[self._starts[number - 1] : end]

    def before(self, at: int) -> str:
        """Return the text before a character on its line."""
        return self.text[self._starts[self.line(at) - 1] : at]

    def span(self, start: int, end: int) -> Span:
        """Return the span from one character to another. It ends with the first line at the latest."""
        line = self.line(start)
        column = start - self._starts[line - 1] + 1
        line_end = self.text.find("\n", start, max(end, start + 1))
        width = max((end if line_end < 0 else line_end) - start, 1)
        return Span(self.path, line, column, line, column + width)


def read(path: str) -> tuple[SourceText | None, list[Diagnostic]]:
    """Return the text of a legacy file, with a warning where it is not UTF-8; or None and the reason."""
    data, diagnostics = read_bytes(path, MAX_SOURCE)
    if data is None:
        return None, diagnostics
    text, diagnostics = _decoded(path, data)
    source = SourceText(path, text.replace("\r\n", "\n"))
    zero = source.text.find("\0")
    if zero >= 0:
        return None, [file_codes.BINARY.at(source.span(zero, zero + 1), byte="U+0000")]
    return source, diagnostics


def _decoded(path: str, data: bytes) -> tuple[str, list[Diagnostic]]:
    try:
        return data.decode("utf-8-sig"), []
    except UnicodeDecodeError as error:
        valid = data[: error.start].decode("utf-8-sig")
        line, column = valid.count("\n") + 1, len(valid) - (valid.rfind("\n") + 1) + 1
        span = Span(path, line, column, line, column + 1)
        diagnostics = [codes.LATIN_1.at(span, byte=f"0x{data[error.start]:02X}")]
    try:
        return data.decode("cp1252"), diagnostics
    except UnicodeDecodeError:  # the five bytes that cp1252 does not define
        return data.decode("latin-1"), diagnostics
