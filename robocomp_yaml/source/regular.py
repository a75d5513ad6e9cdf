"""`open(path, opener=regular)` opens regular files only. Pipes and devices may block or be endless, and a link in an
untrusted folder may lead to one."""

from __future__ import annotations

import errno
import os
import stat
import sys

_FLAGS = os.O_NONBLOCK | os.O_CLOEXEC


def regular(path: str, flags: int) -> int:
    """An opener for open(): returns the descriptor of a regular file. Raises OSError for anything else."""
    return _opened(path, flags)[0]


def text(path: str, encoding: str = "utf-8") -> str | None:
    """The text of a regular file, with invalid bytes replaced; None if it cannot be read."""
    try:
        with open(path, encoding=encoding, errors="replace", opener=regular) as file:
            return file.read()
    except OSError:
        return None


def content(path: str, size: int = -1) -> bytes | None:
    """The bytes of a regular file, at most `size` if it is set; None if it cannot be read."""
    try:
        with open(path, "rb", opener=regular) as file:
            return file.read(size)
    except OSError:
        return None


def whole(path: str, *, is_regular: bool = False, limit: int = sys.maxsize) -> tuple[bytes, os.stat_result]:
    """The bytes and the status of a regular file, with a third of the system calls of open(). Raises OSError.
    `is_regular`: that it is one was seen just before. Of a file of more than `limit` bytes, the content may be missing
    or incomplete."""
    opened, status = _opened(path, os.O_RDONLY, is_regular=is_regular)
    try:
        if status.st_size > limit:
            return b"", status
        data = os.read(opened, status.st_size + 1)
        if len(data) != status.st_size:  # it may grow meanwhile
            while len(data) <= limit and (more := os.read(opened, 1 << 20)):
                data += more
    finally:
        os.close(opened)
    return data, status


def _opened(path: str, flags: int, *, is_regular: bool = False) -> tuple[int, os.stat_result]:
    if not is_regular:
        _refuse_special(path, os.stat(path))  # before opening it, which can have effects on a device
    opened = os.open(path, flags | _FLAGS)
    try:
        status = os.fstat(opened)
        _refuse_special(path, status)
    except OSError:
        os.close(opened)
        raise
    return opened, status


def _refuse_special(path: str, status: os.stat_result) -> None:
    if stat.S_ISREG(status.st_mode):
        return
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    raise OSError(errno.EINVAL, "it is not a regular file", path)
