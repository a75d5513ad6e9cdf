r"""Writes to the standard streams; no other module does.

*Messages* are for people: diagnostics, tables, logs. They are written line by line. Their content is not trusted,
because it comes from documents, file names, logs and other hosts: characters that control the terminal, or are
invisible, are escaped (`\e[31m`, `\n`, `\u202e`; the bytes of names that are not UTF-8: `\xff`). Only `paint` adds
colours.

*Data* is for programs: configurations, graphs, schemas, JSON. It is written to a file or a pipe byte for byte; on a
terminal it is escaped, in JSON with JSON's escapes.
"""

from __future__ import annotations

import re
import sys
import unicodedata
from collections.abc import Collection, Iterable, Sequence
from functools import cache
from typing import TextIO

from robocomp_yaml.patterns import pattern

# Control characters, formats (Cf), line separators, surrogates, non-characters, and invisible fillers.
_HARMFUL = (
    "[\x00-\x1f\x7f-\x9f\xad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890\u0891\u08e2\u115f\u1160\u17b4\u17b5\u180e"
    "\u200b-\u200f\u2028-\u202e\u2060-\u206f\u3164\ud800-\udfff\ufdd0-\ufdef\ufeff\uffa0\ufff9-\ufffb\ufffe\uffff"
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e007f"
    + "".join(f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000))
    + "]"
)
_LETTERS = {"\a": r"\a", "\b": r"\b", "\t": r"\t", "\n": r"\n", "\v": r"\v", "\f": r"\f", "\r": r"\r", "\x1b": r"\e"}
_DIFF_TINTS = {"+": "32", "-": "31", "@": "36"}
_PLAIN = pattern(r"[\w@%+=:,./-]+")  # has no meaning to a shell


@cache
def _harmful() -> re.Pattern[str]:
    """Compiled only for texts that are not plain ASCII, because that takes a millisecond."""
    return re.compile(_HARMFUL)


class Shown(str):
    """Text of one line that is safe to write to a terminal."""

    __slots__ = ()


def shown(text: str, *, tabs: bool = False) -> Shown:
    """A line with unsafe characters escaped; `tabs` keeps tabs."""
    if isinstance(text, Shown):
        return text
    if text.isascii() and text.isprintable():
        return Shown(text)
    return Shown(_harmful().sub(_kept_tabs if tabs else _escape, text))


def line(*parts: str, tabs: bool = False) -> Shown:
    """A line of several parts; parts that are already Shown are not escaped again."""
    return Shown("".join(shown(part, tabs=tabs) for part in parts))


def paint(text: str, tint: str, color: bool = True) -> Shown:
    """Text in a colour, as an SGR code (`31` is red, `1;31` bold red), if `color`."""
    return Shown(f"\x1b[{tint}m{shown(text)}\x1b[0m") if color else shown(text)


def columns(text: str) -> int:
    """The width of a line without colours on a terminal, in columns."""
    text = shown(text)
    if text.isascii():
        return len(text)
    return sum(0 if unicodedata.combining(c) else 2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)


def pad(text: str, width: int, *, right: bool = False) -> Shown:
    """A cell of a table, `width` columns wide; `right` aligns the text right."""
    blanks = " " * (width - columns(text))
    return Shown(blanks + shown(text) if right else shown(text) + blanks)


def cut(text: str, width: int) -> Shown:
    """A line without colours, shortened to `width` columns."""
    text = shown(text)
    if columns(text) <= width:
        return text
    while text and columns(text) >= width:
        text = Shown(text[:-1])
    return Shown(text + "…")


def table(rows: Sequence[Sequence[str]], right: Collection[int] = ()) -> list[Shown]:
    """The lines of a table, each column as wide as its widest cell; the columns with the numbers `right` are aligned
    right."""
    widths = [max(map(columns, cells)) for cells in zip(*rows, strict=True)]
    numbered = [list(enumerate(zip(row, widths, strict=True))) for row in rows]
    return [
        Shown("  ".join(pad(*cell, right=number in right) for number, cell in cells).rstrip()) for cells in numbered
    ]


def typed(*words: str) -> str:
    """A command as a user types it in a shell: words with special characters are quoted."""
    return " ".join(_quoted(word) for word in words)


def _quoted(word: str) -> str:
    if _PLAIN.fullmatch(word):
        return word
    if _harmful().search(word):
        inner = _harmful().sub(_escape, re.sub(r"(['\\])", r"\\\1", word))
        return f"$'{inner}'"
    return "'" + word.replace("'", "'\"'\"'") + "'"


def say(*lines: str, err: bool = False) -> None:
    """Prints lines for people, on standard error if `err`."""
    _write(sys.stderr if err else sys.stdout, lines)


def say_text(text: str, *, err: bool = False) -> None:
    """Prints a text of several lines, such as an explanation; line ends and tabs stay."""
    _write(sys.stderr if err else sys.stdout, (shown(one, tabs=True) for one in text.splitlines()))


def erase(lines: int) -> None:
    """Erases the last lines on the terminal."""
    sys.stdout.write(f"\x1b[{lines}A\x1b[J")
    sys.stdout.flush()


def enter_screen() -> None:
    """Switches the terminal to a screen of our own, without a cursor; what it showed before comes back with `leave`."""
    sys.stdout.write("\x1b[?1049h\x1b[?25l\x1b[2J")
    sys.stdout.flush()


def leave_screen() -> None:
    sys.stdout.write("\x1b[?25h\x1b[?1049l")
    sys.stdout.flush()


def draw_screen(lines: Iterable[str]) -> None:
    """Draws the whole screen: lines that fit it. Each is erased before it is written, so that nothing flickers."""
    sys.stdout.write("\x1b[H" + "\r\n".join(f"\x1b[K{shown(one)}" for one in lines) + "\x1b[J")
    sys.stdout.flush()


def diff(texts: Iterable[str], color: bool) -> None:
    """Prints unified diffs: as data, for `patch`, or, with colours, as lines for people."""
    for text in texts:
        if not color:
            data(text)
            continue
        for one in text.split("\n")[:-1]:
            tint = _DIFF_TINTS.get(one[:1], "")
            say(paint(shown(one, tabs=True), tint, bool(tint)))


def data(text: str, *, json: bool = False, err: bool = False) -> None:
    """Prints data, on standard error if `err`."""
    out = sys.stderr if err else sys.stdout
    if out.isatty():
        out.write(_harmful().sub(_escape_json if json else _kept_lines, text))
        out.flush()
    elif (buffer := getattr(out, "buffer", None)) is None:
        out.write(text)
    else:
        out.flush()
        buffer.write(as_bytes(text))
        buffer.flush()


def as_bytes(text: str) -> bytes:
    """Text as UTF-8; names that are not UTF-8 as their original bytes."""
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return text.encode("utf-8", "backslashreplace")


def _write(stream: TextIO, lines: Iterable[str]) -> None:
    stream.write("".join(f"{shown(one)}\n" for one in lines))
    stream.flush()


def _escape(match: re.Match[str]) -> str:
    c = match[0]
    if c in _LETTERS:
        return _LETTERS[c]
    code = ord(c)
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code < 0x80:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _kept_tabs(match: re.Match[str]) -> str:
    return "\t" if match[0] == "\t" else _escape(match)


def _kept_lines(match: re.Match[str]) -> str:
    return match[0] if match[0] in "\t\n" else _escape(match)


def _escape_json(match: re.Match[str]) -> str:
    c = match[0]
    if c == "\n":  # between values; inside of them it is already escaped
        return c
    units = c.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[n]:02x}{units[n + 1]:02x}" for n in range(0, len(units), 2))
