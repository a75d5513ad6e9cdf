"""Digests of contents, for manifests and stamps, and the states of files on the disk, for installed code."""

from __future__ import annotations

import os

try:
    from _blake2 import blake2b  # as `hashlib` has it, which also imports OpenSSL: 2 ms
except ImportError:
    from hashlib import blake2b


def digest(data: bytes) -> str:
    return blake2b(data, digest_size=16).hexdigest()


def states(folder: str, base: int) -> list[str]:
    """Each file below a folder, in order, with its size (bytes) and the time of its last change (ctime, ns):
    nobody can set it, as installers set dates. Paths lack their first `base` characters."""
    found, folders = [], [folder]
    while folders:
        with os.scandir(folders.pop()) as entries:
            for entry in entries:
                if not entry.is_dir():
                    state = entry.stat()
                    found.append(f"{entry.path[base:]} {state.st_size} {state.st_ctime_ns}")
                elif entry.name != "__pycache__":
                    folders.append(entry.path)
    return sorted(found)
