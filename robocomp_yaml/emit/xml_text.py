"""XML text: elements with attributes, each on its own line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from robocomp_yaml.emit.exports._unwritable import note

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
IMPOSSIBLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_STARTS = (
    "A-Z_a-z\xc0-\xd6\xd8-\xf6\xf8-\u02ff\u0370-\u037d\u037f-\u1fff\u200c\u200d\u2070-\u218f\u2c00-\u2fef"
    "\u3001-\ud7ff\uf900-\ufdcf\ufdf0-\ufffd\U00010000-\U000effff"
)
# Without the colon: it would name a prefix, which nothing declares (https://www.w3.org/TR/xml-names/#NT-NCName).
_GOES_ON = f"{_STARTS}0-9.\xb7\u0300-\u036f\u203f\u2040-"
_NAME = re.compile(f"[{_STARTS}][{_GOES_ON}]*\\Z")
_NO_NAME = re.compile(f"[^{_GOES_ON}]+")
_TABLE = str.maketrans(_ESCAPES)


def escaped(text: str) -> str:
    """A text, escaped for an attribute or an element. Illegal characters become U+FFFD, which is noted."""
    return IMPOSSIBLE.sub(_replaced, text).translate(_TABLE)


def _replaced(match: re.Match[str]) -> str:
    note(f"XML cannot contain U+{ord(match[0]):04X}, which becomes U+FFFD")
    return "\ufffd"


def _name(text: str) -> str:
    """A text as name of an element or attribute; illegal characters become `_`, which is noted."""
    if _NAME.match(text):
        return text
    name = _NO_NAME.sub("_", text)
    name = name if _NAME.match(name) else f"_{name}"
    note(f"'{text}' is not a legal name of an XML element or attribute, and becomes {name}")
    return name


def comment(lines: Iterable[str]) -> list[str]:
    """The lines of a comment, without empty lines at its ends; `--`, which is illegal in comments, is split."""
    kept = [line.replace("--", "- -").replace("--", "- -").rstrip() for line in lines]
    text = "\n".join(kept).strip("\n").split("\n")
    if len(text) > 1:
        return ["<!--", *(f"  {line}".rstrip() for line in text), "-->"]
    return [f"<!-- {text[0].strip()} -->"] if text[0] else []


def element(name: str, attributes: Mapping[str, str], children: Iterable[str] = (), text: str = "") -> list[str]:
    """The lines of an element; `children` are the lines of the elements in it."""
    name, named = _name(name), {_name(key): value for key, value in attributes.items()}
    inside = "".join(f' {key}="{escaped(value)}"' for key, value in named.items())
    below = [f"  {line}" if line else "" for line in children]
    if text:
        return [f"<{name}{inside}>{escaped(text)}</{name}>"]
    return [f"<{name}{inside}>", *below, f"</{name}>"] if below else [f"<{name}{inside}/>"]
