"""Legacy files as text: byte order marks, line ends, Latin-1, and what is no text at all."""

from __future__ import annotations

import bisect

import msgspec

from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.text import read_bytes

MAX_SOURCE = 4 << 20
"""Bytes. The largest legacy file known has 20 KiB."""


class SourceText(msgspec.Struct, eq=False):
    """A legacy file's text, with '\\n' as its only line end, and places in it."""

    path: str
    text: str
    _starts: list[int] = []

    def __post_init__(self) -> None:
        self._starts = [0, *(at + 1 for at, char in enumerate(self.text) if char == "\n")]

    @property
    def lines(self) -> int:
        """How many lines there are; the last one counts if it holds anything."""
        return len(self._starts) - (self._starts[-1] == len(self.text))

    def line(self, at: int) -> int:
        """The line of a character, from 1."""
        return bisect.bisect_right(self._starts, at)

    def line_text(self, number: int) -> str:
        end = self._starts[number] - 1 if number < len(self._starts) else len(self.text)
        return self.text[self._starts[number - 1] : end]

    def before(self, at: int) -> str:
        """What stands before a character on its line."""
        return self.text[self._starts[self.line(at) - 1] : at]

    def span(self, start: int, end: int) -> Span:
        """The place from one character to another; the end is cut off at the end of the first line."""
        line = self.line(start)
        column = start - self._starts[line - 1] + 1
        stop = self.text.find("\n", start, max(end, start + 1))
        width = max((end if stop < 0 else stop) - start, 1)
        return Span(self.path, line, column, line, column + width)


def read(path: str) -> tuple[SourceText | None, list[Diagnostic]]:
    """The text of a legacy file, with a warning where it is not UTF-8; or why there is none."""
    raw, diagnostics = read_bytes(path, MAX_SOURCE)
    if raw is None:
        return None, diagnostics
    text, diagnostics = _decoded(path, raw)
    source = SourceText(path, text.replace("\r\n", "\n"))
    zero = source.text.find("\0")
    if zero >= 0:
        return None, [file_codes.BINARY.at(source.span(zero, zero + 1), byte="U+0000")]
    return source, diagnostics


def _decoded(path: str, raw: bytes) -> tuple[str, list[Diagnostic]]:
    try:
        return raw.decode("utf-8-sig"), []
    except UnicodeDecodeError as error:
        good = raw[: error.start].decode("utf-8-sig")
        line, column = good.count("\n") + 1, len(good) - (good.rfind("\n") + 1) + 1
        span = Span(path, line, column, line, column + 1)
        said = [codes.LATIN_1.at(span, byte=f"0x{raw[error.start]:02X}")]
    try:
        return raw.decode("cp1252"), said
    except UnicodeDecodeError:  # the five bytes that Windows' Latin-1 leaves open
        return raw.decode("latin-1"), said
