"""The engine for several machines: a client of the deployment's IceGrid.

Calls of Ice and IceGrid block, so that they run in threads beside the event loop.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import threading
from collections.abc import AsyncGenerator, Callable, Collection, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import ownership, registered
from robocomp_yaml.deploy.engine import STOP_WITHIN, DeployFailed, Line, Running
from robocomp_yaml.deploy.here import is_near, local_host
from robocomp_yaml.deploy.icegrid import obstacles as of_hosts
from robocomp_yaml.deploy.icegrid import start_up
from robocomp_yaml.deploy.icegrid.failures import GridFailed
from robocomp_yaml.deploy.icegrid.grid_files import KEEPER, GridFiles
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.local.log_reader import LineReader, LogReader, merged
from robocomp_yaml.deploy.local.obstacles import CheckedSpecs, obstacles
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import ResourceLimits
from robocomp_yaml.network.network import NEVER, PROGRAM, Network, RestartRule

if TYPE_CHECKING:
    from robocomp_yaml.deploy.icegrid.grid import GridSession

T = TypeVar("T")

_RULE_WITHIN = 10.0
_TIMED_OUT, _NOT_FOUND, _UNKNOWN = 124, 127, 1
_CODE = "exit code "
_RESERVE, _RESERVED = "reserve", 1 << 18  # bytes: for specs, rules and the registry's database
_CHECK_WITHIN = 60.0
_CALLS = 32  # threads, which mostly wait


class IceGridEngine:
    """See `deploy.engine.Engine`."""

    name = "icegrid"

    def __init__(self) -> None:
        self.notes: list[Diagnostic] = []
        self._network = Network("", "", "")
        self._files = GridFiles("")
        self._grid: GridSession | None = None
        self._specs: dict[str, ProcessSpec | None] = {}
        self._desired: set[str] = set()
        self._kept: set[str] = set()  # the desired processes that are in the file
        self._nodes: asyncio.Task[None] | None = None  # starts the nodes; what needs no node does not wait
        self._no_node: dict[str, Diagnostic] = {}  # by the name of the host
        self._cleared = CheckedSpecs()
        self._has_staged = self._has_changed = False
        self._early: dict[str, str] = {}  # files that were staged before `stage`
        self._far: set[str] = set()  # other hosts that were used before
        self._unreached: dict[str, set[str]] = {}  # processes that could not be ended, by the name of the host
        self._lock = threading.Lock()
        self._calls = ThreadPoolExecutor(_CALLS, "icegrid")

    async def open(self, network: Network, *, create: bool) -> bool:
        ownership.require(network)
        self._network, self._files = network, GridFiles(network.folder)
        if lacking := of_hosts.missing():
            raise DeployFailed(deploying.NO_REGISTRY.at(Span(network.path), reason=lacking))
        if create:  # the import takes as long as the deployment's key and the start of the registry
            self._calls.submit(importlib.import_module, "robocomp_yaml.deploy.icegrid.grid")
        self._grid = await self._call("", "reached", self._reach, create)
        if self._grid is None:
            return start_up.is_running_without_files(self._files, network)
        self._has_changed = create
        if create:
            with contextlib.suppress(OSError):
                registered.keep(registered.entry_of(network, self.name))
            self._nodes = asyncio.create_task(self._call("", "reached", self._ensure_nodes, self._grid))
            await asyncio.sleep(0)  # so that it starts
        self._specs = self._files.specs()
        self._far = {spec.process.host for spec in self._specs.values() if spec and not is_near(spec)}
        self._kept = self._desired = self._files.desired()
        return True

    def _reach(self, create: bool) -> GridSession | None:
        self.notes += start_up.continue_halted(self._files, self._network)
        grid = start_up.reached(self._files, self._network)
        if grid and create:
            grid.close()
        return start_up.created(self._files, self._network) if create else grid

    def _ensure_nodes(self, grid: GridSession) -> None:
        used = {process.host for process in self._network.enabled()}
        hosts = [host for host in self._network.hosts.values() if host.name in used]
        self._files.keep_folders(hosts)
        try:
            self._no_node = start_up.ensure_nodes(grid, self._files, self._network, hosts)
        except BaseException:
            if self._files.desired():
                grid.close()
            else:
                start_up.ended(grid, self._network)
            raise
        self._end_leftovers(grid)

    def _end_leftovers(self, grid: GridSession) -> None:
        """Ends leftovers, as the keeper does: there may be no keeper. A failure is ignored, because the keeper tries
        again."""
        from robocomp_yaml.deploy.icegrid import leftovers

        with contextlib.suppress(GridFailed):
            leftovers.end_all(grid)

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        from robocomp_yaml.deploy.icegrid.status import observe

        if not self._has_changed:  # another command may have changed them since they were read
            self._specs = self._files.specs() or self._specs
        if not self._specs:
            return {}
        hosts = {name: process.host for name, process in self._network.processes.items()}
        return await self._beside("", "observed", partial(observe, use=use), self._reached(), {**self._specs}, hosts)

    async def obstacles(self, specs: Sequence[ProcessSpec], leaving: Collection[str]) -> list[Diagnostic]:
        """The obstacles on all hosts, and missing nodes."""
        running = await self.observe() if self._grid else {}
        roots = {one.pid for name, one in running.items() if name in leaving and one.pid}
        own = procfs.descendants(roots, procfs.table()) if roots else set()
        found = obstacles([spec for spec in specs if is_near(spec)], own)
        if not found:
            self._cleared.note(specs)
        if self._nodes:
            if not found:  # while they start; `stage` reports a failure
                with contextlib.suppress(DeployFailed):
                    await self._call("", "prepared", self._stage_near, specs)
            await asyncio.shield(self._nodes)
        lost = {spec.process.host: self._no_node[spec.process.host] for spec in specs
                if spec.process.host in self._no_node}  # fmt: skip
        far = [spec for spec in specs if not is_near(spec) and spec.process.host not in lost]
        found += await of_hosts.used_ports(far, running)
        if far and self._grid:
            found += await self._beside("", "asked", self._lacking, far)
        return [*lost.values(), *found, *of_hosts.too_long(specs)]

    def _lacking(self, specs: Sequence[ProcessSpec]) -> list[Diagnostic]:
        """Diagnostics for all that other hosts lack, or have in another version, before anything is started."""
        from robocomp_yaml.deploy.icegrid import preflight

        def run(spec: ProcessSpec, command: tuple[str, ...], lines: list[str]) -> int:
            return self._run(self._reached(), spec, command, _CHECK_WITHIN, lines)

        return preflight.lacking(self._network, specs, run)

    async def stage(self, specs: Sequence[ProcessSpec]) -> None:
        await self._beside("", "prepared", self._stage, specs)

    def _stage(self, specs: Sequence[ProcessSpec]) -> None:
        """Stages the configurations for this machine, and reserves space on other hosts: there, `run` writes the
        configurations at the start."""
        from robocomp_yaml.deploy.icegrid import far_space

        self._stage_near(specs)
        self._early = {}
        running = {name: spec for name, spec in self._specs.items() if spec and name in self._desired}
        far_space.reserve(self._files, specs, running, partial(self._run, self._reached()))

    def _stage_near(self, specs: Sequence[ProcessSpec]) -> None:
        """Stages the configurations for this machine, and space for the engine's own files, unless they are staged."""
        self._has_staged = True
        files = {path: text for spec in specs if is_near(spec) for path, text in spec.config_files.items()}
        files[_RESERVE] = " " * _RESERVED
        if files != self._early:
            self._early = {}  # a failure leaves nothing staged
            own_folder.stage(self._files.folder, files)
            self._early = files

    async def prepare(self, specs: Sequence[ProcessSpec]) -> None:
        await self._beside("", "deployed", self._prepare, specs)

    def _prepare(self, specs: Sequence[ProcessSpec]) -> None:
        from robocomp_yaml.deploy.icegrid import descriptors, leftovers

        own_folder.remove(self._files.folder, f"{own_folder.STAGED}/{_RESERVE}")
        grid, number = self._reached(), self._files.next_rule()
        before = grid.descriptor(self._network.name)
        deployed = {one.id for node in before.nodes.values() for one in node.servers} if before else set()
        states = {spec.name: ("", 0) for spec in specs}
        states |= grid.states([spec.name for spec in specs if spec.name in deployed])
        running = [spec for spec in specs if states[spec.name][0] not in ("", "Inactive")]
        starting = [spec for spec in specs if spec not in running]
        for spec in starting:
            leftovers.drop(self._files, spec.process.host, spec.name)
            old = self._specs.get(spec.name)
            if old and old.process.host != spec.process.host:
                if states[spec.name][0]:
                    leftovers.clean(grid, old.process.host, [spec.name])
                else:
                    leftovers.note(self._files, old.process.host, spec.name)
        for spec in specs:
            for file, text in spec.config_files.items() if is_near(spec) else ():
                own_folder.put(self._files.folder, file, text)
        with self._lock:
            self._specs.update({spec.name: spec for spec in specs})
            self._files.keep_specs(self._specs)
            hosts = {spec.process.host for spec in starting}
            nodes = {host: (self._files.on(host), grid.user_of(host)) for host in hosts}
            servers = [
                (host, descriptors.server(*nodes[host], spec, number, is_local=is_near(spec)))
                for spec in starting for host in [spec.process.host]
            ]  # fmt: skip
            if servers:
                self._deploy({spec.name for spec in starting}, servers)
        for spec in running:
            self._pass_rule(grid, spec, number)

    def _pass_rule(self, grid: GridSession, spec: ProcessSpec, number: int) -> None:
        """Passes the rules of a running process to its `run`."""
        from robocomp_yaml.deploy.icegrid.descriptors import alive_rule, restart_rule

        path = self._files.on(spec.process.host).rule(spec.name)
        script = 'mkdir -p -- "${2%/*}" && printf "%s\\n" "$1" >"$2.new" && mv -- "$2.new" "$2"'
        rules = f"{restart_rule(spec.process, number)}\n{alive_rule(spec.process)}"
        self._run(grid, spec, ("bash", "-c", script, "bash", rules, path), _RULE_WITHIN)

    def _deploy(self, replaced: Collection[str], servers: list[tuple[str, Any]]) -> None:
        """Deploys these servers, and all that were deployed before except the replaced ones."""
        from robocomp_yaml.deploy.icegrid import descriptors

        grid = self._reached()
        before = grid.descriptor(self._network.name)
        if before is not None:
            servers += [
                (host, one) for host, node in before.nodes.items() for one in node.servers if one.id not in replaced
            ]
        if (
            all(one.id != KEEPER for _, one in servers)
            and (host := local_host(self._network)) not in self._no_node
            and host
        ):
            servers.append((host, descriptors.keeper(self._files, grid.user_of(host))))
        grid.deploy(descriptors.application(self._network.name, servers), is_new=before is None)

    async def start(self, name: str) -> None:
        spec = self._specs[name]
        if spec and is_near(spec):
            self._cleared.require(spec)
        await self._set_desired(self._desired | {name})
        await self._beside(name, "started", self._reached().start, name)

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        await self._set_desired(self._desired - {name})
        await self._beside(name, "stopped", start_up.stop, self._reached(), name, self._specs.get(name))

    async def _set_desired(self, names: set[str]) -> None:
        """Sets the desired processes. Returns when they are in the file, with those of concurrent calls."""
        self._desired = names
        await asyncio.sleep(0)  # until all concurrent calls have set theirs
        with self._lock:
            if self._kept != self._desired:
                self._files.keep_desired(self._desired)
                self._kept = self._desired

    async def forget(self, names: Iterable[str]) -> None:
        await self._beside("", "forgotten", self._forget, set(names))

    def _forget(self, names: set[str]) -> None:
        from robocomp_yaml.deploy.icegrid import leftovers

        with self._lock:
            if not (gone := {name: self._specs.pop(name) for name in names if name in self._specs}):
                return
            states = self._reached().states(gone)
            for name, spec in gone.items():
                if spec and not states[name][0] and not is_near(spec):
                    leftovers.note(self._files, spec.process.host, name)
                    self._unreached.setdefault(spec.process.host, set()).add(name)
            self._deploy(gone, [])
            self._kept = self._desired = self._desired - names
            self._files.keep_desired(self._desired)
            self._files.keep_specs(self._specs)
        by_host: dict[str, list[str]] = {}
        for name, spec in gone.items():
            if spec and spec.process.config and states[name][0] and not is_near(spec):
                by_host.setdefault(spec.process.host, []).append(name)
        for host, own in by_host.items():
            leftovers.clean(self._reached(), host, own)
        for name, spec in gone.items():
            own_folder.remove(self._files.folder, f"state/icegrid/status/{name}")
            for file in spec.config_files if spec else ():
                own_folder.remove(self._files.folder, file)

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        from robocomp_yaml.deploy.icegrid.grid import GridReader

        def reader(name: str) -> LineReader:
            if grid and name in far:
                return GridReader(grid, name, far[name])
            return LogReader(self._files.folder, name)

        specs, grid = {name: self._specs.get(name) for name in names}, self._grid
        far = {name: spec.process.host for name, spec in specs.items() if grid and spec and not is_near(spec)}
        if not far:
            return merged([reader(name) for name in names], last, follow)
        readers = await self._beside("", "read", lambda: [reader(name) for name in names])
        return merged(readers, last, follow, is_far=True)

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        spec = self._specs[name]
        assert spec
        return await self._beside(name, "asked", self._run, self._reached(), spec, tuple(command), within)

    def _run(
        self, grid: GridSession, spec: ProcessSpec, command: tuple[str, ...], within: float,
        lines: list[str] | None = None,
    ) -> int:  # fmt: skip
        """The exit code of a command that runs beside a process, on its host: as a server of its own. Its output is
        added to `lines`."""
        from robocomp_yaml.deploy.icegrid import descriptors
        from robocomp_yaml.deploy.icegrid.status import run_status

        host, is_local = spec.process.host, is_near(spec)
        name = f"{spec.name}.ready"
        process = replace(
            spec.process, name=name, kind=PROGRAM, config=None, folders=(), restart=RestartRule(NEVER), alive=None,
            limits=ResourceLimits(),
        )  # fmt: skip
        own = replace(spec, process=process, command=command)
        server = descriptors.server(self._files.on(host), grid.user_of(host), own, 0, is_local=is_local)
        with self._lock:
            self._deploy([name], [(host, server)])
        try:
            if not grid.run(name, within):
                grid.stop(name)
                return _TIMED_OUT
            last = run_status(grid, name, host, is_local=is_local)
            code = last.last_exit.removeprefix(_CODE) if last else ""
            if lines is not None:
                lines += grid.printed(name, self._files.on(host).log(name))
            return int(code) if code.isdigit() else _UNKNOWN
        except GridFailed:
            return _NOT_FOUND
        finally:
            with self._lock:
                self._deploy([name], [])
            if is_local:
                own_folder.remove(self._files.folder, f"state/icegrid/status/{name}")
                own_folder.remove(self._files.folder, f"logs/{name}.log")

    async def close(self, *, end: bool = False) -> None:
        grid, self._grid = self._grid, None
        if self._has_staged:
            own_folder.drop_staged(self._files.folder)
        if end:  # without a session, the registry was killed before it had anything to start
            lost = await self._beside("", "ended", start_up.ended, grid or self._files, self._network)
            self._unreached |= {host: set() for host in lost if host not in self._unreached}
        elif grid:
            if self._has_changed:
                await self._beside("", "left", start_up.end_idle_nodes, grid, self._specs, self._far)
            await self._beside("", "left", grid.close)
        self.notes += [
            of_hosts.not_reached(self._network, host, sorted(names)) for host, names in self._unreached.items()
        ]
        self._unreached.clear()
        if self._has_changed and not end:
            with contextlib.suppress(OSError):  # a full or read-only disk
                known = registered.of_folder(self._files.folder)
                registered.keep(known or registered.entry_of(self._network, self.name))
                registered.copy(self._files.folder, self._files.copied)
        self._calls.shutdown(wait=False)

    def _reached(self) -> GridSession:
        assert self._grid, "open it first"
        return self._grid

    async def _beside(self, about: str, what: str, work: Callable[..., T], *arguments: Any) -> T:
        """Runs a blocking function when the nodes have been started."""
        if self._nodes:
            await asyncio.shield(self._nodes)
        return await self._call(about, what, work, *arguments)

    async def _call(self, about: str, what: str, work: Callable[..., T], *arguments: Any) -> T:
        """Runs a blocking function. An error is reported for the process of the name `about`, if there is one."""
        try:
            return await asyncio.get_running_loop().run_in_executor(self._calls, work, *arguments)
        except GridFailed as error:
            where, name = self._network.span_of(about), about or self._network.name
            raise DeployFailed(deploying.CANNOT.at(where, name=name, what=what, reason=error)) from error
        except OSError as error:
            where, path = Span(self._network.path), error.filename or self._network.folder
            raise DeployFailed(deploying.FOLDER.at(where, path=path, reason=reason_of(error))) from error
