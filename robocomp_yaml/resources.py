"""Where the data folders live: `schemas/`, `templates/`, `migrate/` and `docs/diagnostics/`.

In a wheel they stand inside the package, under `_data/`; in a checkout (and so in an editable install) they stand
beside the package, where people look for them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent
_IN_CHECKOUT = {"diagnostics": "docs/diagnostics"}


@cache
def folder(name: str) -> Path:
    """The data folder `schemas`, `templates`, `migrate` or `diagnostics`.

    Raises FileNotFoundError where the installation is broken: rcyaml cannot work without its data.
    """
    shipped = _PACKAGE / "_data" / name
    if shipped.is_dir():
        return shipped
    beside = _PACKAGE.parent / _IN_CHECKOUT.get(name, name)
    if (_PACKAGE.parent / "pyproject.toml").is_file() and beside.is_dir():
        return beside
    raise FileNotFoundError(f"rcyaml's folder '{name}' is missing from this installation: reinstall rcyaml")


def files(source: Path) -> Iterator[tuple[str, str]]:
    """The names and the texts of the files that stand directly in a folder of rcyaml's own."""
    for file in sorted(source.iterdir()):
        if file.is_file():
            yield file.name, file.read_text(encoding="utf-8")


def text(path: str) -> str:
    """The text of one data file, such as `schemas/idsl.schema.json`."""
    head, _, tail = path.partition("/")
    return (folder(head) / tail).read_text(encoding="utf-8")
