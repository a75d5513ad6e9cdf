"""The protocol of engines: an engine starts, supervises and stops the processes of one network on its hosts.

Plan, order, readiness and rollback are the same for every engine (`plan`, `carry_out`, `readiness`). Only one thing an
engine does by itself: it restarts a process that ended, by its `RestartRule`.
"""

from __future__ import annotations

from collections.abc import AsyncGenerator, Awaitable, Callable, Collection, Iterable, Sequence
from typing import Protocol

import msgspec

from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ALIVE, ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Diagnosed
from robocomp_yaml.network.network import Network

__all__ = [
    "ENDED", "GIVEN_UP", "HALTED", "KILLED", "LOST", "OWN", "RUNNING", "STARTED", "STOPPED", "STOP_WITHIN", "WAITING",
    "DeployFailed", "Engine", "EngineHangs", "Line", "Running", "of_last_run",
]  # fmt: skip

# The two messages of NOT_SUPERVISED.
KILLED = "the supervisor of this deployment was killed, and all its processes with it"
HALTED = "what supervises this deployment was halted (SIGSTOP), and goes on now"

OWN = "rcyaml: "
"""The beginning of each line in a process's log that the engine wrote."""

STARTED = f"{OWN}started"
"""The beginning of the line that precedes the output of each run of a process."""

STOP_WITHIN = 5.0
"""Seconds that a process has to end after SIGTERM, before it is killed."""


class Running(msgspec.Struct, frozen=True):
    """The actual state of a process that the engine started.

    `spec` is what it was started with, None if another version of rcyaml started it. `uptime` are seconds since its
    current run began, or since the last run ended, by a monotonic clock. `restarts` counts the engine's own restarts.
    `last_exit` is how the last run ended ('exit code 3', 'SIGSEGV', '' if none has). `spread` are the seconds from the
    third last end by itself to the last one, None if it has not ended so often. `memory` are bytes and `cpu` seconds,
    of the process and all its descendants; None if they are unknown, as on another host that was not asked for them.
    `lost_lines` are lines that could not be written to its log, because the disk is full. `not_alive` is why it runs
    and is not alive, '' if it is.
    """

    name: str
    spec: ProcessSpec | None
    host: str
    state: str
    pid: int = 0
    uptime: float = 0.0
    restarts: int = 0
    last_exit: str = ""
    memory: int | None = 0
    cpu: float | None = 0.0
    spread: float | None = None
    lost_lines: int = 0
    not_alive: str = ""

    @property
    def is_alive(self) -> bool:
        """Whether it runs, or will be restarted by the engine."""
        return self.state in ALIVE

    @property
    def end(self) -> str:
        """How the last run ended, with the number of restarts."""
        again = f", after {self.restarts} restart{'' if self.restarts == 1 else 's'}" if self.restarts else ""
        return self.last_exit + again


class Line(msgspec.Struct, frozen=True):
    """A line that a process wrote to its standard output or error. `time` is in ISO 8601, '' if it is unknown."""

    name: str
    text: str
    time: str = ""


class DeployFailed(Diagnosed):
    """An operation failed; the diagnostic (RC7xxx) has the reason and a hint."""


class EngineHangs(DeployFailed):
    """What runs the network is there, and does not answer. `end` kills it, with all its processes, and returns their
    names."""

    def __init__(self, diagnostic: Diagnostic, end: Callable[[], Awaitable[list[str]]]) -> None:
        super().__init__(diagnostic)
        self.end = end


class Engine(Protocol):
    """One network's engine. Every method may raise DeployFailed; calls for different processes may run at once."""

    name: str
    notes: list[Diagnostic]
    """Diagnostics that do not fail an operation. The caller reports them and empties the list."""

    async def open(self, network: Network, *, create: bool) -> bool:
        """Connects to what runs the network; with `create`, starts that if it is absent. Returns whether it is
        connected: if not, no process of the network runs, and only `close` may be called. May raise
        EngineHangs, and NotOwn if another user runs it, too."""

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        """The actual state of all processes that were passed to `prepare` and not to `forget`. With `use`, memory and
        CPU are known, also on other hosts, which takes a moment; without it, they may be unknown."""

    async def obstacles(self, specs: Sequence[ProcessSpec], leaving: Collection[str]) -> list[Diagnostic]:
        """What would prevent these processes from starting on their hosts, checked before anything is started: a port
        that another program uses, a missing executable. `leaving` are processes that will be stopped before."""

    async def stage(self, specs: Sequence[ProcessSpec]) -> None:
        """Writes and verifies the configurations with which `prepare` will set these specs, beside those that are
        used, and whatever else could fail for lack of space. Nothing that runs is changed."""

    async def prepare(self, specs: Sequence[ProcessSpec]) -> None:
        """Sets the desired state of some processes: writes their configurations (mode 0600, atomically, in the
        network's folder on their hosts) and keeps the specs. A running process goes on; only its `RestartRule`
        applies immediately."""

    async def start(self, name: str) -> None:
        """Starts a process that was prepared and does not run. Returns when it runs, ready or not."""

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        """Ends a process and all its descendants: with SIGTERM, and with SIGKILL after `within` seconds. Returns when
        they have ended; the engine does not restart the process. A process that does not run is ignored."""

    async def forget(self, names: Iterable[str]) -> None:
        """Removes stopped processes that are no longer part of the network, with their configurations."""

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        """The `last` lines of each of these processes, and with `follow` all further lines. It follows from the end of
        the logs at the time of this call, so that a call before `start` misses no line."""

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        """The exit code of a command that runs on the host of a process, in its folder and with its environment. After
        `within` seconds the command is killed, and counts as failed."""

    async def close(self, *, end: bool = False) -> None:
        """Disconnects; running processes go on. With `end`, what the engine itself runs ends, too: then no process may
        run. Also without a connection, `end` removes the network from the user's list."""


def of_last_run(texts: Sequence[str]) -> Sequence[str] | None:
    """The lines of a log from the last start on; None if that is not among them."""
    starts = [number for number, text in enumerate(texts) if text.startswith(STARTED)]
    return texts[starts[-1] :] if starts else None
