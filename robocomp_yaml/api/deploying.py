"""A deployment carried out: its network planned, brought up, watched and taken down."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Collection, Coroutine, Iterable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec.structs import replace

from robocomp_yaml.building.job import RELEASE
from robocomp_yaml.deploy import folder, operations
from robocomp_yaml.deploy.attached import Attached, attached
from robocomp_yaml.deploy.carry_out import Report
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed, Line
from robocomp_yaml.deploy.engines import ENGINES, LOCAL, make_engine
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, STOP_THEM, Choose, Result, Status
from robocomp_yaml.deploy.plan import RESTART, START, STOP, Plan, with_dependences
from robocomp_yaml.deploy.plan import plan as make_plan
from robocomp_yaml.deploy.probe import Found
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import ERROR, WARNING, Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.network.network import Network
from robocomp_yaml.pipeline import Analysis

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.building.job import Event
    from robocomp_yaml.deploy.stale import Stale

T = TypeVar("T")


class Deployment:
    """The network of a deployment, and what runs of it.

    `path` is its document's, as it was named, `network` what it comes to, `engine` the name of what runs it. `unread`
    says that the document cannot be read, so that the network is what runs of it. `diagnostics` are all that was said
    so far: of the documents first, then what each call found.

    NAMEs are processes, their aliases or groups; Refused is raised where one is unknown. Faulty is raised where
    something keeps a call from any result. One process at a time may change a deployment.
    """

    def __init__(self, analysis: Analysis, path: str, engine: str | None = None, *, lenient: bool = False) -> None:
        _one_of("engine", engine or LOCAL, ENGINES)
        self.path, self._analysis = path, analysis
        network = analysis.networks.get(os.path.realpath(path))
        self.unread = network is None
        if network is None and lenient:
            from robocomp_yaml.deploy.stand_in import stand_in

            network = stand_in(path)
        if network is None or (has_errors(analysis.diagnostics) and not lenient):
            raise Faulty(analysis.diagnostics, analysis.program.documents)
        self.network: Network = network
        self._engine, self._lock = make_engine(engine, network), ExitStack()
        self._told: list[Diagnostic] = []
        if not lenient:
            from robocomp_yaml.deploy.outdated import outdated

            self._told = analysis.with_more(outdated(analysis.program.deployments[os.path.realpath(path)]))

    @property
    def engine(self) -> str:
        return self._engine.name

    @property
    def diagnostics(self) -> list[Diagnostic]:
        return self.placed([*self._told, *self._engine.notes])

    @property
    def enabled(self) -> set[str]:
        """The processes that are to run."""
        return {process.name for process in self.network.enabled()}

    def placed(self, told: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics of what runs as users get them: engines know the document by its whole path, which is not how it
        was named, and nothing of secrets."""
        return self._analysis.veiled(
            replace(one, span=replace(one.span, file=self.path)) if one.span.file == self.network.path else one
            for one in told
        )

    def chosen(self, names: Iterable[str]) -> set[str]:
        """The processes that these names mean."""
        found: set[str] = set()
        for name in names:
            members = {process.name for process in self.network.processes.values() if name in process.groups}
            process = self.network.find(name)
            if not members and process is None:
                groups = (group for one in self.network.processes.values() for group in one.groups)
                meant = suggest(name, [*self.network.processes, *groups])
                hint = f"; did you mean '{meant}'?" if meant else ""
                raise Refused(f"{self.network.name} has no process or group '{name}'{hint}")
            found |= members or {one.name for one in [process] if one}
        return found

    def stale(self, *names: str) -> list[Stale]:
        """The components whose programs are not there, or are older than what they are made of, of those that are
        built and start here; of NAMEs, with all that they need."""
        from robocomp_yaml.api.building import every_unit
        from robocomp_yaml.deploy.stale import stale

        wanted = with_dependences(self.network, self.chosen(names)) if names else self.enabled
        return stale(self.network, every_unit(self._analysis), wanted)

    def build(
        self,
        *names: str,
        build_type: str | None = None,
        report: Callable[[Event], None] | None = None,
    ) -> list[Built]:
        """Builds what is `stale`, each as it was built last unless `build_type` says how; what came of it, for each
        type."""
        from robocomp_yaml.api.building import build

        by_type: dict[str, list[str]] = {}
        for one in self.stale(*names):
            by_type.setdefault(build_type or one.look.type or RELEASE, []).append(one.unit.document)
        return [
            build(self._analysis, documents, build_type=type_, report=report) for type_, documents in by_type.items()
        ]

    def _tell_stale(self, names: Iterable[str], severity: str = ERROR) -> bool:
        from robocomp_yaml.deploy import stale

        found = [one.as_severity(severity) for one in stale.told(self.network, self.stale(*names))]
        told = self._analysis.shown(self._analysis.judged(found).reported)
        self._told += told
        return has_errors(told)

    def plan(self, *names: str) -> Plan:
        """What `up` would start, stop, restart and change, and why; what stands in the way is among the diagnostics."""
        wanted = self.chosen(names)
        self._tell_stale(names)

        async def work() -> Plan:
            reached = await self._engine.open(self.network, create=False)
            found = make_plan(self.network, await self._engine.observe() if reached else {}, wanted)
            specs = [step.spec for step in found.of(START, RESTART) if step.spec]
            self._told += await self._engine.obstacles(specs, {step.name for step in found.of(STOP, RESTART)})
            await self._engine.close()
            return found

        return self._run(work())

    def up(
        self, *names: str, restart: bool = False, on_failure: str | Choose = STOP_THEM, timeout: float | None = None,
        report: Report | None = None, stays: Attached | None = None,
    ) -> Result:  # fmt: skip
        """Brings the network about and returns when all is ready: starts each process as soon as those that it needs
        are ready, restarts what changed, stops what is no longer part of it; with `restart`, what is named starts anew.

        `on_failure` is what becomes of those that were started when one fails: `stop`, `rollback` or `keep`, or who is
        asked for that. `timeout` are seconds, `report` is told of each step. Who `stays` returns only when all is down
        again."""
        if isinstance(on_failure, str):
            _one_of("way", on_failure, (STOP_THEM, ROLL_BACK, KEEP_GOING))
        wanted, limit = self.chosen(names), TimeLimit(timeout)
        if self._tell_stale(names):
            raise Faulty(self.diagnostics)
        forced = (wanted or self.enabled) if restart else set[str]()

        async def decided(result: Result) -> str:
            return on_failure if isinstance(on_failure, str) else await on_failure(result)

        async def work() -> Result:
            await self._engine.open(self.network, create=True)
            async with attached(self._engine, self.network, stays) as follow:
                result = await operations.up(
                    self._engine, self.network, wanted, forced, decided, report or _ignore,
                    keep_going=on_failure == KEEP_GOING, limit=limit,
                )  # fmt: skip
                self._told += result.diagnostics
                if stays and not result.diagnostics:
                    self._lock.close()  # what has come up may be worked on
                    self._told += await follow()
            if result.diagnostics or stays:
                await operations.end_if_idle(self._engine)
            else:
                await self._engine.close()
            return result

        return self._run(work(), change=True)

    def status(self, *names: str) -> list[Status]:
        """How the processes are now."""
        wanted = self.chosen(names)
        if not self.unread:
            self._tell_stale(names, WARNING)

        async def work() -> list[Status]:
            reached = await self._engine.open(self.network, create=False)
            found = await operations.status(self._engine, self.network, wanted, reached)
            await self._engine.close()
            return found

        return self._run(work())

    def logs(
        self, *names: str, last: int = 20, follow: bool = False, on_line: Callable[[Line], None] | None = None
    ) -> list[Line]:
        """The last lines that the processes printed, so many of each, in the order in which they wrote them.
        `on_line` is given each instead; with `follow`, it goes on with those that come, until it raises."""
        wanted = self.chosen(names) or self.enabled
        found: list[Line] = []

        async def work() -> None:
            await self._engine.open(self.network, create=False)
            asked = [name for name in self.network.processes if name in wanted]
            async for line in await self._engine.lines(asked, last, follow):
                (on_line or found.append)(line)
            await self._engine.close()

        self._run(work())
        return found

    def down(self, *names: str, report: Report | None = None) -> list[str]:
        """Takes down what runs, or the named processes with all that need them; those that ran."""
        wanted = self.chosen(names)

        async def work() -> list[str]:
            if not await self._engine.open(self.network, create=False):
                return []
            return await operations.down(self._engine, wanted, report or _ignore)

        return self._run(work(), change=True)

    def probe(self, host: str = "") -> dict[str, list[Found]]:
        """Which of the network's programs the host has, or each of all; one that does not answer is among the
        diagnostics."""
        from robocomp_yaml.deploy import probe

        known = self.network.hosts
        if host:
            _one_of("host", host, known, self.network.name)
        answers, failed = asyncio.run(probe.ask(self.network, [known[host]] if host else list(known.values())))
        self._told += failed
        return answers

    def export(self, form: str, *, reveal: bool = True) -> dict[str, str]:
        """The files from which another tool runs the network, by their paths. Unless `reveal`, secrets are hidden."""
        from robocomp_yaml.deploy import exported
        from robocomp_yaml.emit import exports

        plugins = self._analysis.program.plugins_of(self.path)
        _one_of("export", form, exports.forms(plugins))
        try:
            files, told = exported.files(self.network, form, plugins, reveal=reveal)
        except Faulty as error:  # of a plug-in
            files, told = {}, [*error.diagnostics]
        self._told += told
        if has_errors(told):
            raise Faulty(self.diagnostics)
        return files

    def write_export(self, form: str, output: str) -> list[str]:
        """Writes these files below a folder, whole or not at all, where only their owner can read them; their paths.
        Faulty where something else stands there than an export wrote."""
        from robocomp_yaml.deploy import exported

        files = self.export(form)
        try:
            self._told += exported.in_the_way(output, files)
            if has_errors(self._told):
                raise Faulty(self.diagnostics)
            exported.write(output, files)
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise Refused(f"cannot write {error.filename or output}: {reason}") from error
        return [os.path.normpath(os.path.join(output, path)) for path in files]

    def _run(self, work: Coroutine[Any, Any, T], *, change: bool = False) -> T:
        """Carries out a call; `change` where only one may at a time."""
        try:
            if not change:
                return asyncio.run(work)
            if self._lock.enter_context(folder.locked(self.network.folder)):
                return asyncio.run(work)
            reason = "another rcyaml is changing this deployment"
        except DeployFailed as error:
            self._told += [*self._engine.notes, error.diagnostic]
            self._engine.notes = []
            raise Faulty(self.diagnostics) from error
        except BrokenPipeError:
            raise  # whoever reads what is told has had enough
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
        finally:
            work.close()
            self._lock.close()
        where = shown_path(self.network.folder)
        self._told.append(deploying.FOLDER.at(Span(self.network.path), path=where, reason=reason))
        raise Faulty(self.diagnostics)


def _one_of(what: str, name: str, known: Collection[str], owner: str = "rcyaml") -> None:
    if name not in known:
        meant = suggest(name, known)
        hint = f"did you mean '{meant}'?" if meant else f"there are {', '.join(known)}"
        raise Refused(f"{owner} has no {what} '{name}'; {hint}")


def _ignore(event: object) -> None:
    """Nobody wants to be told."""
