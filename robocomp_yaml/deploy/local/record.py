"""The record of a running supervisor: a file that exists while the supervisor runs. After a kill, it remains.

It contains the pid and the start time of the supervisor's keeper, because a pid can be reused.
"""

from __future__ import annotations

import contextlib
import os
import signal
import time

from robocomp_yaml.deploy.local import procfs

_FILE = "state/supervisor"
_PATIENCE = 5.0  # seconds in which killed processes end


def write(folder: str, keeper: int) -> None:
    process = procfs.entry(keeper)
    descriptor = os.open(f"{folder}/{_FILE}", os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
    with open(descriptor, "w", encoding="ascii") as file:
        file.write(f"{keeper} {process.start if process else 0}\n")


def remove(folder: str) -> None:
    with contextlib.suppress(FileNotFoundError):
        os.unlink(f"{folder}/{_FILE}")


def was_killed(folder: str) -> bool:
    """Whether the last supervisor and its keeper ended without removing the record."""
    try:
        with open(f"{folder}/{_FILE}", encoding="ascii", errors="replace") as file:
            words = file.read().split()
    except OSError:
        return False
    keeper = procfs.entry(int(words[0])) if words and words[0].isdigit() else None
    return keeper is None or keeper.is_dead or words[1:] != [str(keeper.start)]


def is_there(folder: str) -> bool:
    return os.path.exists(f"{folder}/{_FILE}")


def clear_up(folder: str) -> list[str]:
    """Kills the processes that a killed supervisor left when its keeper was killed, too. Returns their commands."""
    left = {pid: procfs.command_line(pid) for pid in procfs.marked(folder) if pid != os.getpid()}
    until = time.monotonic() + _PATIENCE
    while (rest := [pid for pid in left if _runs(pid)]) and time.monotonic() < until:
        for pid in rest:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(0.01)
    remove(folder)
    return list(left.values())


def _runs(pid: int) -> bool:
    process = procfs.entry(pid)
    return process is not None and not process.is_dead
