"""XML text: elements with attributes, one a line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from robocomp_yaml.emit.exports._unwritable import Unwritable

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
_IMPOSSIBLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_STARTS = (
    "A-Z_a-z\xc0-\xd6\xd8-\xf6\xf8-\u02ff\u0370-\u037d\u037f-\u1fff\u200c\u200d\u2070-\u218f\u2c00-\u2fef"
    "\u3001-\ud7ff\uf900-\ufdcf\ufdf0-\ufffd\U00010000-\U000effff"
)
_NAME = re.compile(f"[{_STARTS}][{_STARTS}0-9.:\xb7\u0300-\u036f\u203f\u2040-]*\\Z")
_TABLE = str.maketrans(_ESCAPES)


def escaped(text: str) -> str:
    """A text as XML's, in an attribute or an element. Raises Unwritable for what XML cannot hold."""
    found = _IMPOSSIBLE.search(text)
    if found:
        raise Unwritable(f"XML cannot hold U+{ord(found[0]):04X}")
    return text.translate(_TABLE)


def element(name: str, attributes: Mapping[str, str], children: Iterable[str] = (), text: str = "") -> list[str]:
    """The lines of an element; `children` are lines of their own. Raises Unwritable."""
    for each in (name, *attributes):
        if not _NAME.match(each):
            raise Unwritable(f"'{each}' cannot be the name of an element or attribute of XML")
    inside = "".join(f' {key}="{escaped(value)}"' for key, value in attributes.items())
    below = [f"  {line}" for line in children]
    if text:
        return [f"<{name}{inside}>{escaped(text)}</{name}>"]
    return [f"<{name}{inside}>", *below, f"</{name}>"] if below else [f"<{name}{inside}/>"]
