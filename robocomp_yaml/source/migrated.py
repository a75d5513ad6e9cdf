"""Which documents `rcyaml migrate` wrote: they say what other programs say already, so nobody here can rename it.

Where that counts the document says so itself, since what `migrate` remembers is not in every clone of a repository.
"""

from __future__ import annotations

import itertools
import json
import os

from robocomp_yaml.source.regular import regular

MEMORY = ".rcyaml/migrated.json"  # at the root of what was migrated; digests by path
MARK = "# Migrated: "
HEADING = f"{MARK}other programs use these names too, so those that C++ takes are warnings here.\n"
_HEAD = 4096  # bytes, in which the comments at a document's beginning stand


def is_migrated(path: str) -> bool:
    """Whether a document came from a legacy file, edited since or not."""
    return _says_so(path) or _is_remembered(os.path.realpath(path))


def _says_so(path: str) -> bool:
    try:
        with open(path, encoding="utf-8", errors="replace", opener=regular) as file:
            lines = file.read(_HEAD).removeprefix("\ufeff").splitlines()
    except OSError:
        return False
    return any(line.startswith(MARK) for line in itertools.takewhile(lambda line: line[:1] in ("", "#"), lines))


def _is_remembered(path: str) -> bool:
    folder = os.path.dirname(path)
    while True:
        try:
            with open(os.path.join(folder, MEMORY), encoding="utf-8", opener=regular) as file:
                return os.path.relpath(path, folder).replace(os.sep, "/") in json.load(file)["files"]
        except (ValueError, LookupError, TypeError):
            return False
        except OSError:
            pass  # perhaps further up
        parent = os.path.dirname(folder)
        if parent == folder:
            return False
        folder = parent
