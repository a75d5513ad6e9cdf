"""Processes as in /proc: which belong together, what they use, and which listen on a TCP port.

Processes start and end while /proc is read. A process that has ended is skipped.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from typing import NamedTuple

from robocomp_yaml import secrets
from robocomp_yaml.digraph import reachable
from robocomp_yaml.grouping import grouped

MARK = "RCYAML_PROCESS"
"""The variable in the environment of each process of a deployment, and of its descendants: `FOLDER:NAME`."""

_TICKS = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")
_LISTEN = "0A"
_MOMENT = 0.02  # seconds


class ProcessEntry(NamedTuple):
    """A process. `start` is in clock ticks since boot, so that (pid, start) is unique. `cpu` is in seconds. `is_halted`
    is False for one that a debugger halts."""

    pid: int
    parent: int
    group: int
    session: int
    start: int
    cpu: float
    is_dead: bool
    is_halted: bool


def pids() -> Iterator[int]:
    return (int(name) for name in os.listdir("/proc") if name.isdigit())


def entry(pid: int) -> ProcessEntry | None:
    """The process of this pid, None if there is none."""
    text = _read(f"/proc/{pid}/stat")
    if not text:
        return None
    # The name, in parentheses, can contain any character.
    fields = text[text.rindex(b")") + 2 :].split()
    return ProcessEntry(
        pid, int(fields[1]), int(fields[2]), int(fields[3]), int(fields[19]),
        (int(fields[11]) + int(fields[12])) / _TICKS, fields[0] in (b"Z", b"X"), fields[0] == b"T",
    )  # fmt: skip


def table() -> dict[int, ProcessEntry]:
    """All running processes by pid."""
    found = (entry(pid) for pid in pids())
    return {one.pid: one for one in found if one and not one.is_dead}


def mark_of(pid: int) -> str:
    """The MARK in the initial environment of a process; '' without one, and for processes of other users."""
    prefix = f"{MARK}=".encode()
    for part in _read(f"/proc/{pid}/environ").split(b"\0"):
        if part.startswith(prefix):
            return os.fsdecode(part[len(prefix) :])
    return ""


def marked(folder: str) -> list[int]:
    """The pids of all processes with the mark of the deployment in this folder."""
    return [pid for pid in pids() if mark_of(pid).rpartition(":")[0] == folder]


def halted(folder: str) -> list[int]:
    """The pids of what supervises the deployment in this folder and is halted."""
    return [one.pid for one in table().values() if one.is_halted and mark_of(one.pid) == f"{folder}:"]


def families(roots: Mapping[int, str], adopter: int, alive: Mapping[int, ProcessEntry]) -> dict[int, set[int]]:
    """The family of each root among the running processes: the root, its session, orphans with its mark (which are now
    children of `adopter`), and the descendants of all these. `roots` has the mark of each root."""
    by_mark = {mark: root for root, mark in roots.items()}
    found: dict[int, set[int]] = {root: set() for root in roots}
    owners: dict[int, int] = {}
    for pid in alive:
        line = []
        while pid in alive and pid not in owners:
            line.append(pid)
            owners[pid] = _root_of(alive[pid], roots, by_mark, adopter)
            if owners[pid] or alive[pid].parent == adopter:
                break
            pid = alive[pid].parent
        owner = owners.get(pid, 0)
        for member in line:
            owners[member] = owner
            if owner:
                found[owner].add(member)
    return found


def _root_of(one: ProcessEntry, roots: Collection[int], by_mark: Mapping[str, int], adopter: int) -> int:
    """The root to which a process belongs by its own facts; 0 if only its parent can tell."""
    if one.pid in roots:
        return one.pid
    if one.session in roots:
        return one.session
    return by_mark.get(mark_of(one.pid), 0) if one.parent == adopter else 0


class Families:
    """The families of a supervisor's children. `roots` returns the roots with their marks, including roots that have
    ended, whose descendants may be running."""

    def __init__(self, roots: Callable[[], Mapping[int, str]]) -> None:
        self._roots = roots
        self._taken = -_MOMENT
        self._found: dict[int, set[int]] = {}
        self.alive: dict[int, ProcessEntry] = {}

    def now(self) -> dict[int, set[int]]:
        """The current family of each root."""
        self.alive = table()
        self._found = families(self._roots(), os.getpid(), self.alive)
        self._taken = time.monotonic()
        return self._found

    def recent(self, root: int) -> set[int]:
        """A family, at most some milliseconds old. That is enough to wait for its end, because a family without a
        running process cannot get one."""
        if root not in self._found or time.monotonic() > self._taken + _MOMENT:
            self.now()
        return self._found.get(root, set())


def descendants(of: Collection[int], alive: dict[int, ProcessEntry]) -> set[int]:
    """These processes and all their descendants."""
    children = grouped((one.parent, one.pid) for one in alive.values())
    return set(reachable(of, lambda pid: children.get(pid, ())))


def is_traced(members: Collection[int]) -> bool:
    """Whether a debugger is attached to one of these processes."""
    lines = (line for pid in members for line in _read(f"/proc/{pid}/status").splitlines())
    return any(line.startswith(b"TracerPid:") and line.split()[1] != b"0" for line in lines)


def memory(members: Collection[int]) -> int:
    """The resident memory of these processes, in bytes."""
    sizes = (_read(f"/proc/{pid}/statm").split() for pid in members)
    return sum(int(size[1]) for size in sizes if size) * _PAGE


def listeners(ports: Collection[int]) -> dict[int, list[int]]:
    """Those of these TCP ports on which a process listens, with the pids as far as this user can see them."""
    inodes: dict[str, int] = {}
    for file in ("/proc/net/tcp", "/proc/net/tcp6") if ports else ():
        for line in _read(file).decode().splitlines()[1:]:
            fields = line.split()
            port = int(fields[1].rpartition(":")[2], 16)
            if fields[3] == _LISTEN and port in ports:
                inodes[f"socket:[{fields[9]}]"] = port
    found: dict[int, list[int]] = {port: [] for port in inodes.values()}
    for pid in pids() if inodes else ():
        for port in {inodes[link] for link in _open_files(pid) if link in inodes}:
            found[port].append(pid)
    return found


def send(pid: int, number: int) -> None:
    """Sends a signal to a process. One that has ended, or is not the user's, is ignored."""
    with suppress(OSError):
        os.kill(pid, number)


def command(pid: int) -> list[str]:
    """The words of a process's command; [''] if it has ended."""
    return os.fsdecode(_read(f"/proc/{pid}/cmdline").rstrip(b"\0")).split("\0")


def command_line(pid: int) -> str:
    """A process's command in one line, without secrets; '' if it has ended."""
    return secrets.command(command(pid)).replace("\n", r"\n")


def _open_files(pid: int) -> Iterator[str]:
    folder = f"/proc/{pid}/fd"
    try:
        names = os.listdir(folder)
    except OSError:
        return
    for name in names:
        try:
            yield os.readlink(f"{folder}/{name}")
        except OSError:
            continue


def _read(path: str) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return b""
