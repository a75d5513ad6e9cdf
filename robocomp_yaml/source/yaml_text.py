"""Writes data as YAML text that rcyaml reads as the same data: scalars, comments, and flow collections."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from robocomp_yaml.patterns import pattern

_PLAIN = pattern(r"(?:[A-Za-z_/]|\.\.?/)[A-Za-z0-9_./ -]*[A-Za-z0-9_./-]\Z|[A-Za-z_/]\Z")
_UNREADABLE = pattern("[\x00-\x1f\x7f-\x9f\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff]")
_NOT_TEXT = frozenset(("true", "false", "null", "yes", "no", "on", "off", "y", "n"))

# Plain scalars that are not text: null, booleans, numbers (also those with leading zeros, which rcyaml rejects).
_READ_OTHERWISE = pattern(
    r"""(?: ~ | null | Null | NULL | true | True | TRUE | false | False | FALSE | <<
        | [-+]?[0-9]+ | 0x[0-9a-fA-F]+ | 0o[0-7]+
        | [-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?
        | [-+]?\.(?:inf|Inf|INF) | \.(?:nan|NaN|NAN) )""",
    re.VERBOSE,
)
_BAD_START = pattern(r"[-?:](?:\s|$)|[,\[\]{}#&*!|>'\"%@`]|---|\.\.\.|\s")
_BAD_INSIDE = pattern(r":(?:\s|$)|\s\#|\s$|[\t\n\r]")
_BAD_IN_FLOW = pattern(r"[,\[\]{}:?]")  # libyaml refuses a colon and a question mark
_UNPRINTABLE = pattern("[\x00-\x08\x0a-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")


def scalar(data: Any) -> str:
    """A plain value; a text is quoted unless every YAML parser reads it as the same text without quotes."""
    if data is None:
        return "null"
    if isinstance(data, bool):
        return "true" if data else "false"
    if not isinstance(data, str):
        return _number(data)
    return data if _PLAIN.match(data) and data.lower() not in _NOT_TEXT else quoted(data)


def _number(data: int | float) -> str:
    text = repr(data)
    return text if text[-1].isdigit() else {"inf": ".inf", "-inf": "-.inf", "nan": ".nan"}.get(text, text)


def quoted(text: str) -> str:
    """A text in double quotes, with JSON's escapes; DEL and the C1 controls are escaped, too, as YAML requires."""
    written = json.dumps(text, ensure_ascii=False)
    return written if written.isprintable() else _UNREADABLE.sub(_escape, written)


def single_quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'" if text.isprintable() else quoted(text)


def _escape(match: re.Match[str]) -> str:
    return {"\n": "\\n", "\t": "\\t"}.get(match[0], f"\\u{ord(match[0]):04x}")


def text_of(text: str, *, in_flow: bool = False) -> str:
    """A text, in quotes only if it would otherwise be read as another value, or be a syntax error. `in_flow`: it is
    inside of `[]` or `{}`."""
    if is_plain(text, in_flow=in_flow):
        return text
    return single_quoted(text) if "'" not in text and re.search(r'["\\]', text) else quoted(text)


def is_plain(text: str, *, in_flow: bool) -> bool:
    """Whether a text without quotes is read as this text."""
    if text.isascii() and text.isidentifier() and text.lower() not in _NOT_TEXT:
        return True  # most texts are names, and need no pattern
    bad = not text or _READ_OTHERWISE.fullmatch(text) or _BAD_START.match(text) or _BAD_INSIDE.search(text)
    return not (bad or _is_unprintable(text) or (in_flow and _BAD_IN_FLOW.search(text)))


def is_printable(text: str) -> bool:
    """Whether a text of several lines can be written as a block scalar."""
    return not _is_unprintable(text.replace("\n", ""))


def _is_unprintable(text: str) -> bool:
    return not text.isprintable() and _UNPRINTABLE.search(text) is not None  # the pattern accepts more: U+00A0


def comment(text: str) -> str:
    """A text as a comment of one line, with line ends and unprintable characters escaped."""
    return f"# {_UNREADABLE.sub(_escape, text)}".rstrip()


def escaped(text: str) -> tuple[str, bool]:
    """A line of a comment with unprintable characters escaped, and whether it had any."""
    return _UNPRINTABLE.subn(_code, text)[0], bool(_UNPRINTABLE.search(text))


def _code(match: re.Match[str]) -> str:
    code = ord(match[0])
    return f"\\x{code:02X}" if code < 0x100 else f"\\u{code:04X}"


def flow(data: Any) -> str:
    """Any data, as flow collections."""
    if isinstance(data, dict):
        return "{" + ", ".join(f"{scalar(key)}: {flow(value)}" for key, value in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(flow(item) for item in data) + "]"
    return scalar(data)


def block(data: Any, width: int = 100) -> str:
    """Any data as a document in block style. What fits into a line, and lists of plain values, are flow collections."""
    return "".join(f"{one}\n" for one in _lines(data, "", width))


def _lines(data: Any, indent: str, width: int) -> Iterator[str]:
    items = data.items() if isinstance(data, dict) else ((None, item) for item in data) if _is_long(data, width) else ()
    if not isinstance(data, dict) and not _is_long(data, width):
        yield from _wrapped(data, indent, width)
    elif not data:
        yield f"{indent}{flow(data)}"
    for key, value in items:
        head = f"{indent}-" if key is None else f"{indent}{scalar(key)}:"
        text = flow(value)
        if len(head) + len(text) < width or not isinstance(value, (dict, list)):
            yield f"{head} {text}"
        elif key is None:  # the first line follows the dash
            inner = list(_lines(value, f"{indent}  ", width))
            yield f"{head} {inner[0].lstrip()}"
            yield from inner[1:]
        else:
            yield head
            yield from _lines(value, f"{indent}  ", width)


def _is_long(data: Any, width: int) -> bool:
    """Whether a list is written with a line for each item."""
    return isinstance(data, list) and any(isinstance(item, (dict, list)) for item in data) and len(flow(data)) > width


def _wrapped(data: Any, indent: str, width: int) -> Iterator[str]:
    """A plain value, or a list as a flow collection on several lines."""
    if not isinstance(data, list):
        yield f"{indent}{scalar(data)}"
        return
    line = f"{indent}["
    for number, item in enumerate(data):
        text = flow(item) + (", " if number + 1 < len(data) else "")
        if len(line) + len(text) > width and len(line) > len(indent) + 1:
            yield line.rstrip()
            line = f"{indent} "
        line += text
    yield f"{line}]"
