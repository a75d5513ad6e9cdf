"""The disk as a run sees it: its files, with the unsaved texts of an overlay in front of them.

All passes from paths to a linked program read through one Disk. Thus an editor's unsaved documents are used in every
pass, and the Disk records all that the result depends on.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any, TypeVar

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.source.regular import content
from robocomp_yaml.source.text import MAX_DOCUMENT, read_bytes

_Made = TypeVar("_Made")
FILE, FOLDER, OTHER, NOTHING = "file", "folder", "other", ""
_Answer = TypeVar("_Answer")


def state_of(path: str) -> str:
    """The kind of a path on the disk, as `Disk.state`."""
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):  # of names with a NUL
        return OTHER if os.path.lexists(path) else NOTHING
    return FILE if stat.S_ISREG(mode) else FOLDER if stat.S_ISDIR(mode) else OTHER


def names_in(folder: str) -> list[str]:
    """The names in a folder of the disk, sorted; none if it cannot be read."""
    try:
        return sorted(os.listdir(folder or "."))
    except OSError:
        return []


def _peek(path: str, size: int) -> bytes:
    return content(path, size) or b""


_OF_CONTENTS = (read_bytes, _peek)


class Files:
    """The files of the disk, as they are at each request. `reals` are the real paths that are known."""

    def __init__(self) -> None:
        self.reals = RealPaths(self.get)

    @property
    def version(self) -> object:
        """As long as it is the same, so are the answers, except for the contents of files."""
        return object()

    def get(self, request: Callable[..., _Answer], *arguments: Any) -> _Answer:
        return request(*arguments)


class KeptFiles(Files):
    """The files of the disk, as they were at the first request after `forget`, or at the last `renew`."""

    def __init__(self) -> None:
        super().__init__()
        self._answers: dict[tuple[Any, ...], Any] = {}
        self._version = object()

    @property
    def version(self) -> object:
        return self._version

    def get(self, request: Callable[..., _Answer], *arguments: Any) -> _Answer:
        known = request, *arguments
        if known not in self._answers:
            self._answers[known] = request(*arguments)
        answer: _Answer = self._answers[known]
        return answer

    def renew(self) -> None:
        """Repeats all requests."""
        is_same = True
        for known, before in self._answers.items():
            request, *arguments = known
            answer = request(*arguments)
            if answer != before:
                self._answers[known] = answer
                is_same = is_same and request in _OF_CONTENTS
        if not is_same:
            self.reals.forget()
            self._version = object()


class DiskRecord(msgspec.Struct, frozen=True):
    """What was requested of a Disk, as its attributes say; `heads` are beginnings of files, by path and size."""

    contents: Mapping[str, bytes] = {}
    heads: Mapping[tuple[str, int], bytes] = {}
    states: Mapping[str, str] = {}
    listed: Mapping[str, list[str]] = {}
    seen: Mapping[str, list[str]] = {}
    walked: Mapping[str, list[str]] = {}
    unreadable: bool = False

    @property
    def answers(self) -> tuple[Mapping[Any, Any], ...]:
        return self.contents, self.heads, self.states, self.listed, self.seen, self.walked


NOTHING_REQUESTED = DiskRecord()


class Disk:
    """`overlay` maps paths to contents that replace those of the disk, whether or not such a file exists. `files` are
    the files of the disk.

    The Disk records every request by its path: `contents`, the bytes of each file that was read; `states`, the kind of
    each path (FILE, FOLDER, NOTHING, or OTHER such as a pipe or a broken link); `listed`, the documents in a folder;
    `seen`, all names in a folder; `walked`, the documents below a folder. `unreadable`: a path could not be read, and
    may become readable without a change that the Disk could detect.
    """

    def __init__(self, overlay: Mapping[str, bytes] | None = None, files: Files | None = None) -> None:
        self._files = files or Files()
        self._overlay = {self.real(path): text for path, text in (overlay or {}).items()}
        self._folders = {folder for path in self._overlay for folder in folders_above(path)}
        self._inside: dict[str, set[str]] = {}  # the names that the overlay adds to folders
        for folder, name in map(os.path.split, (*self._overlay, *self._folders)):
            if name:  # the root folder has none
                self._inside.setdefault(folder, set()).add(name)
        self.contents: dict[str, bytes] = {}
        self.states: dict[str, str] = {}
        self.listed: dict[str, list[str]] = {}
        self.seen: dict[str, list[str]] = {}
        self.walked: dict[str, list[str]] = {}
        self.unreadable = False
        self._heads: dict[tuple[str, int], bytes] = {}
        self._made: dict[object, Any] = {}

    @property
    def version(self) -> object:
        """As long as it is the same, so are the files of the disk, except for their contents."""
        return self._files.version

    @property
    def unsaved(self) -> Mapping[str, bytes]:
        """The overlay, by real path."""
        return self._overlay

    @property
    def added(self) -> tuple[str, ...]:
        """The real paths of the overlay that are no files of the disk."""
        missing = (path for path in self._overlay if self._files.get(state_of, path) != FILE)
        return self.once("added", lambda: tuple(sorted(missing)))

    def apart(self) -> Disk:
        """The same disk, which records its requests by itself."""
        return Disk(self._overlay, self._files)

    def record(self, without: Collection[str] = (), since: DiskRecord = NOTHING_REQUESTED) -> DiskRecord:
        """What was requested until now, except for the contents of some files, and for what a record contains."""
        contents = {path: raw for path, raw in self.contents.items() if path not in without}
        answers: tuple[dict[Any, Any], ...] = contents, *self._answers[1:]
        contents, heads, states, listed, seen, walked = (
            {key: answer for key, answer in new.items() if key not in known}
            for new, known in zip(answers, since.answers, strict=True)
        )
        return DiskRecord(contents, heads, states, listed, seen, walked, self.unreadable)

    def recall(self, record: DiskRecord) -> None:
        """As if the same had been requested of this Disk."""
        for answers, known in zip(self._answers, record.answers, strict=True):
            answers.update(known)
        self.unreadable = self.unreadable or record.unreadable

    @property
    def _answers(self) -> tuple[dict[Any, Any], ...]:
        """As `DiskRecord.answers`."""
        return self.contents, self._heads, self.states, self.listed, self.seen, self.walked

    def has_contents(self, record: DiskRecord) -> bool:
        """Whether the contents of files are those of a record. These requests are not recorded."""
        return all(self._content(path)[0] == raw for path, raw in record.contents.items()) and all(
            self._head(path, size) == raw for (path, size), raw in record.heads.items()
        )

    def ask(self, request: Callable[..., _Answer], *arguments: Any) -> _Answer:
        """What a function returns of the files of the disk. This request is not recorded."""
        return self._files.get(request, *arguments)

    def once(self, name: object, make: Callable[[], _Made]) -> _Made:
        """The result of `make`, cached by name: what follows from the contents that the name contains."""
        if name not in self._made:
            self._made[name] = make()
        made: _Made = self._made[name]
        return made

    def real(self, path: str) -> str:
        """The real path, without links. Each folder is resolved once."""
        return self._files.reals.of(path)

    def read(self, path: str, limit: int = MAX_DOCUMENT) -> tuple[bytes | None, list[Diagnostic]]:
        """The content of a file of at most `limit` bytes; None, with diagnostics, if it cannot be read."""
        raw, diagnostics = self._content(path, limit)
        if raw is not None:
            self.contents[path] = raw
        else:
            self.unreadable = True
        return raw, diagnostics

    def peek(self, path: str, size: int) -> bytes:
        """The first `size` bytes of a file; none if it cannot be read. No stamp contains this request."""
        head = self._heads[path, size] = self._head(path, size)
        return head

    def state(self, path: str) -> str:
        """The kind of a path: FILE, FOLDER, OTHER or NOTHING."""
        if self._overlay and (real := self.real(path)) in self._overlay:
            kind = FILE
        elif self._overlay and real in self._folders:
            kind = FOLDER
        else:
            kind = self._files.get(state_of, self._on_disk(path))
        self.states[path] = kind
        return kind

    def has_file(self, path: str) -> bool:
        """Whether the path is a file (neither a folder nor a broken link)."""
        return self.state(path) == FILE

    def has_folder(self, path: str) -> bool:
        return self.state(path) == FOLDER

    def documents(self, folder: str) -> list[str]:
        """The names in a folder that may be documents, sorted. '' is the working folder."""
        listed = self._files.get(_documents_of, self._on_disk(folder))
        added = self._added_to(folder)
        self.listed[folder] = documents_in({*listed, *added}) if added else listed
        return self.listed[folder]

    def names(self, folder: str) -> list[str]:
        """All names in a folder, sorted. Only for hints: every new file in the folder makes the stamp stale."""
        self.seen[folder] = sorted(self._names(folder))
        return self.seen[folder]

    def _names(self, folder: str) -> set[str]:
        names = set(self._files.get(names_in, self._on_disk(folder)))
        return names | self._added_to(folder)

    def _added_to(self, folder: str) -> set[str]:
        """The names that the overlay adds to a folder."""
        return self._inside.get(self.real(folder or os.curdir), set()) if self._overlay else set()

    def walk(
        self, folder: str, on_error: Callable[[OSError], None] | None = None
    ) -> Iterator[tuple[str, list[str], list[str]]]:
        """As `os.walk` from the top, with sorted lists; the caller may remove folders from the second list."""

        def closed(error: OSError) -> None:
            self.unreadable = True
            if on_error is not None:
                on_error(error)

        todo = [folder]
        while todo:  # without recursion: folders may be deep
            here = todo.pop()
            real = self.real(here) if self._overlay else ""
            quiet = real in self._folders and not os.path.lexists(here)  # a folder of the overlay only
            _, folders, names = next(os.walk(here, onerror=None if quiet else closed), ("", [], []))
            if self._overlay:
                more = self._inside.get(real, set())
                folders = list({*folders, *(name for name in more if os.path.join(real, name) in self._folders)})
                names = list({*names, *(name for name in more if os.path.join(real, name) in self._overlay)})
            folders.sort()
            names.sort()
            yield here, folders, names
            below = (os.path.join(here, name) for name in reversed(folders))
            todo += [path for path in below if not os.path.islink(path)]

    def _on_disk(self, path: str) -> str:
        """A path that the system can resolve: it cannot go up from a folder that exists only in the overlay."""
        if not self._overlay or self._files.get(os.path.lexists, path):
            return path
        real = self.real(path)
        return real if self._files.get(os.path.lexists, real) else path

    def _content(self, path: str, limit: int = MAX_DOCUMENT) -> tuple[bytes | None, list[Diagnostic]]:
        raw = self._unsaved(path)
        if raw is not None:
            return raw, []
        found: tuple[bytes | None, list[Diagnostic]] = self._files.get(read_bytes, self._on_disk(path), limit)
        return found

    def _head(self, path: str, size: int) -> bytes:
        raw = self._unsaved(path)
        return raw[:size] if raw is not None else self._files.get(_peek, self._on_disk(path), size)

    def _unsaved(self, path: str) -> bytes | None:
        return self._overlay.get(self.real(path)) if self._overlay else None


def documents_in(names: Iterable[str]) -> list[str]:
    """Those of the names that may be documents, in upper or lower case, sorted. Hidden files are none: editors make
    them beside documents, such as Emacs' locks (`.#Speech.idsl.yaml`)."""
    return sorted(name for name in names if name.lower().endswith(".yaml") and not name.startswith("."))


def _documents_of(folder: str) -> list[str]:
    return documents_in(names_in(folder))


def folders_above(path: str) -> Iterator[str]:
    """The folders that contain an absolute path, the innermost first."""
    while (folder := os.path.dirname(path)) != path:
        yield folder
        path = folder
