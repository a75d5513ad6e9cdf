"""The user's code beside the files that there are skeletons for: parts of the class may stand there."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator

from robocomp_yaml.emit.places import Root
from robocomp_yaml.emit.specific.code import CLASS, Code
from robocomp_yaml.emit.specific.reading import is_code, read

_LARGEST = 1_000_000  # bytes; a larger file is data, not the user's code


def others(
    root: Root, folder: str, known: Collection[str], looked: dict[str, bytes] | None = None
) -> Iterator[Code]:
    """The code of the other files of a folder that speak of the class, or of what it may inherit from. `looked` is
    given all that were read."""
    for name in sorted(os.listdir(f"{root.real}/{folder}")):
        path = f"{folder}/{name}"
        if path in known or not is_code(path):
            continue
        found = root.look(path)
        if found.problem or found.data is None or len(found.data) > _LARGEST:
            continue
        if looked is not None:
            looked[root.shown(path)] = found.data
        text = found.data.decode(errors="replace")
        if CLASS in text or "class " in text:
            code = read(path, text)
            if code is not None:
                yield code
