"""Running one component in the foreground, as it would run in its deployment, or by itself."""

from __future__ import annotations

import asyncio
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.api.which_process import Overrides, choose
from robocomp_yaml.deploy import exported, folder, ice_ping
from robocomp_yaml.deploy.carry_out import Report
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed, Running
from robocomp_yaml.deploy.engines import make_engine
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.local.obstacles import elsewhere
from robocomp_yaml.deploy.ownership import NotOwn
from robocomp_yaml.deploy.preparing import prepared_for_run
from robocomp_yaml.deploy.readiness import listens
from robocomp_yaml.deploy.single import SingleResult, SingleRun, moved
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused, reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.digraph import reachable
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.network.network import LOOPBACK, PROXY, ConfigFile, Network, Process
from robocomp_yaml.source import regular

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.building.job import BuildEvent
    from robocomp_yaml.deploy.stale import StaleComponent

RUN, UP = "rcyaml run", "rcyaml deploy up"
_WITHIN = 1.0  # seconds for a process that runs already to answer


class Run:
    """A run of one process in the foreground.

    `name` is an entry of a deployment, or a component by its name, folder or document. `deployment` is the path of the
    deployment's document; by default, it is one of those of the working folder, or else of the workspace. A component
    that no deployment has runs by itself, with its own configuration, and so does one if `alone` is set. `with_needed`
    also starts what it needs and what does not run yet. The program gets `arguments` after its own. `settings` are
    values of parameters for this run, by their paths, and `config` replaces that of the entry; no document is changed.

    `network` and `process` describe what runs; `document` is the path of the deployment, '' for a component by itself.
    Raises Refused if the name is unknown or means more than one process, Faulty if the documents have errors.
    """

    def __init__(
        self, name: str = ".", *, deployment: str = "", include: Sequence[str] = (), alone: bool = False,
        with_needed: bool = False, settings: Mapping[str, str] | None = None, config: str = "",
        arguments: Sequence[str] = (),
    ) -> None:  # fmt: skip
        overrides = Overrides(settings or {}, config)
        chosen = choose(name, deployment, include, overrides, alone=alone, with_needed=with_needed)
        self.document, self._path, self._analysis = chosen.document, chosen.path, chosen.analysis
        self.network: Network = chosen.network
        self.process: Process = chosen.process
        self._with_needed, self._arguments = with_needed, tuple(arguments)
        self._folder = chosen.folder
        self._diagnostics: list[Diagnostic] = []

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What is wrong with the run so far."""
        absolute = self.network.path
        placed = (
            replace(one, span=replace(one.span, file=self._path)) if one.span.file == absolute else one
            for one in self._diagnostics
        )
        return self._analysis.for_users(placed)

    def description(self) -> dict[str, Any]:
        """What would be started: its name, deployment, command, folder, the variables of its environment,
        the text of its configuration, and the names of the processes that it needs. Secrets are hidden."""
        own = next((word for word in self.process.command[1:] if word.endswith(f"/{CONFIG}")), "")
        config = self.process.config or ConfigFile("", regular.text(own) or "")
        only = moved(self.network, self._folder, [self.process.name])
        name = self.process.name
        only = replace(only, processes={**only.processes, name: replace(self.process, config=config)})
        process = exported.hidden(only).processes[name]
        assert process.config
        return {
            "name": process.name, "deployment": self.document,
            "command": [*secrets.words(self._single(None).command, process.secrets)], "folder": process.cwd,
            "environment": {one.name: one.shown for one in process.env}, "configuration": process.config.text,
            "needed": [*_closure(self.network, self.process)],
        }  # fmt: skip

    def stale(self) -> list[StaleComponent]:
        """The components that must be built: of the process, and of all that would be started beside it. Raises Refused
        if the process runs already, Faulty if it cannot run."""
        with self._failures_reported():
            return self._stale(asyncio.run(self._needed()))

    def _stale(self, beside: Iterable[str]) -> list[StaleComponent]:
        from robocomp_yaml.api.building import units
        from robocomp_yaml.deploy.stale import stale

        names = {self.process.name, *beside}
        every = units(self._analysis, self._analysis.program.components.values())
        return stale(moved(self.network, self._folder, names), every, names)

    def build(self, report: Callable[[BuildEvent], None] | None = None) -> list[Built]:
        """Builds the `stale` components, each with its last build type. Returns one result for each build type."""
        from robocomp_yaml.api.building import build_stale

        return build_stale(self._analysis, self.stale(), report=report)

    def start(
        self, report: Report = lambda event: None, on_start: Callable[[int], None] = lambda pid: None
    ) -> SingleResult:
        """Runs the process, and returns when it has ended, and all that was started beside it. It has the terminal of
        this process; SIGINT, SIGTERM and SIGHUP end it. `report` gets the events of the processes beside it, `on_start`
        the pid. Raises Refused if it runs already, Faulty if it cannot be started."""
        with self._failures_reported(), folder.locked(self._folder, 0) as is_free:
            if not is_free:
                raise self._runs_already(RUN, _pid_of(self._folder, self.process))
            try:
                result = asyncio.run(self._start(report, on_start))
            finally:
                if not os.listdir(f"{self._folder}/logs"):  # those of the others stay
                    shutil.rmtree(self._folder, ignore_errors=True)
        self._diagnostics += result.diagnostics
        return result

    async def _start(self, report: Report, on_start: Callable[[int], None]) -> SingleResult:
        if self.document:
            self.network = prepared_for_run(self.network, self._folder)
            self.process = self.network.processes[self.process.name]
        needed = await self._needed()
        self._check_programs(needed)
        for process in (self.process, *needed.values()):
            await self._warn_of_absent(process)
        beside = moved(self.network, self._folder, needed, self.process.name) if needed else None
        return await self._single(beside).run(report, on_start)

    @contextmanager
    def _failures_reported(self) -> Iterator[None]:
        """Turns failures into diagnostics of the run. Raises Faulty."""
        try:
            yield
            return
        except DeployFailed as error:
            self._diagnostics.append(error.diagnostic)
        except OSError as error:
            path, reason = shown_path(error.filename or self._folder), reason_of(error)
            self._diagnostics.append(deploying.FOLDER.at(Span(self.network.path), path=path, reason=reason))
        raise Faulty(self.diagnostics)

    def _single(self, beside: Network | None) -> SingleRun:
        return SingleRun(self.network, self.process, self._folder, self._arguments, beside)

    async def _needed(self) -> dict[str, Process]:
        """What must be started beside it. Raises Refused if the process itself runs already, DeployFailed if one cannot
        run on this machine."""
        if diagnostic := elsewhere(moved(self.network, self._folder, [self.process.name])):
            raise DeployFailed(diagnostic)
        running = await self._deployed()
        if self.process.name in running:
            raise self._runs_already(UP, running[self.process.name].pid)
        found: dict[str, Process] = {}
        pending = [self.process]
        while self._with_needed and pending:
            process = pending.pop()
            for name in _needs(self.network, process):
                other = self.network.processes.get(name)
                is_known = name in found or name in running or name == self.process.name
                if other is None or is_known or await _answers(other):
                    continue
                if diagnostic := elsewhere(moved(self.network, self._folder, [name])):
                    raise DeployFailed(diagnostic)
                found[name] = other
                pending.append(other)
        return found

    async def _deployed(self) -> dict[str, Running]:
        """The processes of the deployment that run under `deploy up`."""
        if not self.document:
            return {}
        engine = make_engine(None, self.network)
        try:
            is_running = await engine.open(self.network, create=False)
            found = await engine.observe() if is_running else {}
            await engine.close()
        except NotOwn:
            found = {}  # what runs beside it has its ports, whoever started that
        finally:
            self._diagnostics += engine.notes
        return {name: one for name, one in found.items() if one.is_alive}

    async def _warn_of_absent(self, process: Process) -> None:
        """Warns of servers that are not part of the network and do not answer."""
        for one in self.network.connections if self._with_needed else ():
            if one.source == process.name and one.kind == PROXY and not one.target and one.proxy:
                if not await ice_ping.answers(one.proxy, _WITHIN):
                    hint = f"`{typed('rcyaml', 'mock', one.interface)}` serves it with example values"
                    where, interface = one.span if one.span.file else process.span, one.interface
                    self._diagnostics.append(
                        deploying.NOBODY_SERVES.at(
                            where, name=process.name, interface=interface, proxy=one.proxy, hint=hint
                        )
                    )

    def _runs_already(self, how: str, pid: int) -> Refused:
        name = self.process.name
        if how == RUN:
            hint = f"end it there with Ctrl-C, or with `kill {pid}`"
        else:
            logs, down = (("rcyaml", "deploy", *words, self.document, name) for words in (("logs", "-f"), ("down",)))
            hint = f"`{typed(*logs)}` shows its output; `{typed(*down)}` stops it"
        return Refused(f"'{name}' runs already, by `{how}` (pid {pid}): {hint}")

    def _check_programs(self, beside: Iterable[str]) -> None:
        """Raises Faulty if a program that would be started is stale. A component that was compiled before its
        interfaces changed is only reported."""
        from robocomp_yaml.deploy import stale
        from robocomp_yaml.deploy.outdated import outdated_components

        found = [*stale.diagnostics(self.network, self._stale(beside))]
        components = {self.network.processes[name].component for name in (self.process.name, *beside)}
        linked = [one for one in self._analysis.program.components.values() if one.component.name in components]
        self._diagnostics += self._analysis.without_suppressed([*found, *outdated_components(linked)]).reported
        if has_errors(self._diagnostics):
            raise Faulty(self.diagnostics)


def _needs(network: Network, process: Process) -> list[str]:
    """The names of the processes that must be ready before this one, and of those that it waits for while it runs. A
    disabled process is in no order."""
    targets = (one.target for one in network.connections if one.source == process.name and one.target)
    return list(dict.fromkeys((*process.after, *process.awaits, *(() if process.enabled else targets))))


def _closure(network: Network, process: Process) -> Iterator[str]:
    """The names of all processes that must be ready before this one, directly or not."""
    known = network.processes
    every = reachable([process.name], lambda name: [one for one in _needs(network, known[name]) if one in known])
    return (name for name in every if name != process.name)


async def _answers(process: Process) -> bool:
    """Whether what a process serves for others is served already, by the process or by a stand-in."""
    pings = [one for one in process.ready.pings if not one.startswith(f"{COMMON_BEHAVIOR.lower()}:")]
    if pings or process.ready.pings:
        return all([await ice_ping.answers(one, _WITHIN, process.pem) for one in pings or process.ready.pings])
    return process.ready.port is not None and await listens(LOOPBACK, process.ready.port, _WITHIN)


def _pid_of(folder: str, process: Process) -> int:
    """The pid of a process that runs in a folder, 0 if it is not there any more."""
    return next((pid for pid in procfs.pids() if procfs.mark_of(pid) == f"{folder}:{process.name}"), 0)
