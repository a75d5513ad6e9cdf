"""Detect rows and lists in texts, and their separators."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from robocomp_yaml.semantics.rows import split
from robocomp_yaml.semantics.texts import BLANKS

_NO_ROW = re.compile(r"""[\[\](){}"';]|://""")
_NO_LIST = re.compile(r"""[\[\](){}"']|://""")
_PATH_WITH_BLANK = re.compile(r"/[^,;]*[^\s,;]\s+[^\s,;]|[^\s,;]\s+[^\s,;]*/")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\Z")
_WHOLE = re.compile(r"[-+]?\d+\Z")


def are_rows(texts: Sequence[str]) -> bool:
    """Whether all texts are rows of columns, and not numbers with a decimal comma."""
    if not texts or any("," not in text or _NO_ROW.search(text) for text in texts):
        return False
    return not all(len(row) == 2 and all(map(_WHOLE.match, row)) for row in (split(text, ",") for text in texts))


def could_be_list(text: str) -> bool:
    """Whether a text can be a list: only the last part may be missing, and no part looks like something else."""
    if _NO_LIST.search(text) or _PATH_WITH_BLANK.search(text) or text != text.strip(BLANKS):
        return False
    return all(part.strip(BLANKS) for part in re.split("[,;]", re.sub(r"[;,]\Z", "", text)))


def is_list(text: str) -> bool:
    """Whether a text is certainly a list. A text with one comma may be a number or an address."""
    if not could_be_list(text):
        return False
    if ";" in text:
        return True
    parts = split(text, ",")
    if len(parts) == 2:
        return all(parts) and not any(_NUMBER.match(part) for part in parts)
    return len(parts) > 2


def separators(texts: Iterable[str]) -> tuple[str, ...]:
    """Return the separators of a list, the outermost first, from its texts in several files."""
    listed = list(texts)
    outer = any(";" in text for text in listed)
    inner = any("," in text for text in listed)
    return (";", ",") if outer and inner else (";",) if outer else (",",)


def joiner(texts: Iterable[str], separator: str) -> str:
    """Return a separator with or without a blank behind it, as most of the texts have it."""
    found = Counter(part.startswith(" ") for text in texts for part in text.split(separator)[1:] if part.strip(BLANKS))
    return f"{separator} " if found[True] > found[False] else separator


def squeezed(text: str, separators: Iterable[str]) -> str:
    """Return a text without blanks around its separators."""
    for separator in separators:
        bare = separator.strip(BLANKS)
        first, *rest = text.split(bare)
        inner = [part.strip(BLANKS) for part in rest[:-1]]
        text = bare.join([first.rstrip(BLANKS), *inner, rest[-1].lstrip(BLANKS)]) if rest else text
    return text
