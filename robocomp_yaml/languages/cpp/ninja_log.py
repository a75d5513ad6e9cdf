"""What Ninja remembers of a tree: how long each step took, and which files it read."""

from __future__ import annotations

import os
from collections.abc import Mapping

from robocomp_yaml.building.processes import Processes
from robocomp_yaml.source.regular import text as text_of

_DEPS = "#deps"


def read(folder: str) -> dict[str, tuple[str, ...]]:
    """Of each output, the entry of its last step: begin and end in milliseconds, time of change, hash."""
    found: dict[str, tuple[str, ...]] = {}
    for line in (text_of(os.path.join(folder, ".ninja_log")) or "").splitlines()[1:]:
        fields = line.split("\t")
        if len(fields) == 5:
            found[fields[3]] = (*fields[:3], fields[4])
    return found


def shares(before: Mapping[str, tuple[str, ...]], after: Mapping[str, tuple[str, ...]], cpu: float) -> dict[str, float]:
    """What each step of a run took of its seconds of processors, in proportion to its time."""
    taken = {path: int(entry[1]) - int(entry[0]) for path, entry in after.items() if before.get(path) != entry}
    total = sum(taken.values())
    return {path: cpu * time / total for path, time in taken.items()} if total else {}


def read_files(processes: Processes, folder: str, root: str) -> dict[str, set[str]]:
    """Of each object, the files below `root` that its compiler read, but for those of the tree itself."""
    found: dict[str, set[str]] = {}
    top, tree = (os.path.join(os.path.realpath(one), "") for one in (root, folder))
    known: dict[str, str] = {}
    current: set[str] = set()

    def place(named: str) -> str:
        """The file as seen from the root; '' where it is not below."""
        path = os.path.realpath(os.path.join(folder, named))
        return os.path.normpath(os.path.join(root, path[len(top) :])) if _is_in(path, top, tree) else ""

    def line(line: str) -> None:
        nonlocal current
        if line.startswith("    "):
            if line not in known:
                known[line] = place(line[4:])
            if known[line]:
                current.add(known[line])
        elif _DEPS in line:
            current = found.setdefault(line.partition(f": {_DEPS}")[0], set())

    processes.run(["ninja", "-t", "deps"], line, cwd=folder)
    return found


def _is_in(path: str, top: str, tree: str) -> bool:
    return path.startswith(top) and not path.startswith(tree)
