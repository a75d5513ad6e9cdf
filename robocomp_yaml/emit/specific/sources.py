"""The user's code beside the files that there are skeletons for: parts of the class may stand there."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator

from robocomp_yaml.emit.specific.code import CLASS, Code
from robocomp_yaml.emit.specific.reading import is_code, read
from robocomp_yaml.transactions.places import Root

_LARGEST = 1_000_000  # bytes; a larger file is data, not the user's code


def names(root: Root, folder: str) -> list[str]:
    """All names in a folder, sorted."""
    return sorted(os.listdir(f"{root.real}/{folder}"))


def code_in(root: Root, folder: str) -> Iterator[tuple[str, bytes]]:
    """Each file of a folder that is code by its name, with its contents."""
    for name in names(root, folder):
        path = f"{folder}/{name}"
        if is_code(path):
            found = root.look(path)
            if not found.problem and found.data is not None and len(found.data) <= _LARGEST:
                yield path, found.data


def others(root: Root, folder: str, known: Collection[str]) -> Iterator[Code]:
    """The code of the other files of a folder that speak of the class, or of what it may inherit from."""
    for path, data in code_in(root, folder):
        text = data.decode(errors="replace")
        if path not in known and (CLASS in text or "class " in text):
            code = read(path, text)
            if code is not None:
                yield code
