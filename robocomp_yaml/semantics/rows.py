# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Several values in one property: rows of columns, and lists between separators.

What is split is stripped of blanks, as legacy files indent their rows; so a part cannot start or end with one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Optional

from .texts import BLANKS

Row = Optional[dict[str, str]]


def split(text: str, separator: str) -> list[str]:
    """The parts of a text; a separator of blanks stands for any run of them."""
    bare = separator.strip(BLANKS)
    return [part.strip(BLANKS) for part in text.split(bare)] if bare else text.split()


def nested(text: str, separators: Sequence[str], levels: int, trailing: bool) -> Any:
    """Nested lists of texts: `levels` separators are used; the outermost one may stand once more at the end."""
    if not levels:
        return text
    bare = separators[0].strip(BLANKS)
    if trailing and text.rstrip(BLANKS).endswith(bare):
        text = text.rstrip(BLANKS)[: -len(bare) or None]
        if not text:
            return [] if levels == 1 else [[]]
    elif not text:
        return []
    return [nested(part, separators[1:], levels - 1, False) for part in split(text, separators[0])]


def joined(texts: Any, separators: Sequence[str], trailing: bool) -> str:
    """The text of nested lists of texts; the outermost separator stands once more at the end where it trails."""
    if isinstance(texts, str):
        return texts
    text = separators[0].join(joined(part, separators[1:], False) for part in texts)
    return text + separators[0] if trailing and texts else text


def row(
    text: str,
    separator: str,
    columns: Sequence[str],
    is_optional: Callable[[str], bool],
    is_text: Callable[[str], bool],
) -> Row:
    """The texts of a row by column; a column that is empty, and is no text, has no value. Optional columns at the end
    may be left out. None where the columns do not add up."""
    parts = split(text, separator)
    if len(parts) > len(columns) or not all(map(is_optional, columns[len(parts) :])):
        return None
    pairs = zip(columns, parts)
    return {name: part for name, part in pairs if part or (is_text(name) and not is_optional(name))}
