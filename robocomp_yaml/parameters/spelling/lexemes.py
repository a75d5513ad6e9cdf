"""Plain values as legacy text: how properties and command lines spell them, and how that is read.

Generated accessors read their properties by the same table: `true`, `True`, `TRUE`, `1` and their opposites; whole
numbers in decimal; numbers as C's `strtod` reads them, without infinities.
"""

from __future__ import annotations

import re
from math import isfinite

from robocomp_yaml.parameters.types import EnumType, ScalarType

TRUTHS = {
    "true": True,
    "True": True,
    "TRUE": True,
    "1": True,
    "false": False,
    "False": False,
    "FALSE": False,
    "0": False,
}
_WHOLE = r"[-+]?[0-9]{1,40}(?:\.0*)?\Z"
_NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\Z"


def read(type_: ScalarType, text: str) -> bool | int | float | str:
    """The value that a text spells. Raises ValueError where it spells none."""
    if isinstance(type_, EnumType) or type_.name == "string":
        return text
    bare = text.strip(" \t")
    if type_.name == "bool":
        if bare not in TRUTHS:
            raise ValueError(f"'{text}' is neither true nor false")
        return TRUTHS[bare]
    if type_.is_integer:
        if not re.match(_WHOLE, bare):
            raise ValueError(f"'{text}' is no whole number")
        return int(bare.partition(".")[0])
    if not re.match(_NUMBER, bare) or not isfinite(float(bare)):
        raise ValueError(f"'{text}' is no number")
    return float(bare)


def spelled(data: object) -> str:
    """A plain value as text, where no document spells it."""
    if isinstance(data, bool):
        return "true" if data else "false"
    return str(data)
