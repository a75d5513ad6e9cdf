"""Processes are tied to the process that started them, by system calls of Linux that Python's `os` lacks."""

from __future__ import annotations

import contextlib
import functools
import os
import resource
import shutil
import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ctypes import CDLL

_SET_DEATH_SIGNAL, _SET_CHILD_SUBREAPER = 1, 36


@functools.cache
def _libc() -> CDLL:
    import ctypes  # most commands only import this module

    return ctypes.CDLL(None, use_errno=True)


def adopt_orphans() -> None:
    """From now on, a descendant of this process that loses its parent becomes a child of this process, not of init.
    Raises OSError."""
    if _libc().prctl(_SET_CHILD_SUBREAPER, 1, 0, 0, 0):
        import ctypes

        raise OSError(ctypes.get_errno(), "cannot become the parent of orphans")


def death_with_this() -> Callable[[], None]:
    """For a new process before `exec`: the kernel kills it when this process ends, for whatever reason."""
    _libc()  # between fork and exec, nothing may be imported
    return functools.partial(_die_with, os.getpid())


def _die_with(parent: int) -> None:
    if not signal_at_end_of(parent, signal.SIGKILL):
        os._exit(1)


def signal_at_end_of(parent: int, number: int) -> bool:
    """From now on, the kernel sends this signal to this process when `parent` ends, for whatever reason. Returns False
    if it has already ended."""
    _libc().prctl(_SET_DEATH_SIGNAL, number, 0, 0, 0)
    return os.getppid() == parent


@functools.cache
def tie() -> tuple[str, ...]:
    """The words before a command that make the kernel kill its process when the parent ends; () if the system lacks the
    program. The alternative, `death_with_this`, takes a fork of this process, which is far slower."""
    found = shutil.which("setpriv", path=os.defpath)
    return (found, "--pdeathsig", "KILL", "--") if found else ()


class OpenFiles:
    """The limit of open files: the supervisor raises its own, and its children get the original one."""

    def __init__(self) -> None:
        self._soft, self._hard = resource.getrlimit(resource.RLIMIT_NOFILE)

    def raise_limit(self) -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (self._hard, self._hard))

    def restore(self, pid: int) -> None:
        if self._soft != self._hard:
            with contextlib.suppress(ProcessLookupError):
                resource.prlimit(pid, resource.RLIMIT_NOFILE, (self._soft, self._hard))
