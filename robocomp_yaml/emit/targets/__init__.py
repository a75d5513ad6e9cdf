"""One module a target: that of a language is called as the language, and has `plan(component) -> [FilePlan]`."""

from __future__ import annotations

import importlib
from types import ModuleType


def target(language: str) -> ModuleType:
    """The target that emits components in a language; only this one is imported."""
    return importlib.import_module(f"{__name__}.{language}")
