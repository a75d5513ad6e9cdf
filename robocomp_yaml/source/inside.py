"""Whether a path stays below a folder when links are resolved."""

from __future__ import annotations

import os


def stays_inside(folder: str, path: str) -> bool:
    """Whether the real path of `path`, joined with the folder, is the folder or below it."""
    real = os.path.realpath(folder)
    there = os.path.realpath(os.path.join(folder, path))
    return there == real or there.startswith(real.rstrip("/") + "/")
