"""Things of one kind by their names, such as exports: a module each, which is imported when it is asked for."""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType

import msgspec


class Modules(msgspec.Struct, frozen=True):
    """Those in a package, `what` one of them is called; a module with an underscore at first is none."""

    package: str
    what: str

    def table(self) -> dict[str, str]:
        """The module of each."""
        path = importlib.import_module(self.package).__path__
        names = sorted(module.name for module in pkgutil.iter_modules(path) if not module.name.startswith("_"))
        return {name: f"{self.package}.{name}" for name in names}

    def load(self, name: str) -> ModuleType:
        """Raises ValueError where there is none."""
        modules = self.table()
        if name not in modules:
            raise ValueError(f"there is no {self.what} '{name}'")
        return importlib.import_module(modules[name])


def member(path: str) -> object:
    """What `package.module:name` leads to."""
    module, _, name = path.partition(":")
    return getattr(importlib.import_module(module), name)
