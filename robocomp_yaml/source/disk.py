"""The disk as a run sees it: the files that are there, or in their place the unsaved texts of an overlay.

Everything between paths and a linked program is read through one of these, so that an editor's unsaved documents count
everywhere, and so that it is known afterwards on what the outcome depends.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.source.regular import regular
from robocomp_yaml.source.text import MAX_DOCUMENT, read_bytes

FILE, FOLDER, OTHER, NOTHING = "file", "folder", "other", ""


class Disk:
    """`overlay` has contents by path that count instead of what the disk has, be there such a file or not.

    All that it was asked is remembered, by the path that was asked for: `contents`, the bytes of each file that was
    read; `states`, what there was (FILE, FOLDER, OTHER such as a pipe or a link to nowhere, NOTHING); `listed`, the
    documents in a folder; `seen`, all names in a folder; `walked`, what `documents_below` found there. `unreadable`
    says that something could not be read, which may become otherwise without any trace.
    """

    def __init__(self, overlay: Mapping[str, bytes] | None = None) -> None:
        self._overlay = {os.path.realpath(path): text for path, text in (overlay or {}).items()}
        self._folders = {folder for path in self._overlay for folder in _above(path)}
        self.contents: dict[str, bytes] = {}
        self.states: dict[str, str] = {}
        self.listed: dict[str, list[str]] = {}
        self.seen: dict[str, list[str]] = {}
        self.walked: dict[str, list[str]] = {}
        self.unreadable = False

    def read(self, path: str, limit: int = MAX_DOCUMENT) -> tuple[bytes | None, list[Diagnostic]]:
        """The bytes of a file of at most `limit` bytes, or what keeps it from being read."""
        said: list[Diagnostic] = []
        raw = self._unsaved(path)
        if raw is None:
            raw, said = read_bytes(self._on_disk(path), limit)
        if raw is not None:
            self.contents[path] = raw
        else:
            self.unreadable = True
        return raw, said

    def peek(self, path: str, size: int) -> bytes:
        """The first bytes of a file; none where it cannot be read. That they were asked for is not remembered."""
        raw = self._unsaved(path)
        if raw is not None:
            return raw[:size]
        try:
            with open(self._on_disk(path), "rb", opener=regular) as file:
                return file.read(size)
        except OSError:
            return b""

    def state(self, path: str) -> str:
        """What there is at a path: FILE, FOLDER, OTHER or NOTHING."""
        if self._overlay and (real := os.path.realpath(path)) in self._overlay:
            found = FILE
        elif self._overlay and real in self._folders:
            found = FOLDER
        else:
            found = state_of(self._on_disk(path))
        self.states[path] = found
        return found

    def has_file(self, path: str) -> bool:
        """Whether there is a file (not a folder, nor a link to nowhere)."""
        return self.state(path) == FILE

    def has_folder(self, path: str) -> bool:
        return self.state(path) == FOLDER

    def documents(self, folder: str) -> list[str]:
        """The names in a folder that documents may have, sorted. '' is the working folder."""
        self.listed[folder] = documents_in(self._names(folder))
        return self.listed[folder]

    def names(self, folder: str) -> list[str]:
        """All names in a folder, sorted: for hints alone, since any other file there makes the answer another one."""
        self.seen[folder] = sorted(self._names(folder))
        return self.seen[folder]

    def _names(self, folder: str) -> set[str]:
        names = set(names_in(self._on_disk(folder)))
        if self._overlay:
            real = os.path.realpath(folder)
            names |= {*_inside(real, self._folders), *_inside(real, self._overlay)}
        return names

    def walk(
        self, folder: str, on_error: Callable[[OSError], None] | None = None
    ) -> Iterator[tuple[str, list[str], list[str]]]:
        """As `os.walk` from the top, each list sorted; the caller may take folders out of the second list."""

        def closed(error: OSError) -> None:
            self.unreadable = True
            if on_error is not None:
                on_error(error)

        todo = [folder]
        while todo:  # without recursion: folders may be deep
            here = todo.pop()
            real = os.path.realpath(here) if self._overlay else ""
            quiet = real in self._folders and not os.path.lexists(here)  # it is in the overlay alone
            _, folders, names = next(os.walk(here, onerror=None if quiet else closed), ("", [], []))
            if self._overlay:
                folders = list({*folders, *_inside(real, self._folders)})
                names = list({*names, *_inside(real, self._overlay)})
            folders.sort()
            names.sort()
            yield here, folders, names
            below = (os.path.join(here, name) for name in reversed(folders))
            todo += [path for path in below if not os.path.islink(path)]

    def _on_disk(self, path: str) -> str:
        """A path that the system can follow: it cannot go up from a folder that only the overlay has."""
        if not self._overlay or os.path.lexists(path):
            return path
        real = os.path.realpath(path)
        return real if os.path.lexists(real) else path

    def _unsaved(self, path: str) -> bytes | None:
        return self._overlay.get(os.path.realpath(path)) if self._overlay else None


def state_of(path: str) -> str:
    """What the disk has at a path, as `Disk.state`."""
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):  # of names with a NUL
        return OTHER if os.path.lexists(path) else NOTHING
    return FILE if stat.S_ISREG(mode) else FOLDER if stat.S_ISDIR(mode) else OTHER


def names_in(folder: str) -> list[str]:
    """The names in a folder of the disk, sorted; none where it cannot be looked into."""
    try:
        return sorted(os.listdir(folder or "."))
    except OSError:
        return []


def documents_in(names: Iterable[str]) -> list[str]:
    """Those names, sorted, that documents may have, in whatever case."""
    return sorted(name for name in names if name.lower().endswith(".yaml"))


def _inside(folder: str, paths: Iterable[str]) -> Iterator[str]:
    return (os.path.basename(path) for path in paths if os.path.dirname(path) == folder != path)


def _above(path: str) -> Iterator[str]:
    while (folder := os.path.dirname(path)) != path:
        yield folder
        path = folder
