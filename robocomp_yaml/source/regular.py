"""Opening only what has an end: with `open(path, opener=regular)`, pipes and devices are errors. They may be endless,
or never begin, and a link in anybody's folder may lead to one."""

from __future__ import annotations

import errno
import os
import stat


def regular(path: str, flags: int) -> int:
    """What open() asks of an opener, for reading: a descriptor of a regular file."""
    return _opened(path, flags)[0]


def text(path: str, encoding: str = "utf-8") -> str | None:
    """The text of a regular file, whatever its bytes are; None where there is none that can be read."""
    try:
        with open(path, encoding=encoding, errors="replace", opener=regular) as file:
            return file.read()
    except OSError:
        return None


def whole(path: str) -> tuple[bytes, os.stat_result]:
    """The bytes of a regular file and what the disk says of it, with a third of the calls that open() makes."""
    opened, status = _opened(path, os.O_RDONLY)
    try:
        parts = [os.read(opened, status.st_size + 1)]
        while len(parts[-1]) > 0 and (len(parts) > 1 or len(parts[0]) != status.st_size):  # it may grow meanwhile
            parts.append(os.read(opened, 1 << 20))
    finally:
        os.close(opened)
    return b"".join(parts), status


def _opened(path: str, flags: int) -> tuple[int, os.stat_result]:
    _refuse_special(path, os.stat(path))  # before it is opened, which may do something to a device
    opened = os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        status = os.fstat(opened)
        _refuse_special(path, status)
    except OSError:
        os.close(opened)
        raise
    return opened, status


def _refuse_special(path: str, status: os.stat_result) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "it is no regular file", path)
