"""What ties processes to the one that started them: two services of Linux that Python's `os` does not offer."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import resource
import shutil
import signal

_SET_DEATH_SIGNAL, _SET_CHILD_SUBREAPER = 1, 36
_libc = ctypes.CDLL(None, use_errno=True)


def adopt_orphans() -> None:
    """From now on, a descendant of this process that loses its parent becomes its child, and not that of init."""
    if _libc.prctl(_SET_CHILD_SUBREAPER, 1, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "cannot become the parent of orphans")


def die_with(parent: int) -> None:
    """For a new process, before it becomes its program: it is killed when `parent` ends, however that happens."""
    _libc.prctl(_SET_DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:  # that had ended already
        os._exit(1)


@functools.cache
def tie() -> tuple[str, ...]:
    """What stands before a command, so that its process is killed when its parent ends; () where the system does not
    have it. To do the same in the new process itself (`die_with`) takes a copy of this one, which costs far more."""
    found = shutil.which("setpriv", path=os.defpath)
    return (found, "--pdeathsig", "KILL", "--") if found else ()


class OpenFiles:
    """The limit of open files: as high as may be for one that watches many processes, as it was for these."""

    def __init__(self) -> None:
        self._soft, self._hard = resource.getrlimit(resource.RLIMIT_NOFILE)

    def raise_limit(self) -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (self._hard, self._hard))

    def restore(self, pid: int) -> None:
        if self._soft != self._hard:
            with contextlib.suppress(ProcessLookupError):
                resource.prlimit(pid, resource.RLIMIT_NOFILE, (self._soft, self._hard))
