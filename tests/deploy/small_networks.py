"""Networks of small real processes, and questions of tests about them."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Coroutine, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from processes import until
from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.carry_out import ProcessEvent
from robocomp_yaml.deploy.engine import Line, Running
from robocomp_yaml.deploy.local import procfs, record
from robocomp_yaml.deploy.local.engine import LocalEngine
from robocomp_yaml.deploy.operations import Result, Status
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.network.network import ConfigFile, Network, NetworkHost, Process, Readiness
from seen import agreed

LISTEN = "import socket,sys,time; s = socket.create_server(('127.0.0.1', int(sys.argv[1]))); time.sleep(600)"
HERE = NetworkHost("localhost")


def sleeper(name: str, *after: str, **more: Any) -> Process:
    return shell(name, "exec sleep 600", *after, **more)


def shell(name: str, script: str, *after: str, **more: Any) -> Process:
    """A process that runs a line of shell."""
    command = ("sh", "-c", script, "{config}") if "config" in more else ("sh", "-c", script)
    return Process(name, "localhost", command, "/tmp", kind="program", after=after, is_ice=False, **more)


def listener(name: str, port: int, *after: str, **more: Any) -> Process:
    command = (sys.executable, "-c", LISTEN, str(port))
    ready = more.pop("ready", Readiness(port=port, within=20))
    return Process(name, "localhost", command, "/tmp", kind="program", after=after, ready=ready, is_ice=False, **more)


def config_of(name: str, text: str) -> ConfigFile:
    return ConfigFile(f"config/{name}", text)


@dataclass
class Place:
    """A folder with the deployment `Robot`. A test passes its processes with each call."""

    root: Path
    events: list[ProcessEvent] = field(default_factory=list)

    @property
    def folder(self) -> str:
        return f"{self.root}/.rcyaml/deployments/Robot"

    def network(self, *processes: Process) -> Network:
        network = Network("Robot", f"{self.root}/robot.ddsl.yaml", self.folder, {"localhost": HERE})
        enabled = tuple(process.name for process in processes if process.enabled)
        return replace(network, processes={process.name: process for process in processes}, order=(enabled,))

    def run(self, work: Callable[[LocalEngine], Coroutine[Any, Any, Any]], *processes: Process) -> Any:
        """The result of `work` with an open engine for the network of these processes."""

        async def main() -> Any:
            engine = LocalEngine()
            await engine.open(self.network(*processes), create=True)
            try:
                return await work(engine)
            finally:
                await engine.close()

        return asyncio.run(main())

    def up(
        self, *processes: Process, on_failure: str = operations.STOP_THEM, names: Iterable[str] = (),
        forced: Iterable[str] = (), limit: float | None = None,
    ) -> Result:  # fmt: skip
        self.events = []

        async def choose(outcome: object) -> str:
            return on_failure

        async def work(engine: LocalEngine) -> Result:
            return await operations.up(
                engine, self.network(*processes), names, set(forced), choose, self.events.append,
                keep_going=on_failure == operations.KEEP_GOING, limit=TimeLimit(limit),
            )  # fmt: skip

        return self.run(work, *processes)

    def down(self, *names: str) -> list[str]:
        self.events = []

        async def main() -> list[str]:
            engine = LocalEngine()
            if not await engine.open(self.network(), create=False):
                return []
            return await operations.down(engine, names, self.events.append, self.folder)

        return asyncio.run(main())

    def observe(self) -> dict[str, Running]:
        """What the engine says, which /proc confirms."""

        def told(found: dict[str, Running]) -> dict[str, tuple[str, int]]:
            return {name: (one.state, one.pid) for name, one in found.items()}

        return agreed(self.folder, self._observed, told)

    def _observed(self) -> dict[str, Running]:
        async def main() -> dict[str, Running]:
            engine = LocalEngine()
            if not await engine.open(self.network(), create=False):
                return {}
            running = await engine.observe()
            await engine.close()
            return running

        return asyncio.run(main())

    def status(self, *processes: Process) -> dict[str, Status]:
        async def work(engine: LocalEngine) -> list[Status]:
            return await operations.status(engine, self.network(*processes), (), True)

        return {one.name: one for one in self.run(work, *processes)}

    def pids(self) -> dict[str, int]:
        return {name: running.pid for name, running in self.observe().items()}

    def log(self, name: str, last: int = 1000) -> list[str]:
        async def work(engine: LocalEngine) -> list[Line]:
            return [line async for line in await engine.lines([name], last, False)]

        return [line.text for line in self.run(work)]

    def order(self, *kinds: str) -> list[str]:
        """The names of the processes with events of these kinds, in their order."""
        return [event.name for event in self.events if event.kind in kinds]

    def wait_for_state(self, name: str, state: str) -> Running:
        def seen() -> Running | None:
            running = self.observe().get(name)
            return running if running and running.state == state else None

        found: Running = until(seen, lambda: f"{name} {state}: {self.observe().get(name)}")
        return found

    def wait_gone(self) -> None:
        """Waits until no process of the deployment runs, nor its supervisor."""

        def is_gone() -> bool:
            if any(is_alive(pid) for pid in procfs.marked(self.folder)):
                return False  # an ending process has lost its mark already; the record still knows the keeper
            return not record.is_there(self.folder) or record.was_killed(self.folder)

        until(is_gone, "nothing is left")

    def keeper_and_supervisor(self) -> tuple[int, int]:
        keeper = int(Path(self.folder, record._FILE).read_text(encoding="ascii").split()[0])
        (supervisor,) = [one.pid for one in procfs.table().values() if one.parent == keeper]
        return keeper, supervisor


def is_alive(pid: int) -> bool:
    found = procfs.entry(pid)
    return found is not None and not found.is_dead


def readable_by_others(folder: str) -> list[str]:
    """Everything below a folder that other users can read."""
    paths = [os.path.join(top, name) for top, folders, files in os.walk(folder) for name in (*folders, *files)]
    return [path for path in [folder, *paths] if os.lstat(path).st_mode & 0o077]
