"""What files are compared by: the digest of contents, for manifests and stamps, and for code the state on the disk."""

from __future__ import annotations

import os
from collections.abc import Iterator
from hashlib import blake2b


def digest(data: bytes) -> str:
    return blake2b(data, digest_size=16).hexdigest()


def states(folder: str, base: int) -> Iterator[str]:
    """Each file below a folder, with its size and times; of paths, what is behind the first `base` characters. Where
    installers give the files of two builds one date, the time at which the disk changed (ctime) tells them apart."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir():
                state = entry.stat()
                yield f"{entry.path[base:]} {state.st_size} {state.st_mtime_ns} {state.st_ctime_ns}"
            elif entry.name != "__pycache__":
                yield from states(entry.path, base)
