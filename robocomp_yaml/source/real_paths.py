"""Real paths of many files in few folders."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

_APART = frozenset(("", os.curdir, os.pardir))


class RealPaths:
    """Paths without links, as `os.path.realpath` returns them. Each folder is resolved once, so that links may change
    only before `forget`. `ask` is the view of the disk: it calls a function with a path."""

    def __init__(self, ask: Callable[..., Any] = lambda function, path: function(path)) -> None:
        self._ask = ask
        self._known: dict[str, str] = {}

    def of(self, path: str) -> str:
        known = self._known.get(path)
        if known is None:
            folder, name = os.path.split(path)
            if name in _APART or self._ask(os.path.islink, path):
                known = self._ask(os.path.realpath, path)
            else:
                known = os.path.join(self.of(folder or os.curdir), name)
            self._known[path] = known
        return known

    def forget(self) -> None:
        self._known.clear()
