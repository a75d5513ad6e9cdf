"""Opening only what has an end: with `open(path, opener=regular)`, pipes and devices are errors. They may be endless,
or never begin, and a link in anybody's folder may lead to one."""

from __future__ import annotations

import errno
import os
import stat


def regular(path: str, flags: int) -> int:
    """What open() asks of an opener, for reading: a descriptor of a regular file."""
    _refuse_special(path, os.stat(path))  # before it is opened, which may do something to a device
    opened = os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        _refuse_special(path, os.fstat(opened))
    except OSError:
        os.close(opened)
        raise
    return opened


def _refuse_special(path: str, status: os.stat_result) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "it is no regular file", path)
