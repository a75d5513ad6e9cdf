"""Texts that a document shall give back exactly: numbers as numbers where they are spelled as they would be again."""

from __future__ import annotations

import re

from robocomp_yaml.legacy.document import Raw

_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]{0,15})(?:\.[0-9]{1,17})?")


def exact(text: str) -> str | Raw:
    """`-58.4646681749` is a number, `1e3` and `0.50` are texts."""
    if not _NUMBER.fullmatch(text):
        return text
    return Raw(text) if spelled(float(text) if "." in text else int(text)) == text else text


def spelled(value: object) -> str:
    """The text that `exact` was given, of the value that was read back."""
    return repr(value) if isinstance(value, float | int) and not isinstance(value, bool) else str(value)
