"""The languages that components are written in: one folder each, with a record, `LANGUAGE`, and all that it takes.

Whatever depends on the language asks the record: which keys a document may have, what is started, how it is built,
what the schema proposes. Nothing else knows the languages by name.
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
    """Every built-in language by its name, the usual one first."""
    folders = registry.module_names(__path__, packages=True)
    found = [importlib.import_module(f"{__name__}.{name}").LANGUAGE for name in folders]
    return {one.name: one for one in sorted(found, key=lambda one: (one.name != DEFAULT, one.name))}


_ADDED: dict[str, TargetLanguage] = {}


def add(record: TargetLanguage) -> None:
    """Makes a plug-in's language known. Where documents may be in it, their workspace says."""
    _ADDED[record.name] = record


def known() -> dict[str, TargetLanguage]:
    """Every language that some document of this process may be in."""
    return {**table(), **_ADDED}


def built_in() -> Collection[str]:
    return table().keys()


def language(name: str) -> TargetLanguage:
    """The language that a document calls so; the schema has seen to it that there is one."""
    return table().get(name) or _ADDED[name]


def with_capability(capability: str, more: Iterable[TargetLanguage] = ()) -> list[TargetLanguage]:
    """The languages that have it: built-in ones, and of `more`, those of plug-ins."""
    return [one for one in (*table().values(), *more) if capability in one.has]


def listed(words: Iterable[str], conjunction: str = "or") -> str:
    """`a`, `a or b`, `a, b or c`."""
    *most, last = words
    return f"{', '.join(most)} {conjunction} {last}" if most else last
