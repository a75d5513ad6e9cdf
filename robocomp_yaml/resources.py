"""Where the data folders live: `schemas/`, `templates/`, `migrate/` and `docs/diagnostics/`.

In a wheel they stand inside the package, under `_data/`; in a checkout (and so in an editable install) they stand
beside the package, where people look for them.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import cache

_PACKAGE = os.path.dirname(os.path.realpath(__file__))
_CHECKOUT = os.path.dirname(_PACKAGE)
_IN_CHECKOUT = {"diagnostics": "docs/diagnostics"}


@cache
def folder(name: str) -> str:
    """The data folder `schemas`, `templates`, `migrate` or `diagnostics`.

    Raises FileNotFoundError where the installation is broken: rcyaml cannot work without its data.
    """
    shipped = os.path.join(_PACKAGE, "_data", name)
    if os.path.isdir(shipped):
        return shipped
    beside = os.path.join(_CHECKOUT, _IN_CHECKOUT.get(name, name))
    if os.path.isfile(os.path.join(_CHECKOUT, "pyproject.toml")) and os.path.isdir(beside):
        return beside
    raise FileNotFoundError(f"rcyaml's folder '{name}' is missing from this installation: reinstall rcyaml")


def files(source: str) -> Iterator[tuple[str, str]]:
    """The names and the texts of the files that stand directly in a folder of rcyaml's own."""
    for name in sorted(os.listdir(source)):
        if os.path.isfile(path := os.path.join(source, name)):
            yield name, read(path)


def text(path: str) -> str:
    """The text of one data file, such as `schemas/idsl.schema.json`."""
    return read(_of(path))


def read(path: str) -> str:
    """The text of a file of rcyaml's own."""
    with open(path, encoding="utf-8") as file:
        return file.read()


def names(path: str) -> list[str]:
    """What is in a data folder, or a folder in one, such as `migrate/options`."""
    return sorted(os.listdir(_of(path)))


def _of(path: str) -> str:
    head, _, tail = path.partition("/")
    return os.path.join(folder(head), tail)
