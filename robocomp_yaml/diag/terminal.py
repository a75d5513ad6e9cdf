r"""Where text meets a terminal: no other module writes to the standard streams.

*Words* are for people: messages, tables, logs. They are said line by line, and what stands in a line is not trusted,
since documents, names of files, logs and answers of other hosts speak in it: whatever would command the terminal, or be
invisible there, is shown escaped (`\e[31m`, `\n`, `\u202e`; of names that are no UTF-8, the bytes: `\xff`). Only
`paint` makes text that is coloured.

*Data* is for programs: configurations, graphs, schemas, JSON. It goes into a file or a pipe byte for byte; a terminal
gets it escaped, where it is JSON as JSON escapes.
"""

from __future__ import annotations

import re
import sys
import unicodedata
from collections.abc import Iterable
from functools import cache
from typing import TextIO

from robocomp_yaml.patterns import pattern

# Controls, formats (Cf), separators of lines, halves of surrogate pairs, what is no character, and fillers that nobody
# sees.
_HARMFUL = (
    "[\x00-\x1f\x7f-\x9f\xad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890\u0891\u08e2\u115f\u1160\u17b4\u17b5\u180e"
    "\u200b-\u200f\u2028-\u202e\u2060-\u206f\u3164\ud800-\udfff\ufdd0-\ufdef\ufeff\uffa0\ufff9-\ufffb\ufffe\uffff"
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e007f"
    + "".join(f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000))
    + "]"
)
_LETTERS = {"\a": r"\a", "\b": r"\b", "\t": r"\t", "\n": r"\n", "\v": r"\v", "\f": r"\f", "\r": r"\r", "\x1b": r"\e"}
_DIFF_TINTS = {"+": "32", "-": "31", "@": "36"}
_PLAIN = pattern(r"[\w@%+=:,./-]+")  # what no shell looks into


@cache
def _harmful() -> re.Pattern[str]:
    """Compiled where a text is not plain ASCII: that takes a millisecond."""
    return re.compile(_HARMFUL)


class Shown(str):
    """Text of one line that a terminal may be given as it is."""

    __slots__ = ()


def shown(text: str, *, tabs: bool = False) -> Shown:
    """A line as it may be shown; with `tabs`, these stay."""
    if isinstance(text, Shown):
        return text
    if text.isascii() and text.isprintable():
        return Shown(text)
    return Shown(_harmful().sub(_kept_tabs if tabs else _escape, text))


def line(*parts: str, tabs: bool = False) -> Shown:
    """A line of several parts, of which those that are shown already stay so."""
    return Shown("".join(shown(part, tabs=tabs) for part in parts))


def paint(text: str, tint: str, color: bool = True) -> Shown:
    """Text in a colour of our own (`31` is red, `1;31` bold red), if `color`."""
    return Shown(f"\x1b[{tint}m{shown(text)}\x1b[0m") if color else shown(text)


def columns(text: str) -> int:
    """How wide a terminal shows a line that has no colour."""
    text = shown(text)
    if text.isascii():
        return len(text)
    return sum(0 if unicodedata.combining(c) else 2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)


def pad(text: str, width: int, *, right: bool = False) -> Shown:
    """A cell of a table; `right` puts the text at its end."""
    blanks = " " * (width - columns(text))
    return Shown(blanks + shown(text) if right else shown(text) + blanks)


def cut(text: str, width: int) -> Shown:
    """A line without colours, shortened to so many columns."""
    text = shown(text)
    if columns(text) <= width:
        return text
    while text and columns(text) >= width:
        text = Shown(text[:-1])
    return Shown(text + "…")


def typed(*words: str) -> str:
    """A command as a shell takes it: words that a shell would look into are quoted."""
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
    """Prints a text of our own that has several lines, such as an explanation."""
    _write(sys.stderr if err else sys.stdout, (shown(one, tabs=True) for one in text.splitlines()))


def take_away(lines: int) -> None:
    """Takes back the last lines that a terminal was given."""
    sys.stdout.write(f"\x1b[{lines}A\x1b[J")
    sys.stdout.flush()


def diff(texts: Iterable[str], color: bool) -> None:
    """Prints unified diffs: data, for `patch`; with colours they are for a terminal in the end, whatever they go to."""
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
    """Text as a file has it; names that are no UTF-8 as the bytes that they are."""
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return text.encode("utf-8", "backslashreplace")


def _write(stream: TextIO, lines: Iterable[str]) -> None:
    stream.write("".join(f"{shown(one)}\n" for one in lines))
    stream.flush()


def _escape(found: re.Match[str]) -> str:
    c = found[0]
    if c in _LETTERS:
        return _LETTERS[c]
    code = ord(c)
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code < 0x80:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _kept_tabs(found: re.Match[str]) -> str:
    return "\t" if found[0] == "\t" else _escape(found)


def _kept_lines(found: re.Match[str]) -> str:
    return found[0] if found[0] in "\t\n" else _escape(found)


def _escape_json(found: re.Match[str]) -> str:
    c = found[0]
    if c == "\n":  # between its values: within, it is escaped already
        return c
    units = c.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[n]:02x}{units[n + 1]:02x}" for n in range(0, len(units), 2))
