"""Diagnostics for people: the message, the line, and the hint.

error[RC2003]: component SpeechComp requires interface 'Mouht', which no imported module defines
  ┌─ components/speech/speech.cdsl.yaml:7:12
7 │ requires: [Mouht]
  │            ^^^^^ did you mean 'Mouth' (interfaces/Mouth.idsl.yaml)?
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from robocomp_yaml.diag.diagnostic import ERROR, NOTE, WARNING, Diagnostic
from robocomp_yaml.diag.hidden import hide, parts
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import Shown, columns, line, paint, shown
from robocomp_yaml.secrets import Part, parts_of_lines

WIDEST = 160  # characters; a longer line is shortened around the fault
MOST_READ = 1 << 25  # bytes of a file that are read to show a line of it
_CODE = (
    ".py", ".cpp", ".cc", ".h", ".hpp", ".ice", ".cmake", ".scxml", ".ui", "idsl.yaml", "cdsl.yaml", "pdsl.yaml",
    ".idsl", ".cdsl", ".smdsl", ".jcdsl",
)  # fmt: skip
_COLORS = {ERROR: "31", WARNING: "33", NOTE: "36"}


def render(
    diagnostics: Sequence[Diagnostic], documents: int | None, color: bool, texts: Mapping[str, str] | None = None
) -> list[Shown]:
    """The lines of each diagnostic, and a last line with their numbers, unless `documents` is None."""
    rendered = [one for lines in each(diagnostics, color, texts) for one in (*lines, Shown())]
    return rendered[:-1] if documents is None else [*rendered, _summary(diagnostics, documents, color)]


def each(
    diagnostics: Sequence[Diagnostic], color: bool, texts: Mapping[str, str] | None = None
) -> list[list[Shown]]:  # fmt: skip
    """The lines of each diagnostic, with the line of the document at its location. `texts` are those of locations that
    are in no file."""
    lines = _Lines(texts or {})
    return [_one(diagnostic, lines, color) for diagnostic in diagnostics]


def _summary(diagnostics: Sequence[Diagnostic], documents: int, color: bool) -> Shown:
    counts = [
        paint(f"{n} {severity}{'' if n == 1 else 's'}", _COLORS[severity], color)
        for severity in _COLORS
        if (n := sum(d.severity == severity for d in diagnostics))
    ]
    head = f"{documents} document{'' if documents == 1 else 's'}: "
    return line(head, Shown(", ".join(counts)) if counts else "nothing wrong")


def _one(diagnostic: Diagnostic, lines: _Lines, color: bool) -> list[Shown]:
    tint = _COLORS[diagnostic.severity]
    head = paint(f"{diagnostic.severity}[{diagnostic.code}]", f"1;{tint}", color)
    out = [line(head, ": ", paint(diagnostic.message, "1", color))]
    width = len(str(diagnostic.span.line))
    hidden = diagnostic.hidden
    out += _snippet(diagnostic.span, diagnostic.hint, width, tint, lines, color, hidden)
    for related in diagnostic.related:
        width = len(str(related.span.line))
        out += _snippet(related.span, related.message, width, _COLORS[NOTE], lines, color, hidden)
    more = diagnostic.more.split("\n") if diagnostic.more else []
    return out + [shown(f"    {one}" if one else "", tabs=True) for one in more]


def _snippet(
    span: Span, label: str, width: int, tint: str, lines: _Lines, color: bool, hidden: tuple[Span, ...] | None
) -> list[Shown]:
    pad = " " * width
    rail, corner = paint("│", "34", color), paint("┌─", "34", color)
    text = lines.get(span.file, span.line)
    if text is None:  # a folder, or an unreadable file
        out = [line(pad, " ", corner, " ", span.file)]
        return [*out, line(pad, " ", paint("=", "34", color), " ", label)] if label else out
    start = span.column - 1
    end = span.end_column - 1 if span.end_line == span.line else len(text.rstrip())
    if hidden is None:
        secret = lines.secrets(span)
    else:
        secret = parts(span.line, len(text), (place for place in hidden if place.file == span.file))
    text, start, end = hide(text, secret, start, max(start + 1, min(end, len(text))))
    text, start, end = _cut(text, start, end)
    marks = paint("^" * max(1, columns(_visible(text[start:end]))), f"1;{tint}", color)
    return [
        line(pad, " ", corner, " ", span.file, f":{span.line}:{span.column}"),
        line(paint(str(span.line).rjust(width), "34", color), " ", rail, " ", _visible(text)),
        line(pad, " ", rail, " " * (columns(_visible(text[:start])) + 1), marks, f" {label}" if label else ""),
    ]


def _cut(text: str, start: int, end: int) -> tuple[str, int, int]:
    """The part of a long line around the fault, and the start and end of the fault in it."""
    if len(text) <= WIDEST:
        return text, start, end
    first = max(0, min(start - WIDEST // 4, len(text) - WIDEST))
    head = "…" if first else ""
    piece = text[first : first + WIDEST]
    tail = "…" if first + WIDEST < len(text) else ""
    shift = first - len(head)
    return head + piece + tail, start - shift, min(end - shift, len(head) + len(piece))


def _visible(text: str) -> Shown:
    """A part of a document's line, with tabs as blanks, so that the marks below have the same width."""
    return shown(text.replace("\t", "    "))


class _Lines:
    """The lines of the files in which diagnostics are located; each file is read once. `texts` are read as files."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._files: dict[str, list[str] | None] = {file: _split(text) for file, text in texts.items()}
        self._secrets: dict[str, dict[int, list[Part]]] = {}

    def get(self, file: str, line: int) -> str | None:
        if file not in self._files:
            self._files[file] = _read(file)
        lines = self._files[file]
        return lines[line - 1] if lines and line <= len(lines) else None

    def secrets(self, span: Span) -> list[Part]:
        """The parts of a line that are secret by their names. In code and in types, names do not indicate secrets."""
        if span.file.endswith(_CODE):
            return []
        if span.file not in self._secrets:
            self._secrets[span.file] = parts_of_lines(self._files[span.file] or [])
        return self._secrets[span.file].get(span.line - 1, [])


def _read(file: str) -> list[str] | None:
    """The lines of a file, or of its beginning; None if it cannot be read, or is not a regular file, such as a pipe."""
    if not os.path.isfile(file):
        return None
    try:
        with open(file, "rb") as opened:
            text = opened.read(MOST_READ).decode("utf-8-sig", errors="replace")
    except OSError:
        return None
    return _split(text)


def _split(text: str) -> list[str]:
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
