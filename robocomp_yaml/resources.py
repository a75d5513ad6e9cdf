"""The data folders: `schemas/`, `templates/`, `migrate/` and `docs/diagnostics/`.

In a wheel they are inside the package, in `_data/`. In a checkout (and in an editable install) they are beside the
package, where people look for them.
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
    """The path of the data folder `schemas`, `templates`, `migrate` or `diagnostics`.

    Raises FileNotFoundError if the folder is missing from the installation.
    """
    shipped = os.path.join(_PACKAGE, "_data", name)
    if os.path.isdir(shipped):
        return shipped
    beside = os.path.join(_CHECKOUT, _IN_CHECKOUT.get(name, name))
    if os.path.isfile(os.path.join(_CHECKOUT, "pyproject.toml")) and os.path.isdir(beside):
        return beside
    raise FileNotFoundError(f"rcyaml's folder '{name}' is missing from this installation: reinstall rcyaml")


def files(source: str) -> Iterator[tuple[str, str]]:
    """The names and the texts of the files that are directly in a folder of rcyaml."""
    for name in sorted(os.listdir(source)):
        if os.path.isfile(path := os.path.join(source, name)):
            yield name, read(path)


def text(path: str) -> str:
    """The text of one data file, such as `schemas/idsl.schema.json`."""
    return read(_of(path))


def read(path: str) -> str:
    """The text of a file of rcyaml."""
    with open(path, "rb", buffering=0) as file:  # a compile reads a hundred: a text stream takes twice as long
        return file.read().decode()


def names(path: str) -> list[str]:
    """The sorted names of what a data folder contains, or a folder in one, such as `migrate/options`."""
    return sorted(os.listdir(_of(path)))


def _of(path: str) -> str:
    head, _, tail = path.partition("/")
    return os.path.join(folder(head), tail)
