"""What is the same in every component: folders that are copied as they stand."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from robocomp_yaml import resources, semantics
from robocomp_yaml.languages import language
from robocomp_yaml.transactions.plan import FilePlan


@cache
def copied(name: str, folder: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    """The files of a folder of the language called `name`, below `generated/` and the folder's own name; but for those
    called as in `without`."""
    return _files(language(name).templates / folder, f"generated/{folder}", without)


@cache
def shared() -> tuple[FilePlan, ...]:
    """The package that the compiler and components in Python have in common."""
    return _files(Path(semantics.__file__).parent, "generated/runtime/semantics")


def _files(source: Path, target: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    return tuple(FilePlan(f"{target}/{name}", text) for name, text in resources.files(source) if name not in without)
