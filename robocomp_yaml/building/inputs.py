"""The files that a component is built from, in their current state."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.building.unit import Unit
from robocomp_yaml.emit.layout import GENERATED
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import whole

State = tuple[int, int, int]
"""The state of a file: its size, the time of its last change, and its inode. If these are equal, the contents are."""


class Inputs:
    """Reads the states and digests of files, each once, although several components share some."""

    def __init__(self) -> None:
        self._shared: dict[str, dict[str, State]] = {}
        self._digests: dict[tuple[str, State], str] = {}

    def digest(self, path: str, known: State) -> str:
        """The digest of a file in this state; '' if it cannot be read."""
        key = (path, known)
        if key not in self._digests:
            try:
                self._digests[key] = digest(whole(path)[0])
            except OSError:
                self._digests[key] = ""
        return self._digests[key]

    def of(self, unit: Unit, more: Iterable[str] = ()) -> dict[str, State]:
        """The inputs of a component: the state of each file, by its path. `more` are other files that the last build
        read; those that do not exist any more are skipped."""
        found: dict[str, State] = {}
        for path, endings in unit.language.made_of.items():
            found |= _below(unit.path(path), endings)
        if unit.runtime and not os.path.isdir(unit.path(f"{GENERATED}/runtime")):
            if unit.runtime not in self._shared:
                self._shared[unit.runtime] = dict(_below(unit.runtime, ()))
            found |= self._shared[unit.runtime]
        for source in unit.sources:
            found |= _below(source, ())
        found |= _files((*unit.slices, *(path for path in more if path not in found)))
        return found


def state(path: str) -> State | None:
    """The state of a file; None if it does not exist."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return (status.st_size, status.st_mtime_ns, status.st_ino)


def _files(paths: Iterable[str]) -> dict[str, State]:
    return {path: found for path in paths if (found := state(path)) is not None}


def _below(path: str, endings: tuple[str, ...]) -> dict[str, State]:
    """The state of a file, or of the files below a folder whose names have one of the endings; without endings, of
    all."""
    if not os.path.isdir(path):
        return _files([path])
    return _files(file for file in _walk(path) if not endings or file.endswith(endings))


def _walk(folder: str) -> Iterator[str]:
    """The files below a folder, without hidden ones, which belong to editors, and without Python's bytecode."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.startswith(".") or entry.name == "__pycache__":
                continue
            if entry.is_dir():
                yield from _walk(entry.path)
            else:
                yield entry.path
