"""One file that is written whole or not at all, whatever ends the run meanwhile: a full disk, a signal, a crash."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterator


def create(path: str, text: str) -> None:
    """Writes a text where nothing stands yet. Raises OSError, FileExistsError where something does."""
    try:
        data = text.encode()
    except UnicodeEncodeError:
        raise OSError(errno.EILSEQ, "it would hold a name that is no UTF-8 text", path) from None
    with _part(path, data, None) as part:
        try:
            os.link(part, path)
        except FileExistsError:
            raise
        except OSError:  # a file system without links
            if os.path.lexists(path):
                raise FileExistsError(path) from None
            os.rename(part, path)


def replace(path: str, data: bytes) -> None:
    """Gives a file another content, with the same permissions, or writes it; a link stays one. Raises OSError."""
    target = os.path.realpath(path)
    mode = None
    with contextlib.suppress(FileNotFoundError):
        status = os.stat(target)
        mode = stat.S_IMODE(status.st_mode)
        if not stat.S_ISREG(status.st_mode):  # a device or a pipe has no other content
            with open(target, "wb") as file:
                file.write(data)
            return
    with _part(target, data, mode) as part:
        os.replace(part, target)


@contextlib.contextmanager
def _part(path: str, data: bytes, mode: int | None) -> Iterator[str]:
    """A file beside another one, with what that is to hold; it is gone in the end."""
    try:
        descriptor, part = tempfile.mkstemp(prefix=".rcyaml-", dir=os.path.dirname(path) or ".")
    except OSError as error:
        error.filename = path  # which is what the user knows
        raise
    try:
        with open(descriptor, "wb") as file:
            file.write(data)
            if mode is None:
                mask = os.umask(0)
                os.umask(mask)
                mode = 0o666 & ~mask
            os.fchmod(file.fileno(), mode)
        yield part
    finally:
        with contextlib.suppress(OSError):
            os.unlink(part)
