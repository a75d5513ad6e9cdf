"""The engine of several machines: what `deploy` asks of a deployment's IceGrid.

Ice and IceGrid's own calls wait for their answers; they run in threads beside the event loop.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import shutil
import threading
from collections.abc import AsyncGenerator, Callable, Collection, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, TypeVar

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, STOP_WITHIN, STOPPED, DeployFailed, Line, Running
from robocomp_yaml.deploy.icegrid.places import Places
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.local.log_reader import LogReader
from robocomp_yaml.deploy.local.log_reader import merged as merged_here
from robocomp_yaml.deploy.local.obstacles import Cleared, is_here, obstacles
from robocomp_yaml.deploy.readiness import listens
from robocomp_yaml.deploy.spec import Spec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network

if TYPE_CHECKING:
    from robocomp_yaml.deploy.icegrid.grid import Grid

T = TypeVar("T")

_TOO_LONG = "its configuration is longer than the 100,000 bytes that IceGrid carries to another host"
_RULE_WITHIN = 10.0
_CALLS = 32  # at once: each waits, and costs next to nothing


class IceGridEngine:
    """See `deploy.engine.Engine`."""

    name = "icegrid"

    def __init__(self) -> None:
        self.notes: list[Diagnostic] = []
        self._network = Network("", "", "")
        self._places = Places("")
        self._grid: Grid | None = None
        self._specs: dict[str, Spec | None] = {}
        self._wanted: set[str] = set()
        self._kept: set[str] = set()  # those of the wanted that are written down
        self._nodes: asyncio.Task[None] | None = None  # brings them up; what needs none need not wait
        self._no_node: dict[str, Diagnostic] = {}  # by the host
        self._cleared = Cleared()
        self._lock = threading.Lock()
        self._calls = ThreadPoolExecutor(_CALLS, "icegrid")

    async def open(self, network: Network, *, create: bool) -> bool:
        self._network, self._places = network, Places(network.folder)
        if missing := _missing():
            raise DeployFailed(deploying.NO_REGISTRY.at(Span(network.path), reason=missing))
        self._grid = await self._call("", "reached", self._reach, create)
        if self._grid is None:
            return False
        if create:
            self._nodes = asyncio.create_task(self._call("", "reached", self._ensure_nodes, self._grid))
            await asyncio.sleep(0)  # so that it begins
        self._specs = self._places.specs()
        self._kept = self._wanted = self._places.wanted()
        return True

    def _reach(self, create: bool) -> Grid | None:
        from robocomp_yaml.deploy.icegrid import start_up

        grid = start_up.reached(self._places, self._network)
        if grid and create:
            grid.close()
        return start_up.created(self._places, self._network) if create else grid

    def _ensure_nodes(self, grid: Grid) -> None:
        from robocomp_yaml.deploy.icegrid import start_up

        used = {process.host for process in self._network.enabled()}
        hosts = [host for host in self._network.hosts.values() if host.name in used]
        try:
            self._no_node = start_up.ensure_nodes(grid, self._places, self._network, hosts)
        except BaseException:
            if self._places.wanted():
                grid.close()
            else:
                start_up.ended(grid, self._places, self._network.name)
            raise
        self._end_left(grid)

    def _end_left(self, grid: Grid) -> None:
        """The keeper does so too: where there is none, or it was faster, nothing is lost."""
        from robocomp_yaml.deploy.icegrid import leftovers
        from robocomp_yaml.deploy.icegrid.grid import GridFailed

        with contextlib.suppress(GridFailed):
            leftovers.end_all(grid, self._places)

    async def observe(self) -> dict[str, Running]:
        from robocomp_yaml.deploy.icegrid.status import observe

        if not self._specs:
            return {}
        hosts = {name: process.host for name, process in self._network.processes.items()}
        return await self._beside("", "observed", observe, self._reached(), self._places, dict(self._specs), hosts)

    async def obstacles(self, specs: Sequence[Spec], leaving: Collection[str]) -> list[Diagnostic]:
        """On this machine all that can be known; of other hosts, whether they have a node, and the ports."""

        running = await self.observe() if self._grid else {}
        roots = {one.pid for name, one in running.items() if name in leaving and one.pid}
        own = procfs.descendants(roots, procfs.table()) if roots else set()
        found = obstacles([spec for spec in specs if is_here(spec.address)], own)
        if not found:
            self._cleared.note(specs)
        if self._nodes:
            await asyncio.shield(self._nodes)
        lost = {spec.process.host: self._no_node[spec.process.host] for spec in specs
                if spec.process.host in self._no_node}  # fmt: skip
        far = [spec for spec in specs if not is_here(spec.address) and spec.process.host not in lost]
        found += await taken(far, running)
        return [*lost.values(), *found] + [
            deploying.REFUSED.at(spec.process.span, name=spec.name, what="started", reason=_TOO_LONG)
            for spec in specs
            if _is_too_long(spec)
        ]

    async def prepare(self, specs: Sequence[Spec]) -> None:
        await self._beside("", "deployed", self._prepare, specs)

    def _prepare(self, specs: Sequence[Spec]) -> None:
        from robocomp_yaml.deploy.icegrid import descriptors, leftovers

        grid, number = self._reached(), self._places.next_rule()
        before = grid.descriptor(self._network.name)
        deployed = {one.id for node in before.nodes.values() for one in node.servers} if before else set()
        states = {spec.name: ("", 0) for spec in specs}
        states |= grid.states([spec.name for spec in specs if spec.name in deployed])
        running = [spec for spec in specs if states[spec.name][0] not in ("", "Inactive")]
        starting = [spec for spec in specs if spec not in running]
        for spec in specs:
            if spec.process.config and is_here(spec.address):
                own_folder.write(self._places.folder, spec.process.config.path, spec.process.config.text)
        for spec in starting:
            leftovers.drop(self._places, spec.process.host, spec.name)
            old = self._specs.get(spec.name)
            if old and old.process.host != spec.process.host and not states[spec.name][0]:
                leftovers.note(self._places, old.process.host, spec.name)
        with self._lock:
            self._specs.update({spec.name: spec for spec in specs})
            self._places.keep_specs(self._specs)
            users = {host: grid.user_of(host) for host in {spec.process.host for spec in starting}}
            servers = [
                (spec.process.host, descriptors.server(
                    self._places, spec, users[spec.process.host], number, is_here=is_here(spec.address)
                ))
                for spec in starting
            ]  # fmt: skip
            if servers:
                self._deploy({spec.name for spec in starting}, servers)
        for spec in running:
            self._pass_rule(grid, spec, number)

    def _pass_rule(self, grid: Grid, spec: Spec, number: int) -> None:
        """Tells `run` how it is to restart a process that goes on."""
        from robocomp_yaml.deploy.icegrid.beside import run_beside
        from robocomp_yaml.deploy.icegrid.descriptors import restart_rule

        path = self._places.rule(spec.name)
        script = 'mkdir -p -- "${2%/*}" && printf "%s\\n" "$1" >"$2.new" && mv -- "$2.new" "$2"'
        command = ("bash", "-c", script, "bash", restart_rule(spec.process, number), path)
        run_beside(grid, self._places, spec, command, _RULE_WITHIN, self._lock, self._deploy)

    def _deploy(self, replaced: Collection[str], servers: list[tuple[str, Any]]) -> None:
        """Deploys these servers, and those that were deployed before except the replaced."""
        from robocomp_yaml.deploy.icegrid import descriptors

        grid = self._reached()
        before = grid.descriptor(self._network.name)
        if before is not None:
            servers += [
                (host, one) for host, node in before.nodes.items() for one in node.servers if one.id not in replaced
            ]
        elif keeper_host := self._host_here():
            servers.append((keeper_host, descriptors.keeper(self._places, grid.user_of(keeper_host))))
        grid.deploy(descriptors.application(self._network.name, servers), is_new=before is None)

    def _host_here(self) -> str:
        """A host that is this machine, on which the keeper can run."""
        used = {process.host for process in self._network.enabled()}
        here = (host.name for host in self._network.hosts.values() if host.name in used and is_here(host.address))
        return next(here, "")

    async def start(self, name: str) -> None:
        spec = self._specs[name]
        if spec and is_here(spec.address) and not self._cleared.take(spec) and (found := obstacles([spec], ())):
            raise DeployFailed(found[0])
        await self._want(self._wanted | {name})
        await self._beside(name, "started", self._reached().start, name)

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        await self._want(self._wanted - {name})
        await self._beside(name, "stopped", self._reached().stop, name)

    async def _want(self, names: set[str]) -> None:
        """Returns when they are written down, together with those that are wanted meanwhile."""
        self._wanted = names
        await asyncio.sleep(0)  # until all that begin at once have said what they want
        with self._lock:
            if self._kept != self._wanted:
                self._places.keep_wanted(self._wanted)
                self._kept = self._wanted

    async def forget(self, names: Iterable[str]) -> None:
        await self._beside("", "forgotten", self._forget, set(names))

    def _forget(self, names: set[str]) -> None:
        from robocomp_yaml.deploy.icegrid import leftovers

        with self._lock:
            gone = {name: self._specs.pop(name) for name in names if name in self._specs}
            if not gone:
                return
            states = self._reached().states(gone)
            for name, spec in gone.items():
                if spec and not states[name][0]:
                    leftovers.note(self._places, spec.process.host, name)
            self._deploy(gone, [])
            self._kept = self._wanted = self._wanted - names
            self._places.keep_wanted(self._wanted)
            self._places.keep_specs(self._specs)
        for name, spec in gone.items():
            own_folder.remove(self._places.folder, f"state/icegrid/status/{name}")
            if spec and spec.process.config:
                own_folder.remove(self._places.folder, spec.process.config.path)

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        from robocomp_yaml.deploy.icegrid.logs import GridReader, merged

        def reader(name: str) -> LogReader | GridReader:
            spec = self._specs.get(name)
            if grid and spec and not is_here(spec.address):
                return GridReader(grid, name, self._places.log(name))
            return LogReader(self._places.folder, name)

        specs, grid = [self._specs.get(name) for name in names], self._grid
        if grid is None or all(spec is None or is_here(spec.address) for spec in specs):
            return merged_here([LogReader(self._places.folder, name) for name in names], last, follow)
        return merged(await self._beside("", "read", lambda: [reader(name) for name in names]), last, follow)

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        from robocomp_yaml.deploy.icegrid.beside import run_beside

        spec = self._specs[name]
        assert spec
        grid = self._reached()
        return await self._beside(name, "asked", run_beside, grid, self._places, spec, tuple(command), within,
                                  self._lock, self._deploy)  # fmt: skip

    async def close(self, *, end: bool = False) -> None:
        from robocomp_yaml.deploy.icegrid import start_up

        grid, self._grid = self._grid, None
        if grid and end:
            await self._beside("", "ended", start_up.ended, grid, self._places, self._network.name)
        elif grid:
            await self._beside("", "left", grid.close)
        self._calls.shutdown(wait=False)

    def _reached(self) -> Grid:
        assert self._grid, "open it first"
        return self._grid

    async def _beside(self, about: str, what: str, work: Callable[..., T], *arguments: Any) -> T:
        """Carries out work when the nodes are there."""
        if self._nodes:
            await asyncio.shield(self._nodes)
        return await self._call(about, what, work, *arguments)

    async def _call(self, about: str, what: str, work: Callable[..., T], *arguments: Any) -> T:
        """Carries out work that waits; what fails it is told of the process of that name, where there is one."""
        from robocomp_yaml.deploy.icegrid.grid import GridFailed

        try:
            return await asyncio.get_running_loop().run_in_executor(self._calls, work, *arguments)
        except GridFailed as error:
            process = self._network.processes.get(about)
            where = process.span if process and process.span.file else Span(self._network.path)
            name = about or self._network.name
            raise DeployFailed(deploying.REFUSED.at(where, name=name, what=what, reason=error)) from error
        except OSError as error:
            path = error.filename or self._network.folder
            reason = (error.strerror or str(error)).lower()
            raise DeployFailed(deploying.FOLDER.at(Span(self._network.path), path=path, reason=reason)) from error


def _is_too_long(spec: Spec) -> bool:
    from robocomp_yaml.deploy.icegrid.descriptors import LONGEST_CONFIG, encoded

    config = spec.process.config
    return bool(config and not is_here(spec.address) and len(encoded(config.text).encode()) > LONGEST_CONFIG)


def _missing() -> str:
    """What the engine needs and this machine lacks, in words, or ''."""
    # What is compiled of Ice is found only by the Python that it was compiled for.
    if not all(map(importlib.util.find_spec, ("Ice", "IceGrid", "IcePy"))):
        return "Ice for Python is not installed (`pip install 'rcyaml[ice]'`, Debian: python3-zeroc-ice)"
    for program, package in (("icegridregistry", "zeroc-icegrid"), ("icegridnode", "zeroc-icegrid"),
                             ("openssl", "openssl"), ("setpriv", "util-linux")):  # fmt: skip
        if shutil.which(program) is None:
            return f"{program} is not installed (Debian: {package})"
    return ""


_WITHIN = 1.0  # seconds for an answer


async def taken(specs: Sequence[Spec], running: Mapping[str, Running]) -> list[Diagnostic]:
    """`specs` are to be started; what runs of the deployment itself is in nobody's way."""
    own = {
        (one.spec.address, endpoint.port)
        for one in running.values()
        if one.spec and one.state not in (STOPPED, ENDED, GIVEN_UP)
        for endpoint in one.spec.process.endpoints
    }
    asked = [
        (spec, endpoint)
        for spec in specs
        for endpoint in spec.process.endpoints
        if endpoint.port and endpoint.protocol != "udp" and (spec.address, endpoint.port) not in own
    ]
    answers = await asyncio.gather(*(listens(spec.address, endpoint.port, _WITHIN) for spec, endpoint in asked))
    return [
        deploying.PORT_TAKEN.at(
            endpoint.span if endpoint.span.file else spec.process.span,
            hint=f"`ss -ltnp` says there which; end it, or give '{spec.name}' another port",
            name=spec.name, port=endpoint.port, program=f"one on the host '{spec.process.host}'",
        )
        for (spec, endpoint), is_taken in zip(asked, answers, strict=True)
        if is_taken
    ]  # fmt: skip
