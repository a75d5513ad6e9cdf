"""Which documents `rcyaml migrate` wrote: other programs use the names in them, so that they cannot be renamed here.

If this matters for a document, its heading says so, because the memory of `migrate` is not in every clone.
"""

from __future__ import annotations

import itertools
import json
import os

from robocomp_yaml.source.disk import Disk, folders_above

MEMORY = ".rcyaml/migrated.json"  # at the root of what was migrated; digests by path
MARK = "# Migrated: "
HEADING = f"{MARK}other programs use these names, too. Therefore names that C++ reserves are only warnings.\n"
_HEAD = 4096  # bytes at the beginning of a document that are searched for the heading


def is_migrated(path: str, disk: Disk) -> bool:
    """Whether `migrate` wrote the document, even if it was edited since."""
    return _says_so(disk.peek(path, _HEAD)) or _is_remembered(os.path.realpath(path), disk)


def _says_so(head: bytes) -> bool:
    lines = head.decode("utf-8-sig", errors="replace").splitlines()
    return any(line.startswith(MARK) for line in itertools.takewhile(lambda line: line[:1] in ("", "#"), lines))


def _is_remembered(path: str, disk: Disk) -> bool:
    for folder in folders_above(path):
        memory = os.path.join(folder, MEMORY)
        if disk.has_file(memory):
            try:
                remembered = json.loads(disk.read(memory)[0] or b"")
                return os.path.relpath(path, folder).replace(os.sep, "/") in remembered["files"]
            except (ValueError, LookupError, TypeError):
                return False
    return False
