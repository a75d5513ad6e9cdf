"""Checks of what a process is started with: its program, and the files of its variables."""

from __future__ import annotations

import errno
import functools
import os
import shutil
import stat
import sys
from collections.abc import Iterable, Mapping

LONGEST = (1 << 17) - 1  # bytes: Linux limits the length of `NAME=VALUE`

_HEAD = 256  # bytes that contain the interpreter of a script
_KIND = slice(4, 6)  # of an ELF file: the width and the byte order of its addresses
_MACHINE = slice(18, 20)


def find(program: str, folder: str, environment: Mapping[str, str]) -> str:
    """The path of a program, by the first word of a command. Raises OSError with the reason if this machine cannot run
    it. The program is not started."""
    if "/" in program:
        path = os.path.join(folder or "/", program)
    else:
        found = shutil.which(program, path=environment.get("PATH", os.defpath))
        if not found:
            raise FileNotFoundError(errno.ENOENT, f"PATH contains no program '{program}'")
        path = os.path.join(folder or "/", found)
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, f"the file '{path}' is missing")
    if not (os.path.isfile(path) and os.access(path, os.X_OK)):
        raise PermissionError(errno.EACCES, f"'{path}' is not executable")
    _look_into(path)
    return path


def _look_into(path: str) -> None:
    try:
        head = _head(path)
    except PermissionError:
        return  # it is executable, but not readable
    if head.startswith(b"#!"):
        interpreter = os.fsdecode(head[2:].split(b"\n")[0].split()[0]) if head[2:].split() else ""
        if not os.access(interpreter, os.X_OK):
            raise FileNotFoundError(errno.ENOENT, f"'{path}' needs the interpreter '{interpreter}', which is missing")
    elif not _is_for_this_machine(head):
        raise OSError(errno.ENOEXEC, f"'{path}' is not a program for this kind of machine")


def _is_for_this_machine(head: bytes) -> bool:
    """Whether a program is for this machine, by comparison with the running Python."""
    own = _own_head()
    return head[:4] == own[:4] and head[_KIND] == own[_KIND] and head[_MACHINE] == own[_MACHINE]


@functools.cache
def _own_head() -> bytes:
    return _head(os.path.realpath(sys.executable))


def _head(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read(_HEAD)


def variables(files: Iterable[tuple[str, str]]) -> dict[str, str]:
    """The variables whose values are texts of files, by pairs of a name and a path. Raises OSError with the reason."""
    return {name: _value(name, path) for name, path in files}


def _value(name: str, path: str) -> str:
    """The text of a file without a line end at its end."""
    try:
        descriptor = os.open(os.path.expanduser(path), os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        try:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):  # to open another kind of file can block
                raise _unusable(name, path, "which is not a regular file")
            with open(descriptor, "rb", closefd=False) as file:
                raw = file.read(LONGEST + 3)
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.filename is None:
            raise
        raise _unusable(name, path, f"which cannot be read: {(error.strerror or str(error)).lower()}") from None
    if raw.endswith(b"\n"):
        raw = raw[: -2 if raw.endswith(b"\r\n") else -1]
    if b"\0" in raw:
        raise _unusable(name, path, "which contains a NUL")
    if len(name) + 1 + len(raw) > LONGEST:
        raise _unusable(name, path, "which is longer than a variable can be")
    return os.fsdecode(raw)


def _unusable(name: str, path: str, why: str) -> OSError:
    return OSError(errno.EINVAL, f"the variable {name} is the text of {path}, {why}")
