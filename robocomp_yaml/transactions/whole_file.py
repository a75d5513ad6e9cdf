"""Atomic writing of one file, even if the disk is full or the process is killed.

Transactions of several files are in `atomic`, which stages files with the functions of this module.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import stat
from collections.abc import Iterator

_UNSUPPORTED = (
    errno.EISDIR, errno.EOPNOTSUPP, errno.EINVAL, errno.ENOENT, errno.EXDEV, errno.EPERM, errno.ENOSYS, errno.EMLINK,
)  # fmt: skip


def ignore_all(folder: str, comment: str = "") -> None:
    """Makes git ignore all of a folder, unless it has a file that says otherwise. Raises OSError."""
    with contextlib.suppress(FileExistsError), open(f"{folder}/.gitignore", "x", encoding="utf-8") as file:
        file.write(f"{comment}*\n")


def lock(opened: int) -> bool:
    """Locks an open file or folder until it is closed. Returns False if another one has the lock. Raises OSError."""
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def create(path: str | os.PathLike[str], text: str) -> None:
    """Creates a file. Raises FileExistsError if the path exists, which is left unchanged, and OSError."""
    target = os.fspath(path)
    try:
        content = text.encode()
    except UnicodeEncodeError:
        raise OSError(errno.EILSEQ, "it would contain a name that is not UTF-8 text", target) from None
    try:
        _create_unnamed(target, content)
    except OSError as error:
        if error.errno not in _UNSUPPORTED:
            error.filename, error.filename2 = target, None
            raise
        with _part(target, content) as part:
            if os.path.lexists(target):
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), target) from None
            os.rename(part, target)


def _create_unnamed(target: str, content: bytes) -> None:
    """The file has no name until it is complete, so that a killed process leaves nothing."""
    opened = os.open(os.path.dirname(target) or ".", os.O_WRONLY | os.O_TMPFILE, 0o666)
    with os.fdopen(opened, "wb") as file:
        file.write(content)
        file.flush()
        os.link(f"/proc/self/fd/{opened}", target, src_dir_fd=opened, follow_symlinks=True)


def put(path: str | os.PathLike[str], content: bytes, mode: int | None = None) -> None:
    """Writes a file, which replaces what is at the path, even a link. Raises OSError."""
    target = os.fspath(path)
    with _part(target, content, mode) as part:
        os.replace(part, target)


def replace(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes the content of a new file, or of an existing one, which keeps its permissions. Into a pipe or a device the
    content is written directly. Raises OSError."""
    target = os.path.realpath(path)
    mode = os.stat(target).st_mode if os.path.exists(target) else None
    if mode is not None and not stat.S_ISREG(mode):
        with open(target, "wb") as file:
            file.write(content)
        return
    put(target, content, None if mode is None else stat.S_IMODE(mode))


def stage(path: str, content: bytes, mode: int | None = None, default: int = 0o666) -> None:
    """Creates a file under a name that no other process uses; the file is complete when the function returns. It has
    the permissions `mode`, or `default` less the umask. Raises OSError."""
    first = default if mode is None else mode & 0o700  # never more than the final permissions
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
    """A temporary file beside the target, with the content."""
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
    """Removes the temporary files of killed processes."""
    with contextlib.suppress(OSError):
        for other in os.listdir(folder or "."):
            pid = other.removeprefix(f".{name}.").removesuffix(".part")
            if other == f".{name}.{pid}.part" and pid.isdigit() and not os.path.exists(f"/proc/{pid}"):
                os.unlink(os.path.join(folder, other))
