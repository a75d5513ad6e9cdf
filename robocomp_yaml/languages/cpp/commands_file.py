"""`compile_commands.json` at a workspace's root, which tells editors how each file is compiled."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterable

from robocomp_yaml.source.regular import regular, whole
from robocomp_yaml.transactions import whole_file

NAME = "compile_commands.json"


def write(root: str, trees: Iterable[str]) -> None:
    """Joins those of these trees; one that somebody else wrote stays."""
    path = os.path.join(root, NAME)
    entries = [entry for tree in trees for entry in _entries(os.path.join(tree, NAME))]
    if os.path.lexists(path) and (os.path.islink(path) or not _is_ours(path, root)):
        return
    text = json.dumps(entries, indent=1, ensure_ascii=False).encode("utf-8", "surrogateescape") + b"\n"
    with contextlib.suppress(OSError):
        if not os.path.exists(path) or whole(path)[0] != text:
            whole_file.put(path, text)


def _is_ours(path: str, root: str) -> bool:
    """Whether each command in it is of a tree in `build/`."""
    built = os.path.join(os.path.abspath(root), "build", "")
    return all(os.path.join(str(entry.get("directory", "")), "").startswith(built) for entry in _entries(path))


def _entries(path: str) -> list[dict[str, object]]:
    try:
        with open(path, encoding="utf-8", errors="surrogateescape", opener=regular) as file:
            found = json.load(file)
    except (OSError, ValueError):
        return []
    return [entry for entry in found if isinstance(entry, dict)] if isinstance(found, list) else []
