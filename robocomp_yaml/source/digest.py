"""Digests of contents, for manifests and stamps, and the states of files on the disk, for installed code."""

from __future__ import annotations

import os
from collections.abc import Iterator


def digest(data: bytes) -> str:
    from hashlib import blake2b  # with OpenSSL, slow to import

    return blake2b(data, digest_size=16).hexdigest()


def states(folder: str, base: int) -> Iterator[str]:
    """Each file below a folder, with its size (bytes) and times (ns). Paths lack their first `base` characters. The
    time of the change on the disk (ctime) distinguishes builds whose files an installer gave the same date."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir():
                state = entry.stat()
                yield f"{entry.path[base:]} {state.st_size} {state.st_mtime_ns} {state.st_ctime_ns}"
            elif entry.name != "__pycache__":
                yield from states(entry.path, base)
