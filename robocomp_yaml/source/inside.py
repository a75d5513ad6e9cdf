"""Whether a path stays below a folder when links are resolved."""

from __future__ import annotations

import os


def stays_inside(folder: str, path: str) -> bool:
    """Whether the real path of `path`, joined with the folder, is the folder or below it."""
    return is_inside(os.path.realpath(folder), os.path.realpath(os.path.join(folder, path)))


def is_inside(folder: str, path: str) -> bool:
    """Whether a path is a folder or below it, if both are real paths."""
    return path == folder or path.startswith(folder.rstrip("/") + "/")
