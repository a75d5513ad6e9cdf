"""What an editor makes of a snippet when the user accepts every placeholder as it is."""

from __future__ import annotations

import re

_CHOICE = re.compile(r"\$\{\d+\|([^,|]*)[^|]*\|\}")
_DEFAULT = re.compile(r"\$\{\d+:([^{}]*)\}")
_STOP = re.compile(r"\$\d+|\$\{\d+\}")
_WORD = re.compile(r"[\w.\"'-]*\Z")


def accepted(snippet: str) -> str:
    """The snippet's text with the first choice or the default of every placeholder."""
    return _STOP.sub("", _DEFAULT.sub(r"\1", _CHOICE.sub(r"\1", snippet)))


def inserted(text: str, snippet: str) -> str:
    """The text after the snippet took the place of the word before the cursor `|`, indented as the cursor's line."""
    before, _, after = text.partition("|")
    line = before[before.rfind("\n") + 1 :]
    before = _WORD.sub("", before)
    indent = " " * (len(line) - len(line.lstrip(" -")))
    return before + accepted(snippet).replace("\n", f"\n{indent}") + after
