"""An output root: what is at a path below it, and whether the path stays inside."""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping
from itertools import accumulate

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.source.inside import is_inside
from robocomp_yaml.source.real_paths import RealPaths
from robocomp_yaml.source.regular import whole

STATE = ".rcyaml"
"""The folder below a root in which rcyaml keeps the manifest, the journal and stamps."""


class PathStatus(msgspec.Struct, frozen=True):
    """What is at a path. `data` is None if the path does not exist, or if the content was not requested. `mode` are the
    permissions of a file, 0 for a link. `problem` is the reason why the path cannot be written, and `culprit` the part
    of the path that causes it. `outside`: the path leads out of the root."""

    exists: bool = False
    data: bytes | None = None
    mode: int = 0
    problem: str = ""
    culprit: str = ""
    outside: bool = False


MISSING = PathStatus()
_APART = frozenset(("", ".", ".."))


class Root:
    """An output root. `path` is as the user wrote it, `real` is the same without symbolic links. `reals` may know other
    roots. `unsaved` has contents by real path that replace those of files, for those who only read."""

    def __init__(
        self, path: str, reals: RealPaths | None = None, unsaved: Mapping[str, bytes] | None = None
    ) -> None:  # fmt: skip
        self.path, self._reals, self._unsaved = path or ".", reals or RealPaths(), unsaved or {}
        self.real = self._reals.of(self.path)
        shown = os.path.normpath(self.path)
        self._head = "" if shown == "." else os.path.join(shown, "")
        self._folders: dict[str, bool] = {}  # whether a folder below the root is really there

    def shown(self, path: str) -> str:
        """The path for messages, which can be opened from the working folder."""
        return self._head + path if _is_plain(path) else os.path.normpath(os.path.join(self.path, path))

    def status(self, path: str, *, read: bool = True) -> PathStatus:
        """What is at a path relative to the root, with its content if `read`."""
        if not _is_plain(path):
            return PathStatus(problem="the path leads out of it", culprit=path, outside=True)
        full = f"{self.real}/{path}"
        try:
            mode = os.lstat(full).st_mode
            if stat.S_ISLNK(mode):
                return self._link(path, full, read)
            if not stat.S_ISREG(mode):
                what = "a folder" if stat.S_ISDIR(mode) else "not a regular file"
                return PathStatus(exists=True, problem=f"it is {what}", culprit=path)
            data = self._unsaved.get(full) if read else None
            if read and data is None:
                data = whole(full, is_regular=True)[0]
            status = PathStatus(exists=True, data=data, mode=stat.S_IMODE(mode))
        except FileNotFoundError:
            status = MISSING
        except NotADirectoryError:
            return self._blocked(path)
        except OSError as error:
            status = PathStatus(problem=reason_of(error), culprit=path)
        folder = path.rpartition("/")[0]
        if folder not in self._folders:
            self._folders[folder] = not folder or self._is_inside(self._reals.of(f"{self.real}/{folder}"))
        if not self._folders[folder]:
            return replace(self._blocked(path), exists=status.exists, outside=True)
        return status

    def _link(self, path: str, full: str, read: bool) -> PathStatus:
        if not self._is_inside(os.path.realpath(full)):
            return PathStatus(exists=True, problem=f"it is a link to {os.readlink(full)}", culprit=path, outside=True)
        try:
            if not stat.S_ISREG(os.stat(full).st_mode):
                return PathStatus(
                    exists=True, problem="it is a link to something that is not a regular file", culprit=path
                )
            return PathStatus(exists=True, data=contents(full) if read else None)
        except FileNotFoundError:
            return PathStatus(exists=True, data=b"" if read else None)

    def _blocked(self, path: str) -> PathStatus:
        """The status of a path of which a folder is not one, or is a link that leads out of the root. The root itself
        may be below a file."""
        for folder in folders_of(path):
            full = f"{self.real}/{folder}"
            if os.path.islink(full) and not self._is_inside(os.path.realpath(full)):
                return PathStatus(problem=f"'{folder}' is a link to {os.readlink(full)}", culprit=folder)
            if os.path.lexists(full) and not os.path.isdir(full):
                return PathStatus(problem=f"'{folder}' is not a folder", culprit=folder)
        path = self.path
        while not os.path.lexists(path) and (above := os.path.dirname(path)):
            path = above
        return PathStatus(problem=f"'{os.path.normpath(path)}' is not a folder", culprit=os.curdir)

    def _is_inside(self, real: str) -> bool:
        return is_inside(self.real, real)


def folders_of(path: str) -> list[str]:
    """The folders above a relative path, the outermost first."""
    return list(accumulate(path.split("/")[:-1], "{}/{}".format))


def contents(path: str) -> bytes:
    """The bytes of a regular file. Raises OSError."""
    return whole(path)[0]


def _is_plain(path: str) -> bool:
    """Whether a path is relative, and has neither `.` nor `..`."""
    return "\0" not in path and _APART.isdisjoint(path.split("/"))
