"""The languages that components are written in: one folder each, with a record, `LANGUAGE`, and all that it takes.

Whatever depends on the language asks the record: which keys a document may have, what is started, how it is built,
what the schema proposes. Nothing else knows the languages by name.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable
from functools import cache

from robocomp_yaml.languages.record import TargetLanguage

DEFAULT = "python"


@cache
def table() -> dict[str, TargetLanguage]:
    """Every language by its name, the usual one first."""
    packages = [module.name for module in pkgutil.iter_modules(__path__) if module.ispkg]
    found = [importlib.import_module(f"{__name__}.{name}").LANGUAGE for name in packages]
    return {one.name: one for one in sorted(found, key=lambda one: (one.name != DEFAULT, one.name))}


def language(name: str) -> TargetLanguage:
    """The language that a document calls so; the schema has seen to it that there is one."""
    return table()[name]


def with_capability(capability: str) -> list[TargetLanguage]:
    return [one for one in table().values() if capability in one.has]


def listed(words: Iterable[str], conjunction: str = "or") -> str:
    """`a`, `a or b`, `a, b or c`."""
    *most, last = words
    return f"{', '.join(most)} {conjunction} {last}" if most else last
