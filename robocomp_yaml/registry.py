"""Modules and names that are imported when they are used: all modules of a package, such as `emit.exports`, or one
name."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from types import ModuleType
from typing import Any

import msgspec


def module_names(folders: Iterable[str], *, packages: bool = False) -> list[str]:
    """The names of the modules in the folders of a package (its `__path__`), or of its packages, sorted. Names that
    begin with an underscore are private, and are skipped. `pkgutil` does the same, but takes longer than importing
    some of the modules."""
    names = set()
    for folder in folders:
        for name in os.listdir(folder):
            stem, dot, end = name.partition(".")
            if stem.isidentifier() and not stem.startswith("_"):
                is_package = not dot and os.path.isfile(os.path.join(folder, name, "__init__.py"))
                if is_package or (end == "py" and not packages):
                    names.add(stem)
    return sorted(names)


class Modules(msgspec.Struct, frozen=True):
    """The public modules of a package. `what` is the word for one of them in messages."""

    package: str
    what: str

    def table(self) -> dict[str, str]:
        """The full name of each module, by its name in the package."""
        return _table(self.package)

    def every(self) -> list[ModuleType]:
        """Imports all modules, in the order of their names."""
        return [importlib.import_module(path) for path in self.table().values()]

    def load(self, name: str) -> ModuleType:
        """Imports one module. Raises ValueError if the package has no module of this name."""
        modules = self.table()
        if name not in modules:
            raise ValueError(f"unknown {self.what} '{name}'")
        return importlib.import_module(modules[name])


@cache
def _table(package: str) -> dict[str, str]:
    names = module_names(importlib.import_module(package).__path__)
    return {name: f"{package}.{name}" for name in names}


def lazy_attributes(module: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a module whose names are imported when they are used. `homes` has, for each module that
    defines some, their names, separated by blanks. The function raises AttributeError for other names."""
    home_of = {name: home for home, names in homes.items() for name in names.split()}

    def attribute(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module '{module}' has no attribute '{name}'")
        return import_member(f"robocomp_yaml.{home_of[name]}:{name}")

    return attribute


def import_member(path: str) -> object:
    """The object that `package.module:name` refers to. Raises ImportError and AttributeError."""
    module, _, name = path.partition(":")
    return getattr(importlib.import_module(module), name)
