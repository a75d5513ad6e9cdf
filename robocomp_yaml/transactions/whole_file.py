"""One file written whole or not at all, even where the disk is full or the process is killed in the middle.

What many files have to do together is `atomic`'s, which stages them by the same means.
"""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator

_NOT_HERE = (
    errno.EISDIR, errno.EOPNOTSUPP, errno.EINVAL, errno.ENOENT, errno.EXDEV, errno.EPERM, errno.ENOSYS, errno.EMLINK,
)  # fmt: skip


def create(path: str | os.PathLike[str], text: str) -> None:
    """A new file. Raises FileExistsError where something stands, which stays as it is, and OSError."""
    target = os.fspath(path)
    try:
        content = text.encode()
    except UnicodeEncodeError:
        raise OSError(errno.EILSEQ, "it would hold a name that is no UTF-8 text", target) from None
    try:
        _create_from_nameless(target, content)
    except OSError as error:
        if error.errno not in _NOT_HERE:
            error.filename, error.filename2 = target, None
            raise
        with _part(target, content) as part:
            if os.path.lexists(target):
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), target) from None
            os.rename(part, target)


def _create_from_nameless(target: str, content: bytes) -> None:
    """The file has no name until it is whole, so that nothing is left of it where it does not come to that."""
    opened = os.open(os.path.dirname(target) or ".", os.O_WRONLY | os.O_TMPFILE, 0o666)
    with os.fdopen(opened, "wb") as file:
        file.write(content)
        file.flush()
        os.link(f"/proc/self/fd/{opened}", target, src_dir_fd=opened, follow_symlinks=True)


def put(path: str | os.PathLike[str], content: bytes, mode: int | None = None) -> None:
    """A file under a name, in the place of whatever stands there, a link too. Raises OSError."""
    target = os.fspath(path)
    with _part(target, content, mode) as part:
        os.replace(part, target)


def replace(path: str | os.PathLike[str], content: bytes) -> None:
    """Another content for a file, which keeps its permissions, or a first one. What is no file, such as a pipe, just
    gets it. Raises OSError."""
    target = os.path.realpath(path)
    mode = os.stat(target).st_mode if os.path.exists(target) else None
    if mode is not None and not stat.S_ISREG(mode):
        with open(target, "wb") as file:
            file.write(content)
        return
    put(target, content, None if mode is None else stat.S_IMODE(mode))


def stage(path: str, content: bytes, mode: int | None = None, default: int = 0o666) -> None:
    """A first content for a name that only its owner knows: the file is not whole until this comes back. It gets the
    permissions `mode`, else `default` as far as the user lets new files have them. Raises OSError."""
    first = default if mode is None else mode & 0o700  # never more than it may have in the end
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, first)
    try:
        if mode is not None:
            os.fchmod(file, mode)
        rest = memoryview(content)
        while rest:
            rest = rest[os.write(file, rest) :]
    finally:
        os.close(file)


@contextlib.contextmanager
def _part(target: str, content: bytes, mode: int | None = None) -> Iterator[str]:
    """The content in a file beside the target, which is gone afterwards."""
    folder, name = os.path.split(target)
    _clean_up(folder, name)
    part = os.path.join(folder, f".{name}.{os.getpid()}.part")
    try:
        stage(part, content, mode)
        yield part
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(part)


def _clean_up(folder: str, name: str) -> None:
    """Takes away what a process left that was killed."""
    with contextlib.suppress(OSError):
        for other in os.listdir(folder or "."):
            pid = other.removeprefix(f".{name}.").removesuffix(".part")
            if other == f".{name}.{pid}.part" and pid.isdigit() and not os.path.exists(f"/proc/{pid}"):
                os.unlink(os.path.join(folder, other))
