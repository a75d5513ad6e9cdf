"""The output of compilers as diagnostics: GCC and Clang, javac, slice2cpp and slice2java.

    FILE:LINE:COLUMN: error: TEXT        FILE:LINE: error: TEXT        FILE:LINE: TEXT

The next lines may be the line of code, and marks below it that show the length. Notes belong to the diagnostic before
them.
"""

from __future__ import annotations

import os
import re
import unicodedata
from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.regular import text as text_of

_LOCATED = re.compile(
    r"(?P<file>[^\s:][^:\n]*?):(?P<line>\d+):(?:(?P<column>\d+):)? "
    r"(?:(?P<kind>(?:fatal )?error|warning|note): )?(?P<text>\S.*)"
)
_MARKS = re.compile(r"(?P<lead> +(?:\| )?)(?P<before> *)(?P<marks>~*\^~*)")
_SLICE = ".ice"
_NOTES = 3  # notes that are shown with an error: a template may cause dozens


class CompilerOutput:
    """Parses the output of a compiler, whose paths are relative to `folder`. `compiler` is its name in messages."""

    def __init__(self, folder: str, compiler: str) -> None:
        self._folder, self._compiler, self._lines = folder, compiler, dict[str, list[str]]()

    def diagnostics(self, lines: Iterable[str]) -> Iterator[Diagnostic]:
        """The diagnostics in the order of the output, each once."""
        found: dict[Diagnostic, None] = {}
        last: Diagnostic | None = None
        for line in lines:
            located = _LOCATED.fullmatch(line)
            if located and self._is_diagnostic(located):
                if located["kind"] == "note":
                    if last is not None and len(last.related) < _NOTES:
                        note = Related(located["text"], self._span(located))
                        last = replace(last, related=(*last.related, note))
                    continue
                if last is not None:
                    found[last] = None
                code = codes.WARNING_OF_COMPILER if located["kind"] == "warning" else codes.ERROR_OF_COMPILER
                last = code.at(self._span(located), tool=self._tool(located), text=located["text"])
            elif last is not None and not last.related and (marks := _MARKS.fullmatch(line)):
                last = replace(last, span=self._marked(last.span, marks))
        if last is not None:
            found[last] = None
        return iter(found)

    def _tool(self, located: re.Match[str]) -> str:
        return "the Slice compiler" if located["file"].endswith(_SLICE) else self._compiler

    def _is_diagnostic(self, located: re.Match[str]) -> bool:
        """Whether a line is a diagnostic. One without a kind is an error of a Slice compiler."""
        return bool(located["kind"]) or self._tool(located) != self._compiler

    def _span(self, located: re.Match[str]) -> Span:
        file, number = self._path(located["file"]), int(located["line"])
        column = self._character(file, number, int(located["column"])) if located["column"] else 1
        length = 1 if located["column"] else max(1, len(self._line(file, number).rstrip()))
        return Span(file, number, column, number, column + length)

    def _marked(self, span: Span, marks: re.Match[str]) -> Span:
        """The span with the length of the marks. The marks of javac also have the column."""
        if "|" not in marks["lead"]:
            column = self._character(span.file, span.line, len(marks["lead"]) + len(marks["before"]) + 1)
            return replace(span, column=column, end_column=column + len(marks["marks"]))
        return replace(span, end_column=span.column + len(marks["marks"]) - marks["marks"].index("^"))

    def _path(self, named: str) -> str:
        path = os.path.relpath(os.path.join(self._folder, named))
        return os.path.abspath(path) if path.startswith(os.pardir) else path

    def _line(self, file: str, number: int) -> str:
        if file not in self._lines:
            self._lines[file] = (text_of(file) or "").splitlines()
        lines = self._lines[file]
        return lines[number - 1] if number <= len(lines) else ""

    def _character(self, file: str, number: int, column: int) -> int:
        """The character at a column of a terminal, which is the column that GCC prints."""
        line = self._line(file, number)
        if line.isascii() and "\t" not in line:
            return column
        at = 1
        for count, character in enumerate(line, 1):
            at += 8 - (at - 1) % 8 if character == "\t" else 2 if unicodedata.east_asian_width(character) in "WF" else 1
            if at > column:
                return count
        return column
