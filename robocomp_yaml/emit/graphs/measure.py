"""The width of text, with the widths of Helvetica, which Arial and Liberation Sans share, and room for other fonts."""

from __future__ import annotations

from functools import lru_cache

# The widths of the characters from the blank to '~', in thousandths of the font size.
_WIDTHS = (
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
)  # fmt: skip
_OTHER = 1000
_BOLD = 1.08
_ROOM = 1.12
"""A factor for other fonts, which may be wider."""


@lru_cache(maxsize=4096)
def width(text: str, size: float, bold: bool = False) -> float:
    """The width of a text in pixels, for a font size in pixels."""
    units = sum(_WIDTHS[ord(char) - 32] if " " <= char <= "~" else _OTHER for char in text)
    return units * size * _ROOM * (_BOLD if bold else 1) / 1000


def shortened(text: str, size: float, limit: float, bold: bool = False) -> str:
    """The text; if it is wider than `limit` pixels, without its middle, because similar names differ at their ends."""
    if width(text, size, bold) <= limit:
        return text
    keep = len(text) - 1
    while keep > 2 and width(f"{text[: (keep + 1) // 2]}…{text[len(text) - keep // 2 :]}", size, bold) > limit:
        keep -= 1
    return f"{text[: (keep + 1) // 2]}…{text[len(text) - keep // 2 :]}"
