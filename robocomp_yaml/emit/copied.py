"""What is the same in every component: folders that are copied as they stand."""

from __future__ import annotations

import os
from functools import cache

from robocomp_yaml import semantics
from robocomp_yaml.languages import language
from robocomp_yaml.source.regular import regular
from robocomp_yaml.transactions.plan import FilePlan


@cache
def copied(name: str, folder: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    """The files of a folder of the language called `name`, below `generated/` and the folder's own name; but for those
    called as in `without`."""
    return _files(os.path.join(language(name).templates, folder), f"generated/{folder}", without)


@cache
def shared() -> tuple[FilePlan, ...]:
    """The package that the compiler and components in Python have in common."""
    return _files(os.path.dirname(semantics.__file__), "generated/runtime/semantics")


def _files(source: str, target: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    paths = (os.path.join(source, name) for name in sorted(os.listdir(source)) if name not in without)
    return tuple(FilePlan(f"{target}/{os.path.basename(path)}", _text(path)) for path in paths if os.path.isfile(path))


def _text(path: str) -> str:
    with open(path, encoding="utf-8", opener=regular) as file:
        return file.read()
