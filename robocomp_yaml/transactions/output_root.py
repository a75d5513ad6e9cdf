"""Where a planned path leads on the disk: what stands there now, and never anything outside the output root."""

from __future__ import annotations

import functools
import os
import stat
from itertools import accumulate

import msgspec
from msgspec.structs import replace

from robocomp_yaml.source.regular import whole

STATE = ".rcyaml"
"""The folder of a root in which rcyaml keeps what it must remember."""


class PathStatus(msgspec.Struct, frozen=True):
    """What stands at a path. `data` is None where there is nothing, and where nobody asked for it; `mode` is that of a
    file, 0 for a link. `problem` says why nothing can be written there, `culprit` which part of the path it is that
    stands in the way; `outside` when it leads out of the root."""

    exists: bool = False
    data: bytes | None = None
    mode: int = 0
    problem: str = ""
    culprit: str = ""
    outside: bool = False


NOTHING = PathStatus()


class Root:
    """An output root. `path` is as the user gave it, `real` without any symlink."""

    def __init__(self, path: str) -> None:
        self.path = path or "."
        self.real = os.path.realpath(self.path)
        self._real_folder = functools.cache(os.path.realpath)

    def shown(self, path: str) -> str:
        return os.path.normpath(os.path.join(self.path, path))

    def look(self, path: str, *, read: bool = True) -> PathStatus:
        """What stands at a path relative to the root; contents only if `read`."""
        if not _is_plain(path):
            return PathStatus(problem="that is no plain path below it", culprit=path, outside=True)
        full = f"{self.real}/{path}"
        try:
            status = os.lstat(full)
            if stat.S_ISLNK(status.st_mode):
                return self._link(path, full, read)
            if not stat.S_ISREG(status.st_mode):
                what = "a folder" if stat.S_ISDIR(status.st_mode) else "something that is no file"
                return PathStatus(exists=True, problem=f"{what} stands there", culprit=path)
            found = PathStatus(exists=True, data=contents(full) if read else None, mode=stat.S_IMODE(status.st_mode))
        except FileNotFoundError:
            found = NOTHING
        except NotADirectoryError:
            return self._blocked(path)
        except OSError as error:
            found = PathStatus(problem=in_words(error), culprit=path)
        folder = path.rpartition("/")[0]
        if not self._is_inside(self._real_folder(f"{self.real}/{folder}")):
            return replace(self._blocked(path), exists=found.exists, outside=True)
        return found

    def _link(self, path: str, full: str, read: bool) -> PathStatus:
        if not self._is_inside(os.path.realpath(full)):
            return PathStatus(exists=True, problem=f"it is a link to {os.readlink(full)}", culprit=path, outside=True)
        try:
            if not stat.S_ISREG(os.stat(full).st_mode):
                return PathStatus(exists=True, problem="a link to something that is no file stands there", culprit=path)
            return PathStatus(exists=True, data=contents(full) if read else None)
        except FileNotFoundError:
            return PathStatus(exists=True, data=b"" if read else None)

    def _blocked(self, path: str) -> PathStatus:
        """Which folder of a path is none, or is a link that leads away."""
        for folder in folders_of(path):
            full = f"{self.real}/{folder}"
            if os.path.islink(full) and not self._is_inside(os.path.realpath(full)):
                return PathStatus(problem=f"'{folder}' is a link to {os.readlink(full)}", culprit=folder)
            if not os.path.isdir(full):
                return PathStatus(problem=f"'{folder}' is no folder", culprit=folder)
        return PathStatus(problem=f"'{self.path}' is no folder", culprit=".")

    def _is_inside(self, real: str) -> bool:
        return real == self.real or real.startswith(self.real.rstrip("/") + "/")


def folders_of(path: str) -> list[str]:
    """The folders that a path leads through, outer ones first."""
    return list(accumulate(path.split("/")[:-1], "{}/{}".format))


def contents(path: str) -> bytes:
    return whole(path)[0]


def in_words(error: OSError) -> str:
    text = error.strerror or str(error)
    return text[:1].lower() + text[1:]


def _is_plain(path: str) -> bool:
    """A relative path that says only where to go down."""
    return "\0" not in path and all(part not in ("", ".", "..") for part in path.split("/"))
