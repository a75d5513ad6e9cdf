"""Durations as documents say them: `100 ms`, `10 s`."""

from __future__ import annotations

import re

from robocomp_yaml.source.tree import Node, Scalar

_SECONDS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}
_DURATION = r"(\d+(?:\.\d*)?|\.\d+)\s*(us|ms|s|min|h)"


def seconds(node: Node | None) -> float | None:
    """The seconds of `100 ms`, `10 s`, or of a plain number, which counts milliseconds. None for any other node."""
    if not isinstance(node, Scalar) or node.data is None:
        return None
    if isinstance(node.data, (int, float)):
        return node.data / 1000
    return duration(node.lexeme)


def duration(text: str) -> float | None:
    """The seconds of `100 ms`, `10 s` or `2min`; None if the text is not a duration."""
    parts = re.fullmatch(_DURATION, text.strip())
    return float(parts[1]) * _SECONDS[parts[2]] if parts else None
