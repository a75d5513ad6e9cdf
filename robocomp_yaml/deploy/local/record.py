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
    return is_there(folder) and _keeper(folder) is None


def _keeper(folder: str) -> procfs.ProcessEntry | None:
    """The running keeper of the record."""
    try:
        with open(f"{folder}/{_FILE}", encoding="ascii", errors="replace") as file:
            words = file.read().split()
    except OSError:
        return None
    keeper = procfs.entry(int(words[0])) if words and words[0].isdigit() else None
    return None if keeper is None or keeper.is_dead or words[1:] != [str(keeper.start)] else keeper


def supervisor(folder: str) -> int:
    """The pid of the running supervisor, 0 if it is unknown."""
    keeper = _keeper(folder)
    children = (one for one in procfs.table().values() if keeper and one.parent == keeper.pid)
    return next((one.pid for one in children if procfs.mark_of(one.pid) == f"{folder}:"), 0)


def keeps(folder: str, supervisor: int) -> bool:
    """Whether the keeper of the record is that of this supervisor, which may know the folder by an earlier path."""
    keeper, kept = _keeper(folder), procfs.entry(supervisor)
    return keeper is not None and kept is not None and kept.parent == keeper.pid


def continue_halted(folder: str) -> bool:
    """Lets a keeper go on that was halted (SIGSTOP), which does the same for its supervisor. Returns whether it was
    halted."""
    keeper = _keeper(folder)
    if keeper is None or not keeper.is_halted:
        return False
    procfs.send(keeper.pid, signal.SIGCONT)
    return True


def end_hung(folder: str) -> list[str]:
    """Kills a supervisor that does not answer. Its keeper ends the processes; if that hangs, too, it is killed. Returns
    the names of the processes."""
    names = running(folder)
    if pid := supervisor(folder):
        procfs.send(pid, signal.SIGKILL)
        until = time.monotonic() + _PATIENCE
        while _keeper(folder) and time.monotonic() < until:
            time.sleep(0.01)
    clear_up(folder)
    remove(folder)
    return names


def running(folder: str) -> list[str]:
    """The names of the processes that run, by /proc."""
    return sorted({procfs.mark_of(pid).removeprefix(f"{folder}:") for pid in procfs.marked(folder)} - {""})


def is_there(folder: str) -> bool:
    return os.path.exists(f"{folder}/{_FILE}")


def clear_up(folder: str) -> list[str]:
    """Kills the processes that a killed supervisor left when its keeper was killed, too. Returns their commands. The
    record stays: until the deployment is started again or taken down, each command says what happened."""
    left = {pid: procfs.command_line(pid) for pid in procfs.marked(folder) if pid != os.getpid()}
    until = time.monotonic() + _PATIENCE
    while (rest := [pid for pid in left if _runs(pid)]) and time.monotonic() < until:
        for pid in rest:
            procfs.send(pid, signal.SIGKILL)
        time.sleep(0.01)
    return list(left.values())


def _runs(pid: int) -> bool:
    process = procfs.entry(pid)
    return process is not None and not process.is_dead
