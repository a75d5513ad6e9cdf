"""The status of processes, from IceGrid's states of servers and the status files of `run` scripts."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy.engine import LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.here import is_near
from robocomp_yaml.deploy.icegrid.grid import GridSession
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ALIVE, OVER

_MEASURE = "SIGCONT"  # ignored by every program that does not expect it, also by an earlier version of `run`
_MEASURED_WITHIN, _MOMENT = 0.6, 0.01  # seconds
_ACTIVE = ("Active", "Activating", "Deactivating")


class MeasuredUse(msgspec.Struct, frozen=True):
    """What the process with this pid used `at` a time, in milliseconds since its host booted: `memory` in bytes, and
    `cpu` in seconds, both with its descendants."""

    pid: int
    at: int
    memory: int
    cpu: float


class RunStatus(msgspec.Struct, frozen=True):
    """The status file of a `run` script. `runner` is the pid of the script, `pid` that of its process. The time of the
    last change is `since`, in milliseconds since the host booted, and `at`, in microseconds of the host's clock.
    `spread` is as in `Running`, and `not_alive` says why a running process is not alive. `use` is what the process used
    when it was measured."""

    state: str
    runner: int
    pid: int
    since: int
    at: int
    restarts: int
    last_exit: str
    spread: float | None = None
    not_alive: str = ""
    use: MeasuredUse | None = None


def of_text(text: str) -> RunStatus | None:
    """The status in a text, None if the text is not valid."""
    first, _, second = text.partition("\n")
    try:
        state, runner, pid, since, at, counts, last_exit = first.strip().split("|", 6)
        restarts, _, spread = counts.partition("/")
        state, _, not_alive = state.partition(", ")
        return RunStatus(
            state, int(runner), int(pid), int(since), int(at), int(restarts), last_exit,
            int(spread) / 1000 if spread else None, not_alive, _use(second),
        )  # fmt: skip
    except ValueError:
        return None


def _use(line: str) -> MeasuredUse | None:
    try:
        pid, at, memory, cpu = map(int, line.strip().split("|"))
    except ValueError:
        return None
    return MeasuredUse(pid, at, memory, cpu / 1000)


def run_status(grid: GridSession, name: str, host: str, *, is_local: bool) -> RunStatus | None:
    """The status of a process by its `run`, None if there is none yet."""
    if not is_local:
        return of_text("\n".join(grid.read(name, grid.files.on(host).status(name))))
    try:
        with open(grid.files.status(name), encoding="utf-8", errors="replace") as file:
            return of_text(file.read())
    except OSError:
        return None


def is_over(grid: GridSession, name: str, host: str, *, is_local: bool) -> bool:
    """Whether a process has ended for good, by its policy."""
    last = run_status(grid, name, host, is_local=is_local)
    return last is not None and last.state in OVER


def observe(
    grid: GridSession, specs: Mapping[str, ProcessSpec | None], hosts: Mapping[str, str], *, use: bool = False
) -> dict[str, Running]:
    """The actual state of all processes. `hosts` has the host of a process without a valid spec. If the `run` of a
    process runs on this machine, its state does not need IceGrid. With `use`, what processes use is measured now;
    otherwise it is unknown."""
    desired = grid.files.desired()
    local = {spec.process.host: is_near(spec) for spec in specs.values() if spec}
    near = {
        name: run_status(grid, name, spec.process.host, is_local=True)
        for name, spec in specs.items()
        if spec and local[spec.process.host]
    }
    table = procfs.table() if near and use else None
    runners = {name: last.runner for name, last in near.items() if last and _is_alive(grid.files, name, last)}
    states = {name: ("Active", runner) for name, runner in runners.items()}
    states |= grid.states(name for name in specs if name not in runners)
    measured = _measured(grid, specs, near, states, hosts) if use else {}
    found: dict[str, Running] = {}
    for name, spec in specs.items():
        state, runner = states[name]
        host = spec.process.host if spec else hosts.get(name, "")
        if not state:
            found[name] = Running(name, spec, host, LOST if name in desired else STOPPED)
            continue
        # IceGrid was asked after the status file was read, which may have changed.
        last = near[name] if name in runners else run_status(grid, name, host, is_local=name in near)
        now = _running(name, spec, host, state, runner, last, name in desired, measured.get(host), is_near=name in near)
        if table is not None and name in near and now.pid != runner:
            now = _with_use(now, table)
        found[name] = now
    return found


def _measured(
    grid: GridSession, specs: Mapping[str, ProcessSpec | None], near: Collection[str],
    states: Mapping[str, tuple[str, int]], hosts: Mapping[str, str],
) -> dict[str, int]:  # fmt: skip
    """When the processes of each other host were measured, by the clock of `MeasuredUse`. One `run` measures all of a
    host. A host that does not do it in time is missing, as one that an earlier version of rcyaml started."""
    asked: dict[str, tuple[str, int]] = {}
    for name, (state, _) in states.items():
        spec = specs[name]
        host = spec.process.host if spec else hosts.get(name, "")
        if name in near or host in asked or state != "Active":
            continue
        before = run_status(grid, name, host, is_local=False)
        if before is not None and before.state == RUNNING:
            asked[host] = name, before.use.at if before.use else 0
            grid.signal(name, _MEASURE)
    found: dict[str, int] = {}
    until = time.monotonic() + _MEASURED_WITHIN
    while len(found) < len(asked) and time.monotonic() < until:
        time.sleep(_MOMENT)
        for host, (name, last) in asked.items():
            now = run_status(grid, name, host, is_local=False) if host not in found else None
            if now and now.use and now.use.at != last:
                found[host] = now.use.at
    return found


def _is_alive(files: GridFiles, name: str, last: RunStatus) -> bool:
    """Whether the `run` of a status runs now: its pid can be reused."""
    return last.state in ALIVE and procfs.command(last.runner)[2:4] == [name, files.folder]


def _with_use(running: Running, table: dict[int, procfs.ProcessEntry]) -> Running:
    """With what a process of this machine uses."""
    is_running = running.state == RUNNING and running.pid
    members = procfs.descendants({running.pid}, table) & set(table) if is_running else set()
    return replace(running, memory=procfs.memory(members), cpu=sum(table[pid].cpu for pid in members))


def _running(
    name: str, spec: ProcessSpec | None, host: str, state: str, runner: int, last: RunStatus | None, is_desired: bool,
    measured: int | None, *, is_near: bool,
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
    memory, cpu = _used(last, measured)
    return Running(
        name, spec, host, now, last.pid if now == RUNNING else 0, _seconds_since(last, is_near),
        last.restarts, last.last_exit, memory, cpu, last.spread,
        not_alive=last.not_alive if now == RUNNING else "",
    )  # fmt: skip


def _used(last: RunStatus, measured: int | None) -> tuple[int | None, float | None]:
    """The memory and CPU of a process on another host, None if they were not measured just now."""
    if last.use is None or measured is None or last.use.pid != last.pid or last.use.at < measured:
        return None, None
    return last.use.memory, last.use.cpu


def _seconds_since(last: RunStatus, is_near: bool) -> float:
    """Seconds since the last change: for this machine by a monotonic clock, else by the host's clock."""
    if is_near:
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - last.since / 1000)
    return max(0.0, time.time() - last.at / 1e6)
