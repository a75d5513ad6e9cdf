# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Plain values as texts in properties, rows and command lines.

The run times of other languages read the same texts: `true`, `True`, `TRUE`, `1` and their opposites; whole numbers in
decimal; numbers as C's `strtod` reads them, without infinities.
"""

from __future__ import annotations

import re
from math import isfinite
from typing import Union

BLANKS = " \t"
TRUTHS = {
    "true": True, "True": True, "TRUE": True, "1": True, "false": False, "False": False, "FALSE": False, "0": False,
}  # fmt: skip
_WHOLE = r"[-+]?[0-9]{1,40}(?:\.0*)?\Z"
_NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\Z"

Value = Union[bool, int, float, str]


def truth(text: str) -> bool | None:
    return TRUTHS.get(text.strip(BLANKS))


def whole(text: str) -> int | None:
    bare = text.strip(BLANKS)
    return int(bare.partition(".")[0]) if re.match(_WHOLE, bare) else None


def number(text: str) -> float | None:
    bare = text.strip(BLANKS)
    return float(bare) if re.match(_NUMBER, bare) and isfinite(float(bare)) else None


_READERS = {"bool": truth, "int": whole, "long": whole, "float": number, "double": number}


def read(type_: str, text: str) -> Value | None:
    """The value that a text spells, by the name of its type; None if it spells none. Every text is a value of a type
    that is neither a number nor `bool`."""
    reader = _READERS.get(type_)
    return text if reader is None else reader(text)


def spelled(value: object) -> str:
    """The text of a plain value that no document spells."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def count(text: str, most: int) -> int | None:
    """The number of elements that a text sets; None if it is not a count, or is more than `most`."""
    found = int(text) if is_digits(text) and len(text) < 10 else None
    return None if found is None or found > most else found


def is_digits(text: str) -> bool:
    """Whether a text is a number without a sign, in ASCII."""
    return text.isascii() and text.isdigit()


def unquoted(value: str) -> str:
    """A value without its double quotes, which TOML requires and Ice does not know. A value with more quotes is
    unchanged."""
    is_quoted = len(value) > 1 and value[0] == value[-1] == '"' and '"' not in value[1:-1]
    return value[1:-1] if is_quoted else value
