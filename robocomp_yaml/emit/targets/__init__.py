"""One module a target. A target with `LANGUAGE` emits components in that language: `plan(component) -> [FilePlan]`."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from types import ModuleType


@cache
def languages() -> dict[str, ModuleType]:
    """The component targets by the language they emit."""
    modules = (importlib.import_module(f"{__name__}.{m.name}") for m in pkgutil.iter_modules(__path__))
    return {module.LANGUAGE: module for module in modules if hasattr(module, "LANGUAGE")}
