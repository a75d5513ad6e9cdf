"""Relative paths."""

from __future__ import annotations

import os


def relative(path: str, start: str) -> str:
    """The path relative to a folder, as `os.path.relpath` returns it; '' is the working folder. Of two relative or two
    absolute paths, the working folder need not be known, and less is computed."""
    if (path[:1] == "/") != (start[:1] == "/") or ".." in path or ".." in start:
        return os.path.relpath(path or ".", start or ".")
    parts, above = _parts(path), _parts(start)
    common = 0
    while common < len(parts) and common < len(above) and parts[common] == above[common]:
        common += 1
    return "/".join([os.pardir] * (len(above) - common) + parts[common:]) or os.curdir


def _parts(path: str) -> list[str]:
    return [part for part in path.split("/") if part not in ("", os.curdir)]
