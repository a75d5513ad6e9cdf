"""The status of processes, from IceGrid's states of servers and the status files of `run` scripts."""

from __future__ import annotations

import time
from collections.abc import Mapping

import msgspec

from robocomp_yaml.deploy.engine import LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.here import is_near
from robocomp_yaml.deploy.icegrid.grid import GridSession
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ALIVE, OVER

_ACTIVE = ("Active", "Activating", "Deactivating")


class RunStatus(msgspec.Struct, frozen=True):
    """The status file of a `run` script. `runner` is the pid of the script, `pid` that of its process. The time of the
    last change is `since`, in milliseconds since the host booted, and `at`, in microseconds of the host's clock.
    `spread` is as in `Running`, and `not_alive` says why a running process is not alive."""

    state: str
    runner: int
    pid: int
    since: int
    at: int
    restarts: int
    last_exit: str
    spread: float | None = None
    not_alive: str = ""


def of_text(text: str) -> RunStatus | None:
    """The status in a text, None if the text is not valid."""
    try:
        state, runner, pid, since, at, counts, last_exit = text.strip().split("|", 6)
        restarts, _, spread = counts.partition("/")
        state, _, not_alive = state.partition(", ")
        return RunStatus(
            state, int(runner), int(pid), int(since), int(at), int(restarts), last_exit,
            int(spread) / 1000 if spread else None, not_alive,
        )  # fmt: skip
    except ValueError:
        return None


def run_status(grid: GridSession, name: str, host: str, *, is_local: bool) -> RunStatus | None:
    """The status of a process by its `run`, None if there is none yet."""
    path = grid.files.on(host).status(name)
    if not is_local:
        return of_text("\n".join(grid.read(name, path)))
    try:
        with open(path, encoding="utf-8") as file:
            return of_text(file.read())
    except OSError:
        return None


def is_over(grid: GridSession, name: str, host: str, *, is_local: bool) -> bool:
    """Whether a process has ended for good, by its policy."""
    last = run_status(grid, name, host, is_local=is_local)
    return last is not None and last.state in OVER


def observe(grid: GridSession, specs: Mapping[str, ProcessSpec | None], hosts: Mapping[str, str]) -> dict[str, Running]:
    """The actual state of all processes. `hosts` has the host of a process without a valid spec. If the `run` of a
    process runs on this machine, its state does not need IceGrid."""
    desired = grid.files.desired()
    local = {spec.process.host: is_near(spec) for spec in specs.values() if spec}
    near = {
        name: run_status(grid, name, spec.process.host, is_local=True)
        for name, spec in specs.items()
        if spec and local[spec.process.host]
    }
    alive = procfs.table() if near else {}
    runners = {name: last.runner for name, last in near.items() if last and _is_alive(grid.files, name, last, alive)}
    states = {name: ("Active", runner) for name, runner in runners.items()}
    states |= grid.states(name for name in specs if name not in runners)
    found: dict[str, Running] = {}
    for name, spec in specs.items():
        state, runner = states[name]
        host = spec.process.host if spec else hosts.get(name, "")
        if not state:
            found[name] = Running(name, spec, host, LOST if name in desired else STOPPED)
            continue
        # IceGrid was asked after the status file was read, which may have changed.
        last = near[name] if name in runners else run_status(grid, name, host, is_local=name in near)
        found[name] = _running(name, spec, host, state, runner, last, name in desired, alive if name in near else None)
    return found


def _is_alive(files: GridFiles, name: str, last: RunStatus, alive: Mapping[int, procfs.ProcessEntry]) -> bool:
    """Whether the `run` of a status runs now: its pid can be reused."""
    is_alive = last.state in ALIVE and last.runner in alive
    return is_alive and procfs.command(last.runner)[2:4] == [name, files.folder]


def _running(
    name: str, spec: ProcessSpec | None, host: str, state: str, runner: int, last: RunStatus | None, is_desired: bool,
    alive: dict[int, procfs.ProcessEntry] | None,
) -> Running:  # fmt: skip
    if state in _ACTIVE and (last is None or last.runner != runner or last.state not in ALIVE):
        # It has just been started.
        return Running(name, spec, host, RUNNING, runner, memory=None, cpu=None)
    if last is None:
        return Running(name, spec, host, WAITING if is_desired else STOPPED)
    if state in _ACTIVE or (last.state in OVER and is_desired):
        now = last.state
    else:  # its `run` or its node was killed, and the keeper will restart it
        now = WAITING if is_desired else STOPPED
    members = procfs.descendants({last.pid}, alive) & set(alive) if alive is not None and now == RUNNING else set()
    return Running(
        name, spec, host, now, last.pid if now == RUNNING else 0, _seconds_since(last, alive is not None),
        last.restarts, last.last_exit, None if alive is None else procfs.memory(members),
        None if alive is None else sum(alive[pid].cpu for pid in members), last.spread,
        not_alive=last.not_alive if now == RUNNING else "",
    )  # fmt: skip


def _seconds_since(last: RunStatus, is_near: bool) -> float:
    """Seconds since the last change: for this machine by a monotonic clock, else by the host's clock."""
    if is_near:
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - last.since / 1000)
    return max(0.0, time.time() - last.at / 1e6)
