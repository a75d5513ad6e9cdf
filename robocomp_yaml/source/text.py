"""Reads a file as text, or reports why that is not possible."""

from __future__ import annotations

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.regular import whole

MAX_DOCUMENT = 16 << 20
MAX_SCALAR = 1 << 20

# The non-printable characters of YAML 1.2 (5.1): C0 except tab and line ends, DEL, C1 except NEL, surrogates, the byte
# order mark inside of a text, and the two non-characters. To compile the whole pattern takes as long as reading a small
# document; most are ASCII.
_CONTROL_OF_ASCII = "\x00-\x08\x0b\x0c\x0e-\x1f\x7f"
_ASCII_CONTROL = pattern(f"[{_CONTROL_OF_ASCII}]")
_CONTROL = pattern(f"[{_CONTROL_OF_ASCII}-\x84\x86-\x9f\ud800-\udfff\ufeff\ufffe\uffff]")

OF_NO_LINE = pattern("[\x00-\x1f\x7f-\x9f\u2028\u2029]")
"""Not allowed in a text of one line, as in the schemas: control characters, and all characters that end a line."""


def encoded(text: str) -> bytes:
    """The bytes of an unsaved text. Half a surrogate pair, which no file can have, is then an error of the document."""
    return text.encode("utf-8", "surrogatepass")


def size_in_words(size: int) -> str:
    return f"{size / (1 << 20):.1f} MiB" if size >= 1 << 20 else f"{size / 1024:.1f} KiB"


def position(text: str, index: int) -> tuple[int, int]:
    """Line and column (both from 1) of the character at an index of the text."""
    return text.count("\n", 0, index) + 1, index - (text.rfind("\n", 0, index) + 1) + 1


def _at(path: str, text: str, index: int) -> Span:
    line, column = position(text, index)
    return Span(path, line, column, line, column + 1)


def decode(path: str, raw: bytes) -> tuple[str | None, list[Diagnostic]]:
    """The text of UTF-8 bytes, without byte order mark; None, with diagnostics, if they are not text."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = raw[: error.start].decode("utf-8-sig")
        return None, [
            codes.NOT_UTF8.at(
                _at(path, before, len(before)), byte=f"0x{raw[error.start]:02X}", hint="save the file as UTF-8"
            )
        ]
    control = (_ASCII_CONTROL if text.isascii() else _CONTROL).search(text)
    if control:
        return None, [codes.BINARY.at(_at(path, text, control.start()), byte=f"U+{ord(control[0]):04X}")]
    return text, []


def read_bytes(path: str, limit: int = MAX_DOCUMENT) -> tuple[bytes | None, list[Diagnostic]]:
    """The content of a file of at most `limit` bytes; None, with diagnostics, if it cannot be read. Pipes and devices
    are not read, because they may block or be endless."""
    try:
        raw, status = whole(path, limit=limit)
        size = max(status.st_size, len(raw))
        if size > limit:
            is_, allowed = size_in_words(size), size_in_words(limit)
            return None, [codes.TOO_LARGE.at(Span(path), what="the file", size=is_, limit=allowed)]
        return raw, []
    except OSError as error:
        return None, [codes.UNREADABLE.at(Span(path), reason=reason_of(error))]
