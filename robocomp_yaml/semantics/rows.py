# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Several values in one property: rows of columns, and lists between separators.

Blanks around each part are removed, because legacy files indent their rows. A part cannot start or end with a blank.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Optional

from .texts import BLANKS

Row = Optional[dict[str, str]]


def split(text: str, separator: str) -> list[str]:
    """The parts of a text. A separator of blanks matches any number of blanks."""
    bare = separator.strip(BLANKS)
    return [part.strip(BLANKS) for part in text.split(bare)] if bare else text.split()


def nested(text: str, separators: Sequence[str], levels: int, trailing: bool) -> Any:
    """Nested lists of texts, split by `levels` separators. `trailing`: the outermost separator may also end the
    text."""
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
    """The text of nested lists of texts. `trailing`: the outermost separator also ends the text."""
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
    """The texts of a row by column. An empty column has no value, unless it is a required text. Optional columns at the
    end may be missing. None if the number of columns is wrong."""
    parts = split(text, separator)
    if len(parts) > len(columns) or not all(map(is_optional, columns[len(parts) :])):
        return None
    pairs = zip(columns, parts)
    return {name: part for name, part in pairs if part or (is_text(name) and not is_optional(name))}
