"""Debian's module of Ice, for an rcyaml in an environment of its own, as pipx makes it.

Such an environment has no packages of the system, and Ice is a package of the system for most people: pip compiles it
for minutes. A module that was compiled for this very Python can be loaded from there.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec, PathFinder
from types import ModuleType

FOLDER = "/usr/lib/python3/dist-packages"
_MODULES = {"Glacier2", "Ice", "IceBox", "IceGrid", "IceMX", "IcePatch2", "IcePy", "IceStorm"}


class _Finder:
    """Finds Ice's modules, and no others, after all other finders."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> ModuleSpec | None:
        if name not in _MODULES or not _fits():
            return None
        return PathFinder.find_spec(name, [FOLDER], target)


def _fits() -> bool:
    """Whether Debian's Ice was compiled for this Python. One without a version in its name may be for any."""
    return any(os.path.exists(os.path.join(FOLDER, f"IcePy{suffix}")) for suffix in EXTENSION_SUFFIXES if "-" in suffix)


def offer() -> None:
    """Lets this process import Debian's Ice if it has no other."""
    if _Finder not in sys.meta_path:
        sys.meta_path.append(_Finder)
