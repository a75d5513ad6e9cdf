"""Whether a path stays below a folder, whatever links there are."""

from __future__ import annotations

import os


def stays_inside(folder: str, path: str) -> bool:
    """Whether `path`, joined with the folder, is really below it, or the folder itself."""
    real = os.path.realpath(folder)
    there = os.path.realpath(os.path.join(folder, path))
    return there == real or there.startswith(real.rstrip("/") + "/")
