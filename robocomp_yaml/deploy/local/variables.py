"""Variables of the environment that a file holds (`{file: PATH}`), read whenever a process starts."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable

LONGEST = (1 << 17) - 1  # bytes: Linux gives no program a longer `NAME=VALUE`


def from_files(files: Iterable[tuple[str, str]]) -> dict[str, str]:
    """The variables of pairs of a name and a path. Raises OSError, with the reason."""
    return {name: _value(name, path) for name, path in files}


def _value(name: str, path: str) -> str:
    """The text of a file, without one line end at its end."""
    try:
        descriptor = os.open(os.path.expanduser(path), os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        try:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):  # what is none could block
                raise _unusable(name, path, "which is no regular file")
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
        raise _unusable(name, path, "which holds a NUL")
    if len(name) + 1 + len(raw) > LONGEST:
        raise _unusable(name, path, "which is longer than a variable can be")
    return os.fsdecode(raw)


def _unusable(name: str, path: str, why: str) -> OSError:
    return OSError(errno.EINVAL, f"the variable {name} is the text of {path}, {why}")
