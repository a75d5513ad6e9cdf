"""The stamps that compiles leave: where one is kept, and what it tells of a later run."""

from __future__ import annotations

import os
from collections.abc import Sequence

from robocomp_yaml.commands import _options
from robocomp_yaml.emit import stamp


def place(
    paths: Sequence[str], include: Sequence[str], output: str | None = None, targets: Sequence[str] = ()
) -> tuple[str, str]:
    """The folder below which a compile with these arguments keeps its stamp, and the stamp's name."""
    name = stamp.key([*paths, "-o", output or "", "-I", *include, "-t", *targets])
    return output or (paths[0] if os.path.isdir(paths[0]) else os.path.dirname(paths[0])) or ".", name


def code_fits(paths: Sequence[str], include: Sequence[str]) -> bool:
    """Whether a compile of these has looked at the user's code and had nothing to say of it, and nothing that it read
    has changed since: it leaves no stamp where it had. What it wrote does not matter for that."""
    made = stamp.load(*place(paths, include))
    return made is not None and stamp.reads_the_same(made, _options.find_below)
