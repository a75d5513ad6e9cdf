"""Data as YAML text on one line, so that our reader gives the same data back."""

from __future__ import annotations

import json
import re
from typing import Any

_PLAIN = re.compile(r"(?:[A-Za-z_/]|\.\.?/)[A-Za-z0-9_./ -]*[A-Za-z0-9_./-]\Z|[A-Za-z_/]\Z")
_UNREADABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff]")
_NOT_TEXT = frozenset(("true", "false", "null", "yes", "no", "on", "off", "y", "n"))


def scalar(data: Any) -> str:
    """A plain value; text in quotes unless nothing could take it for anything else."""
    if data is None:
        return "null"
    if isinstance(data, bool):
        return "true" if data else "false"
    if not isinstance(data, str):
        return _number(data)
    return data if _PLAIN.match(data) and data.lower() not in _NOT_TEXT else quoted(data)


def _number(data: int | float) -> str:
    text = repr(data)
    return {"inf": ".inf", "-inf": "-.inf", "nan": ".nan"}.get(text, text)


def quoted(text: str) -> str:
    """In double quotes. JSON's escapes are YAML's, but for DEL and the C1 controls, which YAML cannot hold bare."""
    return _UNREADABLE.sub(_escape, json.dumps(text, ensure_ascii=False))


def comment(text: str) -> str:
    """Text as a comment of one line can hold it."""
    return f"# {_UNREADABLE.sub(_escape, text)}".rstrip()


def _escape(found: re.Match[str]) -> str:
    return {"\n": "\\n", "\t": "\\t"}.get(found[0], f"\\u{ord(found[0]):04x}")


def single_quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'" if text.isprintable() else quoted(text)


def flow(data: Any) -> str:
    """Any data, as flow collections."""
    if isinstance(data, dict):
        return "{" + ", ".join(f"{scalar(key)}: {flow(value)}" for key, value in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(flow(item) for item in data) + "]"
    return scalar(data)
