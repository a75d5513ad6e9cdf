"""Which documents `rcyaml migrate` wrote: they say what other programs say already, so nobody here can rename it."""

from __future__ import annotations

import json
import os

from robocomp_yaml.source.regular import regular

MEMORY = ".rcyaml/migrated.json"  # at the root of what was migrated; digests by path


def is_migrated(path: str) -> bool:
    """Whether a document came from a legacy file, edited since or not."""
    path = os.path.realpath(path)
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
