"""The languages that components are written in: a folder each, with its record `LANGUAGE`, its parts and templates.

What depends on the language is read from the record: which keys a document may have, which program is started, how it
is built, what the schema proposes. No other package names a language.
"""

from __future__ import annotations

import importlib
from collections.abc import Collection, Iterable
from functools import cache

from robocomp_yaml import registry
from robocomp_yaml.languages.record import TargetLanguage

DEFAULT = "python"


@cache
def table() -> dict[str, TargetLanguage]:
    """Every built-in language by its name, the default first."""
    folders = registry.module_names(__path__, packages=True)
    records = [importlib.import_module(f"{__name__}.{name}").LANGUAGE for name in folders]
    return {one.name: one for one in sorted(records, key=lambda one: (one.name != DEFAULT, one.name))}


_ADDED: dict[str, TargetLanguage] = {}


def add(record: TargetLanguage) -> None:
    """Makes the language of a plug-in known. The workspace decides whether its documents may use it."""
    _ADDED[record.name] = record


def known() -> dict[str, TargetLanguage]:
    """Every language that a document of this process may use."""
    return {**table(), **_ADDED}


def built_in() -> Collection[str]:
    return table().keys()


def language(name: str) -> TargetLanguage:
    """The language with a name. The schema has already rejected unknown names: for them it raises KeyError."""
    return table().get(name) or _ADDED[name]


def with_capability(capability: str, more: Iterable[TargetLanguage] = ()) -> list[TargetLanguage]:
    """The languages that support `capability`: the built-in ones, and those of plug-ins in `more`."""
    return [one for one in (*table().values(), *more) if capability in one.has]


def listed(words: Iterable[str], conjunction: str = "or") -> str:
    """`a`, `a or b`, `a, b or c`."""
    *most, last = words
    return f"{', '.join(most)} {conjunction} {last}" if most else last
