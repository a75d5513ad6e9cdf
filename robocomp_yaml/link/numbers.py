"""What becomes of numbers with a fraction on their way through Ice."""

from __future__ import annotations

import struct

LARGEST_INTEGER = 2**63  # and above: Slice's integer literals end here


def as_float32(number: float) -> float:
    """The nearest number of 32 bits. Raises OverflowError where there is none."""
    rounded: float = struct.unpack("<f", struct.pack("<f", number))[0]
    return rounded


def is_integer_literal(number: float) -> bool:
    """Whether a number can be written as an integer of Slice, which arrives whole."""
    return abs(number) < LARGEST_INTEGER and float(number).is_integer()


def printed(number: float) -> str:
    """How Ice 3.7 writes the value of a literal with a point or an exponent into the code that it generates."""
    return f"{number:g}"


def compiles(number: float, type_name: str) -> bool:
    """Ice puts `.0F` behind a float without a point, and `1e-07.0F` is no C++."""
    return type_name != "float" or "." in printed(number) or "e" not in printed(number)


def arrives(number: float, type_name: str) -> bool:
    """Whether the six digits that Ice writes are enough to tell the number."""
    if type_name == "float":
        return as_float32(float(printed(number))) == as_float32(number)
    return float(printed(number)) == number
