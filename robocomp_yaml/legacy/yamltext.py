"""Texts as YAML scalars: plain where YAML 1.2's core schema and libyaml read them back as the same text."""

from __future__ import annotations

import re

# What a plain scalar must not look like: null, booleans, numbers (also those with leading zeros, which we refuse).
_NO_TEXT = re.compile(
    r"""(?: ~ | null | Null | NULL | true | True | TRUE | false | False | FALSE | <<
        | [-+]?[0-9]+ | 0x[0-9a-fA-F]+ | 0o[0-7]+
        | [-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?
        | [-+]?\.(?:inf|Inf|INF) | \.(?:nan|NaN|NAN) )""",
    re.VERBOSE,
)
_BAD_START = re.compile(r"[-?:](?:\s|$)|[,\[\]{}#&*!|>'\"%@`]|---|\.\.\.|\s")
_BAD_INSIDE = re.compile(r":(?:\s|$)|\s\#|\s$|[\t\n\r]")
_BAD_IN_FLOW = re.compile(r"[,\[\]{}:?]|^-")
_UNPRINTABLE = re.compile("[^\x09\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]")
_ESCAPES = {"\n": "\\n", "\t": "\\t", "\r": "\\r", '"': '\\"', "\\": "\\\\"}


def scalar(text: str, flow: bool = False) -> str:
    """A text on one line: plain, or in quotes where it has to be. `flow`: it stands inside of `[]` or `{}`."""
    bad = not text or _NO_TEXT.fullmatch(text) or _BAD_START.match(text) or _BAD_INSIDE.search(text)
    if bad or _UNPRINTABLE.search(text) or (flow and _BAD_IN_FLOW.search(text)):
        return _quoted(text)
    return text


def escaped(text: str) -> tuple[str, bool]:
    """A comment's text with unprintable characters as escapes, and whether there were any."""
    return _UNPRINTABLE.subn(_escape, text)[0], bool(_UNPRINTABLE.search(text))


def is_printable(text: str) -> bool:
    """Whether a text of several lines can stand in a block scalar."""
    return not _UNPRINTABLE.search(text.replace("\n", ""))


def _quoted(text: str) -> str:
    if _UNPRINTABLE.search(text) or "\t" in text or ("'" in text or not re.search(r'["\\]', text)):
        body = re.sub(r'["\\\n\t\r]', lambda found: _ESCAPES[found[0]], text)
        return '"' + _UNPRINTABLE.sub(_escape, body) + '"'
    return f"'{text}'"


def _escape(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\x{code:02X}" if code < 0x100 else f"\\u{code:04X}"
