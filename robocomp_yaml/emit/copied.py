"""What is the same in every component: a folder of a language's templates that is copied as it stands."""

from __future__ import annotations

import os
from functools import cache

from robocomp_yaml import resources
from robocomp_yaml.languages import language
from robocomp_yaml.transactions.plan import FilePlan


@cache
def copied(name: str, folder: str) -> tuple[FilePlan, ...]:
    """The files of a folder of the language called `name`, below `generated/` and the folder's own name."""
    source = os.path.join(language(name).templates, folder)
    return tuple(FilePlan(f"generated/{folder}/{file}", text) for file, text in resources.files(source))
