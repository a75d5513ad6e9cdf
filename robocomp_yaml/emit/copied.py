"""What is the same in every component: a folder of a language's templates that is copied as it stands."""

from __future__ import annotations

from functools import cache

from robocomp_yaml.languages import language
from robocomp_yaml.transactions.plan import FilePlan


@cache
def copied(name: str, folder: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    """The files of a folder of the language called `name`, below `generated/` and the folder's own name; but for those
    called as in `without`."""
    target = language(name)
    return tuple(
        FilePlan(f"generated/{folder}/{file.name}", target.text(f"{folder}/{file.name}"))
        for file in sorted((target.templates / folder).iterdir())
        if file.is_file() and file.name not in without
    )
