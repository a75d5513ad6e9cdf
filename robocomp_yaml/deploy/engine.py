"""What an engine does: it starts, watches and stops the processes of one network on its hosts.

Order, readiness, plan and rollback are not its business: they are the same for every engine (`plan`, `readiness`,
`carry_out`). What an engine does do by itself is to restart a process that ended, by the rules of its `Restart`.
"""

from __future__ import annotations

from collections.abc import AsyncGenerator, Collection, Iterable, Sequence
from typing import Protocol

import msgspec

from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network

RUNNING = "running"
WAITING = "waiting"
"""It ended by itself, and is started again after a delay."""
GIVEN_UP = "given up"
"""It ended by itself too often, or in a way after which its policy does not start it again."""
ENDED = "ended"
"""It ended by itself with 0, and its policy leaves it at that."""
STOPPED = "stopped"
LOST = "lost"
"""Nobody can say: its host does not answer."""

OWN = "rcyaml: "
"""How a line in a process's log begins that the engine wrote."""

STARTED = f"{OWN}started"
"""How the line begins that stands before what a run of a process wrote."""

STOP_WITHIN = 5.0
"""Seconds that a process has to end when it is asked to, before it is killed."""


class Running(msgspec.Struct, frozen=True):
    """A process that the engine started, as it is now. `spec` is what it was started with (None where the engine
    cannot say: another version of rcyaml started it). `uptime` are seconds since its present run began, or since the
    last one ended, by a clock that nobody sets. `restarts` counts those that the engine made by itself, `last_exit`
    says how the last run ended ('exit code 3', 'SIGSEGV', '' for none). `memory` are bytes and `cpu` seconds, of the
    process and all that it started."""

    name: str
    spec: ProcessSpec | None
    host: str
    state: str
    pid: int = 0
    uptime: float = 0.0
    restarts: int = 0
    last_exit: str = ""
    memory: int = 0
    cpu: float = 0.0

    @property
    def end(self) -> str:
        """How it ended, after how many tries."""
        again = f", after {self.restarts} restart{'' if self.restarts == 1 else 's'}" if self.restarts else ""
        return self.last_exit + again


class Line(msgspec.Struct, frozen=True):
    """A line that a process wrote on its standard output or error; `time` as in ISO 8601, '' where it is not known."""

    name: str
    text: str
    time: str = ""


class DeployFailed(Exception):
    """What was wanted cannot be done; the diagnostic (RC7xxx) says why, and how to mend it."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class Engine(Protocol):
    """One network's engine. Every method may raise DeployFailed; calls for different processes may run at once."""

    name: str
    notes: list[Diagnostic]
    """What was found on the way and should be told; whoever uses the engine empties the list."""

    async def open(self, network: Network, *, create: bool) -> bool:
        """Reaches what runs the network; where nothing does and `create`, starts it. Whether it was reached: if not,
        nothing of the network runs, and no other method is called but `close`."""

    async def observe(self) -> dict[str, Running]:
        """All processes that it was ever given by `prepare` and did not `forget`, as they are now."""

    async def obstacles(self, specs: Sequence[ProcessSpec], leaving: Collection[str]) -> list[Diagnostic]:
        """What would keep these from starting on their hosts, seen before anything is started: a port that another
        program has, an executable that is missing. `leaving` are processes that will be stopped before."""

    async def prepare(self, specs: Sequence[ProcessSpec]) -> None:
        """Takes over what is to hold from now on, for some of the processes, all at once: writes their configurations
        (mode 0600, whole or not at all, in the network's folder on their hosts) and keeps the specs. A process that
        runs goes on undisturbed; only its `Restart` holds at once."""

    async def start(self, name: str) -> None:
        """Starts a process that was prepared and does not run. Returns once it runs, ready or not."""

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        """Ends a process with all that it started: asked first, killed after so many seconds. Returns when it is gone;
        it is not started again by itself. Nothing happens to one that does not run."""

    async def forget(self, names: Iterable[str]) -> None:
        """Drops processes that were stopped and are no longer part of the network, with their configurations."""

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        """The last lines that these processes wrote (of each so many), and, with `follow`, those that come. The place
        from which it follows is that at the time of this call: `lines` before `start` misses nothing."""

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        """The exit code of a command run beside a process: on its host, in its folder, with its environment. A
        command that takes longer is killed, and counts as failed."""

    async def close(self, *, end: bool = False) -> None:
        """Lets go of it: what runs goes on. With `end`, what the engine itself runs ends too, as nothing is left."""
