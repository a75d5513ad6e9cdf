"""Patterns that are compiled when they are first asked for something.

To compile one takes `re` some tenth of a millisecond. Most runs meet little of what patterns are for (secrets, fixes,
pages of diagnostics), and a run on a few documents takes a hundred.
"""

from __future__ import annotations

import re
from typing import Any, AnyStr, cast


class _Later:
    def __init__(self, text: Any, flags: int) -> None:
        self._given = text, flags

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        found = getattr(re.compile(*self._given), name)
        setattr(self, name, found)
        return found


def pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """As `re.compile`; what is wrong with the text shows when it is first asked for something."""
    return cast("re.Pattern[AnyStr]", _Later(text, flags))
