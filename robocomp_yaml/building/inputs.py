"""The files that a component is made of, as they are now."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.building.unit import Unit
from robocomp_yaml.emit.layout import GENERATED
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import whole

State = tuple[int, int, int]
"""Of a file: its size, when it was changed, and which file it is. Where all are as they were, its contents are."""


class Inputs:
    """Looks; what several components share, once."""

    def __init__(self) -> None:
        self._shared: dict[str, dict[str, State]] = {}
        self._digests: dict[tuple[str, State], str] = {}

    def digest(self, path: str, known: State) -> str:
        """Of the contents of a file that is in this state; '' where it cannot be read."""
        key = (path, known)
        if key not in self._digests:
            try:
                self._digests[key] = digest(whole(path)[0])
            except OSError:
                self._digests[key] = ""
        return self._digests[key]

    def of(self, unit: Unit, more: Iterable[str] = ()) -> dict[str, State]:
        """Each file with its state, by its path. `more` are files that a build read besides; those that are gone are
        left out."""
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
    """None where there is no such file."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return (status.st_size, status.st_mtime_ns, status.st_ino)


def _files(paths: Iterable[str]) -> dict[str, State]:
    return {path: found for path in paths if (found := state(path)) is not None}


def _below(path: str, endings: tuple[str, ...]) -> dict[str, State]:
    """The file itself, or the files below the folder whose names end so; all without endings."""
    if not os.path.isdir(path):
        return _files([path])
    return _files(file for file in _walk(path) if not endings or file.endswith(endings))


def _walk(folder: str) -> Iterator[str]:
    """Hidden files are those of editors, and what Python compiles is its own."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.startswith(".") or entry.name == "__pycache__":
                continue
            if entry.is_dir():
                yield from _walk(entry.path)
            else:
                yield entry.path
