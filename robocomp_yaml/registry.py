"""Things of one kind by their names, such as exports: a module each, which is imported when it is asked for."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterable, Mapping
from types import ModuleType
from typing import Any

import msgspec


def module_names(folders: Iterable[str], *, packages: bool = False) -> list[str]:
    """The modules in the folders of a package (its `__path__`), or the packages there, sorted; those with an underscore
    at first are nobody's business. `pkgutil` asks every loader how files may be called: that takes longer than to
    import some of them."""
    found = set()
    for folder in folders:
        for name in os.listdir(folder):
            stem, dot, end = name.partition(".")
            if stem.isidentifier() and not stem.startswith("_"):
                is_package = not dot and os.path.isfile(os.path.join(folder, name, "__init__.py"))
                if is_package or (end == "py" and not packages):
                    found.add(stem)
    return sorted(found)


class Modules(msgspec.Struct, frozen=True):
    """Those in a package, `what` one of them is called; a module with an underscore at first is none."""

    package: str
    what: str

    def table(self) -> dict[str, str]:
        """The module of each."""
        names = module_names(importlib.import_module(self.package).__path__)
        return {name: f"{self.package}.{name}" for name in names}

    def every(self) -> list[ModuleType]:
        """All of them, in the order of their names."""
        return [importlib.import_module(path) for path in self.table().values()]

    def load(self, name: str) -> ModuleType:
        """Raises ValueError where there is none."""
        modules = self.table()
        if name not in modules:
            raise ValueError(f"there is no {self.what} '{name}'")
        return importlib.import_module(modules[name])


def lazy_attributes(module: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """A module's `__getattr__`: its names, each with the module that defines it, are imported when they are first
    asked for."""
    home_of = {name: home for home, names in homes.items() for name in names.split()}

    def attribute(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module '{module}' has no attribute '{name}'")
        return import_member(f"robocomp_yaml.{home_of[name]}:{name}")

    return attribute


def import_member(path: str) -> object:
    """What `package.module:name` leads to."""
    module, _, name = path.partition(":")
    return getattr(importlib.import_module(module), name)
