"""XML text: elements with attributes, one a line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
_IMPOSSIBLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TABLE = str.maketrans(_ESCAPES)


def escaped(text: str) -> str:
    """A text as XML's, in an attribute or an element; what XML cannot hold becomes U+FFFD."""
    return _IMPOSSIBLE.sub("\ufffd", text).translate(_TABLE)


def element(name: str, attributes: Mapping[str, str], children: Iterable[str] = (), text: str = "") -> list[str]:
    """The lines of an element; `children` are lines of their own."""
    inside = "".join(f' {key}="{escaped(value)}"' for key, value in attributes.items())
    below = [f"  {line}" for line in children]
    if text:
        return [f"<{name}{inside}>{escaped(text)}</{name}>"]
    return [f"<{name}{inside}>", *below, f"</{name}>"] if below else [f"<{name}{inside}/>"]
