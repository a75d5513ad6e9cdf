"""Whether this machine can run a program, told from its file: before it is started, and without starting it."""

from __future__ import annotations

import errno
import os
import shutil
import sys
from collections.abc import Mapping

_HEAD = 256  # bytes in which a script names its interpreter
_KIND = slice(4, 6)  # of an ELF file: how wide its addresses are, and in which order their bytes
_MACHINE = slice(18, 20)


def find(program: str, folder: str, environment: Mapping[str, str]) -> str:
    """The file that a command's first word names. Raises OSError, with the reason, where it cannot be run here."""
    if "/" in program:
        path = os.path.join(folder or "/", program)
    else:
        found = shutil.which(program, path=environment.get("PATH", os.defpath))
        if not found:
            raise FileNotFoundError(errno.ENOENT, f"no program '{program}' is in the PATH")
        path = os.path.join(folder or "/", found)
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, f"there is no file '{path}'")
    if not (os.path.isfile(path) and os.access(path, os.X_OK)):
        raise PermissionError(errno.EACCES, f"'{path}' is no program that may be run")
    _look_into(path)
    return path


def _look_into(path: str) -> None:
    try:
        head = _head(path)
    except PermissionError:
        return  # it may be run, though not read
    if head.startswith(b"#!"):
        interpreter = os.fsdecode(head[2:].split(b"\n")[0].split()[0]) if head[2:].split() else ""
        if not os.access(interpreter, os.X_OK):
            raise FileNotFoundError(errno.ENOENT, f"'{path}' is run by '{interpreter}', which is not there")
    elif not _is_of_this_machine(head):
        raise OSError(errno.ENOEXEC, f"'{path}' is no program of this kind of machine")


def _is_of_this_machine(head: bytes) -> bool:
    """By what the program has in common that runs right now."""
    ours = _head(os.path.realpath(sys.executable))
    return head[:4] == ours[:4] and head[_KIND] == ours[_KIND] and head[_MACHINE] == ours[_MACHINE]


def _head(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read(_HEAD)
