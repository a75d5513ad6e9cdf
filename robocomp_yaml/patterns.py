"""Regular expressions that are compiled when they are first used.

Compiling one takes some 0.1 ms. A run on a few documents takes 100 ms, and uses few of the patterns for secrets, fixes
and pages of diagnostics.
"""

from __future__ import annotations

import re
from typing import Any, AnyStr, cast


class _LazyPattern:
    def __init__(self, text: Any, flags: int) -> None:
        self._arguments = text, flags

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        attribute = getattr(re.compile(*self._arguments), name)
        setattr(self, name, attribute)
        return attribute


def pattern(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """As `re.compile`, but raises `re.error` only when the pattern is first used."""
    return cast("re.Pattern[AnyStr]", _LazyPattern(text, flags))
