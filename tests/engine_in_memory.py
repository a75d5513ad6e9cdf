"""An engine whose processes are only written down, so that what is done with a deployment is seen without starting any."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Collection, Iterable, Mapping, Sequence
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.deploy.carry_out import ProcessEvent
from robocomp_yaml.deploy.engine import GIVEN_UP, RUNNING, STOP_WITHIN, STOPPED, DeployFailed, Line, Running
from robocomp_yaml.deploy.operations import KEEP_GOING, Result, down, up
from robocomp_yaml.deploy.spec import ProcessSpec, spec_of
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import LOOPBACK, Network, NetworkHost, Process, Readiness

ASKED = Readiness(within=0.2, command=("ask",))
"""Ready as soon as a command says so: nobody waits long."""


def process(name: str, *after: str, **more: Any) -> Process:
    line = len(name)
    return Process(name, LOOPBACK, ("run", name), "/", after=after, span=Span("n.ddsl.yaml", line), **{
        "ready": ASKED, **more
    })  # fmt: skip


def network(*processes: Process) -> Network:
    """Each in the wave behind all that it is after."""
    order = []
    left = {one.name: set(one.after) for one in processes if one.enabled}
    while left:
        free = tuple(name for name, after in left.items() if not after & left.keys()) or tuple(left)
        order.append(free)
        for name in free:
            del left[name]
    by_name = {one.name: one for one in processes}
    return Network("N", "/n.ddsl.yaml", "/folder", {LOOPBACK: NetworkHost(LOOPBACK)}, by_name, order=tuple(order))


def spec(one: Process) -> ProcessSpec:
    return spec_of(network(one), one, {})


def running(one: Process, state: str = RUNNING, **more: Any) -> Running:
    return Running(one.name, spec(one), one.host, state, uptime=9.0, **more)


class InMemory:
    """`done` is what was asked of it, in order. Of the processes, `ending` end while they are started, `silent`
    never become ready, `blocked` cannot be started, which is seen before, those in `needing` are ready as long as
    another one runs, and those in `brief` end as soon as they were ready, in a state, or are gone. Those that are in
    `crashes` end when they are asked, and are restarted."""

    name = "memory"

    def __init__(self, *now: Running, ending: str = "", silent: str = "", blocked: str = "") -> None:
        self.now = {one.name: one for one in now}
        self.done: list[str] = []
        self.notes: list[Diagnostic] = []
        self.ending, self.silent, self.blocked = ending.split(), silent.split(), blocked.split()
        self.specs: dict[str, ProcessSpec] = {}
        self.logs: dict[str, list[str]] = {}
        self.needing: dict[str, str] = {}
        self.brief: dict[str, str | None] = {}
        self.crashes: set[str] = set()

    async def open(self, network: Network, *, create: bool) -> bool:
        return True

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        return dict(self.now)

    async def obstacles(self, specs: Sequence[ProcessSpec], leaving: Collection[str]) -> list[Diagnostic]:
        return [
            deploying.NOT_READY.at(one.process.span, name=one.name, within="1", why="it is in the way")
            for one in specs
            if one.name in self.blocked and one.name not in leaving
        ]

    async def stage(self, specs: Sequence[ProcessSpec]) -> None:
        self.staged = [one.name for one in specs]

    async def prepare(self, specs: Sequence[ProcessSpec]) -> None:
        self.done.append(f"prepare {' '.join(one.name for one in specs)}")
        self.specs.update({one.name: one for one in specs})

    async def start(self, name: str) -> None:
        self.done.append(f"start {name}")
        spec = self.specs[name]
        state, how = (GIVEN_UP, "exit code 3") if name in self.ending else (RUNNING, "")
        self.now[name] = Running(name, spec, spec.process.host, state, uptime=9.0, last_exit=how)
        if how:
            raise DeployFailed(deploying.ENDED_EARLY.at(spec.process.span, name=name, how=how, hint=""))

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        self.done.append(f"stop {name}")
        await asyncio.sleep(0)
        self.done.append(f"stopped {name}")
        self.now[name] = replace(self.now[name], state=STOPPED)

    async def forget(self, names: Iterable[str]) -> None:
        for name in sorted(names):
            self.done.append(f"forget {name}")
            self.now.pop(name, None)

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        return self._lines([Line(name, text) for name in names for text in self.logs.get(name, [])[-last:]])

    async def _lines(self, lines: list[Line]) -> AsyncGenerator[Line, None]:
        for line in lines:
            yield line

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        if name in self.crashes:
            self.crashes.remove(name)
            one = self.now[name]
            self.now[name] = replace(one, restarts=one.restarts + 1, last_exit="exit code 4")
        needed = self.now.get(self.needing.get(name, name))
        is_ready = name not in self.silent and needed and needed.state == RUNNING
        if is_ready and name in self.brief:
            state = self.brief[name]
            self.now = {one: of for one, of in self.now.items() if one != name or state}
            self.now |= {name: replace(self.now[name], state=state, last_exit="exit code 3")} if state else {}
        return 0 if is_ready else 1

    async def close(self, *, end: bool = False) -> None:
        self.done.append("end" if end else "close")

    # As the commands do it

    def up(
        self, wanted: Network, *names: str, forced: Collection[str] = (), on_failure: str = KEEP_GOING,
        keep_going: bool = False, seconds: float | None = None,
    ) -> Result:  # fmt: skip
        """`on_failure` is what a user who is asked says."""

        async def choose(result: Result) -> str:
            self.done.append(f"ask: {' '.join(result.outcome.failed)}")
            return on_failure

        self.events: list[ProcessEvent] = []
        limit = TimeLimit(seconds)
        return asyncio.run(
            up(self, wanted, names, forced, choose, self.events.append, keep_going=keep_going, limit=limit)
        )  # fmt: skip

    def down(self, *names: str) -> list[str]:
        self.events = []
        return asyncio.run(down(self, names, self.events.append, "/no/folder"))

    def states(self) -> Mapping[str, str]:
        return {name: one.state for name, one in self.now.items()}
