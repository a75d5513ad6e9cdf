"""How Ice 3.7 writes numbers with a fraction into generated code, and which of them it changes."""

from __future__ import annotations

import struct

LARGEST_INTEGER = 2**63  # the first number above Slice's integer literals


def as_float32(number: float) -> float:
    """The nearest number of 32 bits. Raises OverflowError if the number is too large for 32 bits."""
    rounded: float = struct.unpack("<f", struct.pack("<f", number))[0]
    return rounded


def is_integer_literal(number: float) -> bool:
    """Whether a number can be written as an integer literal of Slice, which Ice does not round."""
    return abs(number) < LARGEST_INTEGER and float(number).is_integer()


def printed(number: float) -> str:
    """The text that Ice 3.7 writes into generated code for a literal with a point or an exponent: six digits."""
    return f"{number:g}"


def compiles(number: float, type_name: str) -> bool:
    """Whether the C++ for a number compiles: Ice adds `.0F` to a float without a point, and `1e-07.0F` is not C++."""
    return type_name != "float" or "." in printed(number) or "e" not in printed(number)


def arrives(number: float, type_name: str) -> bool:
    """Whether the six digits that Ice writes are exactly the number."""
    if type_name == "float":
        return as_float32(float(printed(number))) == as_float32(number)
    return float(printed(number)) == number
