"""What is the same in every component: a folder of a language's templates that is copied as it stands."""

from __future__ import annotations

import os
from functools import cache

from robocomp_yaml.languages import language
from robocomp_yaml.transactions.plan import FilePlan


@cache
def copied(name: str, folder: str, without: frozenset[str] = frozenset()) -> tuple[FilePlan, ...]:
    """The files of a folder of the language called `name`, below `generated/` and the folder's own name; but for those
    called as in `without`."""
    target = language(name)
    return tuple(
        FilePlan(f"generated/{folder}/{file}", target.text(f"{folder}/{file}"))
        for file in sorted(os.listdir(os.path.join(target.templates, folder)))
        if file not in without and os.path.isfile(os.path.join(target.templates, folder, file))
    )
