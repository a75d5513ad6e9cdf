"""Running a deployment: its network is planned, started, watched and stopped."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Callable, Coroutine, Iterable, Sequence
from contextlib import ExitStack, aclosing, suppress
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec.structs import replace

from robocomp_yaml.api.refusals import require
from robocomp_yaml.deploy import folder, history, limits, operations, ownership, registered, renamed
from robocomp_yaml.deploy.carry_out import Report
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import KILLED, DeployFailed, Line
from robocomp_yaml.deploy.engines import ENGINES, LOCAL, engine_of, make_engine
from robocomp_yaml.deploy.install import installed
from robocomp_yaml.deploy.local import record
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, STOP_THEM, Choose, Result, Status
from robocomp_yaml.deploy.patterns import PatternTooSlow
from robocomp_yaml.deploy.plan import RESTART, START, STOP, Plan, disabled, unhealthy, with_dependences
from robocomp_yaml.deploy.plan import plan as make_plan
from robocomp_yaml.deploy.preparing import prepared
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import ERROR, WARNING, Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty, Refused, reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network
from robocomp_yaml.pipeline import Analysis

if TYPE_CHECKING:
    from robocomp_yaml.api.building import Built
    from robocomp_yaml.building.job import BuildEvent
    from robocomp_yaml.deploy.attached import Attached
    from robocomp_yaml.deploy.probe import ProbedProgram
    from robocomp_yaml.deploy.stale import StaleComponent

T = TypeVar("T")


class Deployment:
    """The network of a deployment, and its running processes.

    `path` is the path of its document as it was passed, `network` the derived network, `engine` the name of the engine.
    If the document cannot be read, `unread` is set, and the network is that of the running processes. `diagnostics` are
    those of the documents, then those of each call so far.

    The NAMEs in calls are processes, their aliases or groups; Refused is raised if one is unknown. Faulty is raised if
    an error leaves a call without a result. Only one process at a time may change a deployment.
    """

    def __init__(self, analysis: Analysis, path: str, engine: str | None = None, *, lenient: bool = False) -> None:
        require("engine", engine or LOCAL, ENGINES)
        self.path, self._analysis = path, analysis
        self.unread = (network := analysis.networks.get(os.path.realpath(path))) is None
        if network is None and lenient:
            from robocomp_yaml.deploy.stand_in import stand_in

            network, engine = stand_in(path) or (None, engine)
        elif network and (known := registered.of_folder(network.folder)):
            engine = engine_of(known, network, engine)
        if network is None or (has_errors(analysis.diagnostics) and not lenient):
            raise Faulty(analysis.diagnostics, analysis.program.documents)
        self.network: Network = network
        self._network = network  # without what protects it
        self._engine, self._lock = make_engine(engine, network), ExitStack()
        self._diagnostics: list[Diagnostic] = []
        linked = analysis.program.deployments.get(os.path.realpath(path))
        if not lenient and linked is not None and any(one.component for one in linked.instances.values()):
            from robocomp_yaml.check.flat.configs import replaced
            from robocomp_yaml.deploy.outdated import outdated

            own = [one.component for one in linked.instances.values() if one.entry.config is None and one.component]
            self._diagnostics = analysis.with_more([*outdated(linked), *replaced(analysis.program, dict.fromkeys(own))])

    @property
    def engine(self) -> str:
        return self._engine.name

    @property
    def diagnostics(self) -> list[Diagnostic]:
        return self.placed([*self._diagnostics, *self._engine.notes])

    @property
    def was_killed(self) -> bool:
        """Whether what supervised it was killed, with all its processes, and nobody has started or stopped it since."""
        killed = (one for one in self._engine.notes if one.code == deploying.NOT_SUPERVISED.id)
        return any(one.fact("what") == KILLED for one in killed)

    @property
    def installed(self) -> list[str]:
        """The hosts on which systemd starts the deployment at boot."""
        return installed.hosts_of(self.network.folder)

    @property
    def enabled(self) -> set[str]:
        """The names of the processes that are enabled."""
        return {process.name for process in self.network.enabled()}

    def add(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Adds diagnostics of a call to those of the deployment."""
        self._diagnostics += diagnostics

    def placed(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Diagnostics of an engine as users see them: with the path of the document as it was passed, which engines
        know by its absolute path, and without secrets."""
        return self._analysis.redacted(
            replace(one, span=replace(one.span, file=self.path)) if one.span.file == self.network.path else one
            for one in diagnostics
        )

    def chosen(self, names: Iterable[str]) -> set[str]:
        """The names of the processes that these NAMEs mean. Raises Refused if one is unknown."""
        found: set[str] = set()
        for name in names:
            members = {process.name for process in self.network.processes.values() if name in process.groups}
            process = self.network.find(name)
            if not members and process is None:
                groups = dict.fromkeys(group for one in self.network.processes.values() for group in one.groups)
                require("process or group", name, [*self.network.processes, *groups], self.network.name)
            found |= members or {one.name for one in [process] if one}
        return found

    def stale(self, *names: str) -> list[StaleComponent]:
        """The components whose programs are missing or stale, of those that are built and started on this machine; of
        NAMEs with all their dependences."""
        if not (components := self._analysis.program.components):
            return []
        from robocomp_yaml.api.building import units
        from robocomp_yaml.deploy.stale import stale

        chosen = with_dependences(self.network, self.chosen(names)) if names else self.enabled
        return stale(self.network, units(self._analysis, components.values()), chosen)

    def build(
        self, *names: str, build_type: str | None = None, report: Callable[[BuildEvent], None] | None = None
    ) -> list[Built]:
        """Builds the `stale` components, each with its last build type unless `build_type` is set. Returns one result
        for each build type."""
        from robocomp_yaml.api.building import build_stale

        return build_stale(self._analysis, self.stale(*names), build_type, report)

    def _report_stale(self, names: Iterable[str], severity: str = ERROR) -> bool:
        if not (components := self.stale(*names)):
            return False
        from robocomp_yaml.deploy import stale

        found = [one.as_severity(severity) for one in stale.diagnostics(self.network, components)]
        shown = self._analysis.for_users(self._analysis.without_suppressed(found).reported)
        self._diagnostics += shown
        return has_errors(shown)

    def _to_start(self, names: Sequence[str], restart: bool) -> tuple[set[str], set[str]]:
        """The names of the processes that these NAMEs mean, and of those that are restarted. Adds notes about them."""
        chosen = self.chosen(names)
        concerned = chosen or self.enabled
        self._diagnostics += [*limits.ignored(self.network, concerned), *disabled(self.network, names)]
        return chosen, concerned if restart else set()

    def plan(self, *names: str, restart: bool = False) -> Plan:
        """The plan of `up`: what it would start, stop, restart and change, and why. The diagnostics have the
        obstacles."""
        chosen, forced = self._to_start(names, restart)
        renamed.refuse(self.network)
        self._report_stale(names)

        async def work() -> Plan:
            self.network = prepared(self._network, create=False)
            is_running = await self._engine.open(self.network, create=False)
            running = await self._engine.observe() if is_running else {}
            alive = {name for name, one in running.items() if one.is_alive}
            found = make_plan(await operations.without_present(self.network, alive), running, chosen, forced)
            self._diagnostics += unhealthy(found)
            specs = [step.spec for step in found.of(START, RESTART) if step.spec]
            self._diagnostics += await self._engine.obstacles(specs, {step.name for step in found.of(STOP, RESTART)})
            await self._engine.close()
            return found

        return self._run(work())

    def up(
        self, *names: str, restart: bool = False, on_failure: str | Choose = STOP_THEM, timeout: float | None = None,
        report: Report | None = None, stays: Attached | None = None,
    ) -> Result:  # fmt: skip
        """Starts the network, and returns when it is ready: starts each process as soon as its dependences are ready,
        restarts what changed, and stops what is no longer in the network. With `restart`, the named processes are
        restarted.

        `on_failure` is what happens to the started processes if one fails: `stop`, `rollback`, `keep`, or a function
        that is asked. `timeout` is in seconds; `report` gets each event. With `stays`, the call returns when the
        network is stopped again.
        """
        if isinstance(on_failure, str):
            require("way to handle failures", on_failure, (STOP_THEM, ROLL_BACK, KEEP_GOING))
        (chosen, forced), limit = self._to_start(names, restart), TimeLimit(timeout)
        renamed.refuse_start(self.network)
        if chosen and not os.path.isdir(self.network.folder):
            chosen |= self.enabled.intersection(record.running(self.network.folder))
        if self._report_stale(names):
            raise Faulty(self.diagnostics)
        decided = operations.always(on_failure) if isinstance(on_failure, str) else on_failure

        async def work() -> Result:
            await self._engine.open(self.network, create=True)
            try:
                self.network = prepared(self._network, create=True)
                return await changed()
            except BaseException:
                with suppress(Exception):  # no supervisor stays without a process
                    await operations.end_if_idle(self._engine, self.network.folder)
                raise

        async def changed() -> Result:
            from robocomp_yaml.deploy.attached import attached

            async with attached(self._engine, self.network, stays) as follow:
                result = await operations.up(
                    self._engine, self.network, chosen, forced, decided, report or _ignore,
                    keep_going=on_failure == KEEP_GOING, limit=limit,
                )  # fmt: skip
                self._diagnostics += result.diagnostics
                if stays and not result.diagnostics:
                    self._lock.close()  # another process may change what runs
                    self._diagnostics += await follow()
            is_known = result.plan.is_empty and history.is_there(self.network.folder)
            if not has_errors(result.diagnostics) and not stays and not is_known:
                with suppress(OSError):  # a full disk
                    history.keep(self.network.folder, (await self._engine.observe()).values())
            if result.diagnostics or stays:
                await operations.end_if_idle(self._engine, self.network.folder, is_down=stays is not None)
            else:
                await self._engine.close()
            return result

        return self._run(work(), change=True)

    def rollback(
        self, *, on_failure: str | Choose = STOP_THEM, timeout: float | None = None, report: Report | None = None
    ) -> Result:
        """Goes back to the last `up` that was all ready and differs from what runs: its processes, commands and
        configurations. Programs that were rebuilt since then stay rebuilt. Raises Refused if there was none."""
        own = self.network.folder
        renamed.refuse_start(self.network)
        decided = operations.always(on_failure) if isinstance(on_failure, str) else on_failure

        async def work() -> Result:
            is_running = await self._engine.open(self.network, create=False)
            entries = history.before(own, (await self._engine.observe()).values() if is_running else ())
            await self._engine.close()
            if not entries:
                nothing = "no `up` that was all ready since the last `down`"
                why = "only what runs now" if history.is_there(own) else nothing
                raise Refused(f"{self.network.name} cannot go back: rcyaml knows {why}")
            target = history.network_of(self.network.name, self.network.path, own, entries[-1], self.network)
            self._engine = make_engine(self.engine, target)
            await self._engine.open(target, create=True)
            result = await operations.up(
                self._engine, target, (), (), decided, report or _ignore, keep_going=on_failure == KEEP_GOING,
                limit=TimeLimit(timeout),
            )  # fmt: skip
            self._diagnostics += result.diagnostics
            if not has_errors(result.diagnostics):
                history.cut(own, entries)
            await operations.end_if_idle(self._engine, own)
            return result

        return self._run(work(), change=True)

    def status(self, *names: str) -> list[Status]:
        """The state of each process."""
        chosen = self.chosen(names)
        if not self.unread:
            self._report_stale(names, WARNING)

        async def work() -> list[Status]:
            is_running = await self._engine.open(self.network, create=False)
            found = await operations.status(self._engine, self.network, chosen, is_running)
            await self._engine.close()
            return found

        return self._run(work())

    def logs(
        self, *names: str, last: int | None = 20, follow: bool = False, on_line: Callable[[Line], None] | None = None,
        since: str = "", pattern: str = "",
    ) -> list[Line]:  # fmt: skip
        """The `last` lines of each process (None: all), in the order in which they were written. If `on_line` is set,
        it is called with each line instead; with `follow`, also with each new line, until it raises. `since` is a time
        in UTC as lines have it, `pattern` a regular expression: other lines are omitted. Raises Refused if the pattern
        is none, or takes too long."""
        from robocomp_yaml.deploy.log_filter import LogFilter, selected

        chosen = self.chosen(names) or self.enabled
        chosen_lines, found = LogFilter(since, pattern), list[Line]()

        async def work() -> None:
            await self._engine.open(self.network, create=False)
            requested = [name for name in self.network.processes if name in chosen]
            async with aclosing(selected(self._engine, requested, last, follow, chosen_lines)) as lines:
                async for line in lines:
                    (on_line or found.append)(line)
            await self._engine.close()

        try:
            re.compile(pattern)
            self._run(work())
        except re.error as error:
            raise Refused(f"'{pattern}' is not a regular expression: {error}") from error
        except PatternTooSlow as error:
            raise Refused(
                f"the pattern '{pattern}' takes too long: write it without a repetition in a repetition"
            ) from error
        return found

    def stopping(self, *names: str) -> list[str]:
        """The names of the running processes that `down` would stop, with all that depend on them, as they stop."""
        chosen = self.chosen(names)

        async def work() -> list[str]:
            is_running = await self._engine.open(self.network, create=False)
            running = await self._engine.observe() if is_running else {}
            await self._engine.close()
            return [name for name in operations.leaving(running, chosen) if running[name].is_alive]

        return self._run(work())

    def down(self, *names: str, report: Report | None = None) -> list[str]:
        """Stops the network, or the named processes with all that depend on them. Returns the names of the stopped
        processes."""
        work = operations.take_down(self._engine, self.network, self.chosen(names), report or _ignore)
        return self._run(work, change=True)

    def probe(self, host: str = "") -> dict[str, list[ProbedProgram]]:
        """Which programs of the network a host has, by host; by default, for all hosts. A host that does not answer is
        reported in the diagnostics."""
        from robocomp_yaml.deploy import probe

        known = self.network.hosts
        if host:
            require("host", host, known, self.network.name)
        answers, failed = asyncio.run(probe.ask(self.network, [known[host]] if host else list(known.values())))
        self._diagnostics += failed
        return answers

    def export(self, form: str, *, reveal: bool = True) -> dict[str, str]:
        """The files from which another tool runs the network, by path. Secrets are hidden unless `reveal` is set.
        Raises Refused if the format is unknown, Faulty if it cannot express the network."""
        from robocomp_yaml.api import exporting

        plugins = self._analysis.program.plugins_of(self.path)
        files, diagnostics = exporting.export(self.network, form, plugins, reveal=reveal)
        self._diagnostics += diagnostics
        if has_errors(diagnostics):
            raise Faulty(self.diagnostics)
        return files

    def write_export(self, form: str, output: str) -> list[str]:
        """Writes the files of an export below a folder, readable only for their owner. Returns their paths. Raises
        Faulty if one would overwrite a file that no export wrote, Refused if a file cannot be written."""
        from robocomp_yaml.api import exporting

        files = self.export(form)
        self._diagnostics += exporting.write(output, files)
        if has_errors(self._diagnostics):
            raise Faulty(self.diagnostics)
        return [os.path.normpath(os.path.join(output, path)) for path in files]

    def _run(self, work: Coroutine[Any, Any, T], *, change: bool = False) -> T:
        """Runs a call; `change` takes the lock of the deployment. Raises Faulty."""
        try:
            ownership.require(self.network)
            if not change:
                return asyncio.run(work)
            renamed.refuse(self.network)
            if self._lock.enter_context(folder.locked(self.network.folder)):
                return asyncio.run(work)
            reason = "another rcyaml is changing this deployment"
        except DeployFailed as error:
            self._diagnostics += [*self._engine.notes, error.diagnostic]
            self._engine.notes = []
            raise Faulty(self.diagnostics) from error
        except BrokenPipeError:
            raise  # the reader of standard output closed the pipe
        except OSError as error:
            reason = reason_of(error)
        finally:
            work.close()
            self._lock.close()
        where, span = shown_path(self.network.folder), Span(self.network.path)
        self._diagnostics.append(deploying.FOLDER.at(span, path=where, reason=reason))
        raise Faulty(self.diagnostics)


def _ignore(event: object) -> None:
    """Drops an event."""
