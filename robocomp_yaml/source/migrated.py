"""Which documents `rcyaml migrate` wrote: they say what other programs say already, so nobody here can rename it.

Where that counts the document says so itself, since what `migrate` remembers is not in every clone of a repository.
"""

from __future__ import annotations

import itertools
import json
import os

from robocomp_yaml.source.disk import Disk

MEMORY = ".rcyaml/migrated.json"  # at the root of what was migrated; digests by path
MARK = "# Migrated: "
HEADING = f"{MARK}other programs use these names too, so those that C++ takes are warnings here.\n"
_HEAD = 4096  # bytes, in which the comments at a document's beginning stand


def is_migrated(path: str, disk: Disk) -> bool:
    """Whether a document came from a legacy file, edited since or not."""
    return _says_so(disk.peek(path, _HEAD)) or _is_remembered(os.path.realpath(path), disk)


def _says_so(head: bytes) -> bool:
    lines = head.decode("utf-8-sig", errors="replace").splitlines()
    return any(line.startswith(MARK) for line in itertools.takewhile(lambda line: line[:1] in ("", "#"), lines))


def _is_remembered(path: str, disk: Disk) -> bool:
    folder = os.path.dirname(path)
    while True:
        memory = os.path.join(folder, MEMORY)
        if disk.has_file(memory):
            try:
                remembered = json.loads(disk.read(memory)[0] or b"")
                return os.path.relpath(path, folder).replace(os.sep, "/") in remembered["files"]
            except (ValueError, LookupError, TypeError):
                return False
        parent = os.path.dirname(folder)
        if parent == folder:
            return False
        folder = parent
