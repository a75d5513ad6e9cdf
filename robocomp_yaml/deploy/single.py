"""One process of a network in the foreground, with what it needs beside it. All that is started here is stopped at the
end, however that comes: the processes beside it have a supervisor of their own, which ends with this process."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.carry_out import Report, stop_all
from robocomp_yaml.deploy.engine import GIVEN_UP, DeployFailed, Running
from robocomp_yaml.deploy.foreground import Foreground, Interruptions
from robocomp_yaml.deploy.local.engine import LocalEngine
from robocomp_yaml.deploy.local.obstacles import obstacles, whole_environment_of
from robocomp_yaml.deploy.plan import with_dependents
from robocomp_yaml.deploy.spec import ProcessSpec, spec_of
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.network.network import Network, Process, Readiness

_PERIOD = 0.3  # seconds between two looks at the processes beside


class SingleResult(msgspec.Struct):
    """How a run ended. `code` is the exit code of the process, negative for a signal, None if it was not started;
    `interrupted_by` is the signal that ended the run, or 0."""

    code: int | None = None
    interrupted_by: int = 0
    diagnostics: list[Diagnostic] = []


def moved(network: Network, folder: str, names: Collection[str], foreground: str = "") -> Network:
    """The network of only these processes, with another folder of its own. What they are after is left out if it is not
    among them: it is ready. Those that need the process of the `foreground`, which starts last, need not be ready."""
    after = {one.name: (*one.after, *one.awaits) for one in network.processes.values()}
    early = with_dependents(after, [foreground]) if foreground else set[str]()
    chosen = [process for process in network.processes.values() if process.name in names]
    return replace(
        network, folder=folder,
        processes={
            one.name: replace(
                one, enabled=True, after=tuple(name for name in one.after if name in names),
                ready=Readiness() if one.name in early else one.ready,
            )
            for one in chosen
        },
        order=[tuple(name for name in wave if name in names) for wave in _waves(network, names)],
    )  # fmt: skip


def _waves(network: Network, names: Collection[str]) -> list[tuple[str, ...]]:
    """The order of a network, with the disabled ones among these names, which have no place in it."""
    placed = {name for wave in network.order for name in wave}
    return [*network.order, tuple(name for name in names if name not in placed)]


class SingleRun(msgspec.Struct):
    """What is started: a process of the network with more arguments, and the network of those beside it. `folder` is
    that of the run."""

    network: Network
    process: Process
    folder: str
    arguments: tuple[str, ...] = ()
    beside: Network | None = None

    @property
    def spec(self) -> ProcessSpec:
        return spec_of(moved(self.network, self.folder, [self.process.name]), self.process, {})

    @property
    def command(self) -> tuple[str, ...]:
        return (*self.spec.command, *self.arguments)

    async def run(self, report: Report, on_start: Callable[[int], None] = lambda pid: None) -> SingleResult:
        """Runs the process until it ends, or a signal ends the run. `report` gets the events of the processes beside
        it, `on_start` is called with the pid when it has started. Raises DeployFailed."""
        interruptions = Interruptions()
        with interruptions.caught():
            engine = LocalEngine(tied=True) if self.beside else None
            result = SingleResult()
            try:
                if engine is None or await self._start_beside(engine, report, result, interruptions):
                    await self._run(engine, result, interruptions, on_start)
            except DeployFailed as error:
                result.diagnostics.append(error.diagnostic)
            finally:
                if engine is not None:
                    result.diagnostics += engine.notes
                    await _end(engine, report, interruptions)
                for file in self.process.config.files if self.process.config else ():
                    own_folder.remove(self.folder, file)
            result.interrupted_by = next(iter(interruptions.numbers), 0)
        return result

    async def _start_beside(
        self, engine: LocalEngine, report: Report, result: SingleResult, interruptions: Interruptions
    ) -> bool:  # fmt: skip
        """Whether all processes beside are ready."""
        assert self.beside
        stop = operations.always(operations.STOP_THEM)
        await engine.open(self.beside, create=True)
        up = asyncio.create_task(operations.up(engine, self.beside, (), (), stop, report))
        await _either(up, interruptions.more_than(0))
        if not up.done():
            up.cancel()
            with suppress(asyncio.CancelledError, DeployFailed):
                await up
            return False
        result.diagnostics += up.result().diagnostics
        return not result.diagnostics and not interruptions.count

    async def _run(
        self, engine: LocalEngine | None, result: SingleResult, interruptions: Interruptions,
        on_start: Callable[[int], None],
    ) -> None:  # fmt: skip
        spec = self.spec
        if result.diagnostics or (found := obstacles([spec], ())):
            result.diagnostics += found
            return
        own_folder.make(self.folder)
        for file, text in spec.process.config.files.items() if spec.process.config else ():
            own_folder.write(self.folder, file, text)
        try:
            environment = whole_environment_of(spec.process)
            mark = f"{self.folder}:{spec.name}"
            child = await Foreground.start(self.command, spec.process.cwd, environment, mark)
        except OSError as error:
            reason = reason_of(error)
            at = spec.process.span
            raise DeployFailed(deploying.CANNOT.at(at, name=spec.name, what="started", reason=reason)) from error
        on_start(child.pid)
        ended = asyncio.create_task(child.wait())
        failing = asyncio.create_task(_failed(engine, self.beside))
        await _either(ended, interruptions.more_than(0), failing)
        if failing.done():
            result.diagnostics += failing.result()
        failing.cancel()
        result.code = ended.result() if ended.done() else await child.stop(interruptions)


async def _either(*works: object) -> None:
    """Waits for the first of these tasks and coroutines. Coroutines are cancelled after it."""
    tasks = {one if isinstance(one, asyncio.Task) else asyncio.ensure_future(one): one for one in works}  # type: ignore[call-overload]
    await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task, given in tasks.items():
        if task is not given:
            task.cancel()


async def _failed(engine: LocalEngine | None, beside: Network | None) -> list[Diagnostic]:
    """Waits until a process beside is given up. Returns why."""
    while True:
        await asyncio.sleep(_PERIOD)
        try:
            found = await engine.observe() if engine else {}
        except DeployFailed as error:
            return [error.diagnostic]
        given_up = [one for one in found.values() if one.state == GIVEN_UP and one.spec]
        if given_up:
            return [await _why(engine, beside, one) for one in given_up]


async def _why(engine: LocalEngine | None, beside: Network | None, one: Running) -> Diagnostic:
    assert engine and beside
    more = "\n".join(await operations.last_lines(engine, one.name))
    return deploying.GIVEN_UP.at(beside.span_of(one.name), name=one.name, how=one.end, more=more)


async def _end(engine: LocalEngine, report: Report, interruptions: Interruptions) -> None:
    """Stops what the engine started. A further interruption kills it."""
    with suppress(DeployFailed, AssertionError):
        running = await engine.observe()
        stopping, count = asyncio.create_task(stop_all(engine, running.values(), report)), interruptions.count
        while not stopping.done():
            await _either(stopping, interruptions.more_than(count))
            if not stopping.done():
                count = interruptions.count
                _kill(running)
        stopping.result()
        await engine.forget(list(running))
    with suppress(DeployFailed):
        await engine.close(end=True)


def _kill(running: Mapping[str, Running]) -> None:
    for one in running.values():
        if one.pid:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(one.pid, signal.SIGKILL)
