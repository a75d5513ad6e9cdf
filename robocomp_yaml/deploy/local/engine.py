"""The engine for one machine: a client of the deployment's supervisor."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import AsyncGenerator, Collection, Iterable, Iterator, Sequence
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import liveness, ownership, registered
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import HALTED, KILLED, STOP_WITHIN, DeployFailed, EngineHangs, Line, Running
from robocomp_yaml.deploy.local import client, procfs, record
from robocomp_yaml.deploy.local.channel import PROTOCOL
from robocomp_yaml.deploy.local.client import Client, RequestFailed, SupervisorGone
from robocomp_yaml.deploy.local.log_reader import LogReader, merged
from robocomp_yaml.deploy.local.obstacles import (
    CheckedSpecs,
    elsewhere,
    environment_of,
    obstacles,
    whole_environment_of,
)
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.network.network import PEM, Network


class LocalEngine:
    """See `deploy.engine.Engine`. What a `tied` engine starts is stopped when this process ends, for whatever
    reason."""

    name = "local"

    def __init__(self, *, tied: bool = False) -> None:
        self._is_tied = tied
        self.notes: list[Diagnostic] = []
        self._client: Client | None = None
        self._network = Network("", "", "")
        self._specs: dict[str, ProcessSpec] = {}
        self._observed: dict[str, tuple[dict[str, Any], ProcessSpec | None]] = {}
        self._cleared = CheckedSpecs()
        self._has_staged = False
        self._has_settled = False  # after the first observation, all stops are those of this command

    async def open(self, network: Network, *, create: bool) -> bool:
        ownership.require(network)
        self._network = network
        if record.continue_halted(network.folder):
            self.notes.append(deploying.NOT_SUPERVISED.at(Span(network.path), what=HALTED))
        try:
            connection = client.reach(network.folder) or (None if create else await client.revived(network.folder))
            was_killed = connection is None and record.was_killed(network.folder)
            if was_killed or (connection is None and create):
                left = [*record.clear_up(network.folder), *(client.last_words(network.folder) if was_killed else ())]
                if was_killed or left:
                    self.notes.append(
                        deploying.NOT_SUPERVISED.at(Span(network.path), what=KILLED, more="\n".join(left))
                    )
            if connection is None and create:
                record.remove(network.folder)
                if found := elsewhere(network):
                    raise DeployFailed(found)
                own_folder.make(network.folder)
                connection = await client.start(network.folder, tied=self._is_tied)
            if connection is None:
                return False
            self._client = await Client.over(connection)
            hello = await self._client.hello()
        except TimeoutError as error:
            await self._disconnect()
            raise self._hangs() from error
        except OSError as error:
            raise self._folder_failed(network.folder, reason_of(error)) from error
        except SupervisorGone as error:
            raise self._gone() from error
        if hello["protocol"] != PROTOCOL:
            raise self._folder_failed(network.folder, "another version of rcyaml started what runs there")
        if create:
            with contextlib.suppress(OSError):  # a full or read-only disk
                self._register(hello["pid"] if hello.get("restores") else 0)
        return True

    def _hangs(self) -> EngineHangs:
        pid = record.supervisor(self._network.folder)
        who = f"its supervisor{f' (pid {pid})' if pid else ''} does not answer"
        hint = "`rcyaml deploy down` ends it with all its processes"
        failed = self._folder_failed(self._network.folder, f"{who}: {hint}")
        return EngineHangs(failed.diagnostic, self._end_hung)

    async def _end_hung(self) -> list[str]:
        names = await asyncio.to_thread(record.end_hung, self._network.folder)
        self.notes.append(deploying.NOT_SUPERVISED.at(Span(self._network.path), what=KILLED))
        return names

    def _register(self, pid: int) -> None:
        found = procfs.entry(pid) if pid else None
        registered.keep(registered.entry_of(self._network, self.name, pid, found.start if found else 0))

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        answer = await self._ask("", "observe", settled=not (use or self._has_settled))
        self._has_settled = self._has_settled or not use
        found = [_running(entry, self._spec_of(entry["spec"])) for entry in answer["processes"]]
        return {running.name: running for running in found}

    def _spec_of(self, data: dict[str, Any]) -> ProcessSpec | None:
        """The spec in an answer, which is mostly that of the last answer."""
        name = data["process"]["name"]
        known = self._observed.get(name)
        if known is None or known[0] != data:
            known = self._observed[name] = data, ProcessSpec.of_data(data)
        return known[1]

    async def obstacles(self, specs: Sequence[ProcessSpec], leaving: Collection[str]) -> list[Diagnostic]:
        own: set[int] = set()
        if specs and (far := elsewhere(self._network)):
            down = typed("rcyaml", "deploy", "down", shown_path(self._network.path))
            keeps = f"it runs with the engine local: `{down}`, then `up` starts it with icegrid"
            return [replace(far, hint=keeps) if self._client else far]
        if self._client:
            for entry in (await self._ask("", "observe"))["processes"]:
                if entry["spec"]["process"]["name"] in leaving:
                    own.update(entry["members"])
        if not (found := obstacles(specs, own)):
            self._cleared.note(specs)
        return found

    async def stage(self, specs: Sequence[ProcessSpec]) -> None:
        self._has_staged = True
        with self._writing():
            own_folder.stage(
                self._network.folder, {path: text for spec in specs for path, text in spec.config_files.items()}
            )
            for path in (path for spec in specs for path in spec.process.folders):
                os.makedirs(path, mode=0o700, exist_ok=True)

    async def prepare(self, specs: Sequence[ProcessSpec]) -> None:
        with self._writing():
            for file, text in ((file, text) for spec in specs for file, text in spec.config_files.items()):
                own_folder.put(self._network.folder, file, text)
            for path in (path for spec in specs for path in spec.process.folders):
                os.makedirs(path, mode=0o700, exist_ok=True)
        self._specs.update({spec.name: spec for spec in specs})
        policies = {spec.name: spec.process.restart_policy for spec in specs}
        questions = {spec.name: asked for spec in specs if (asked := _question(spec))}
        await self._ask("", "prepare", specs=[spec.as_data() for spec in specs], policies=policies, questions=questions)

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise self._folder_failed(error.filename or self._network.folder, reason_of(error)) from error

    async def start(self, name: str) -> None:
        spec = self._specs[name]
        self._cleared.require(spec)
        await self._ask(name, "start", name=name, environment=environment_of(spec.process))

    async def stop(self, name: str, within: float = STOP_WITHIN) -> None:
        await self._ask(name, "stop", name=name, within=within)

    async def forget(self, names: Iterable[str]) -> None:
        gone = list(names)
        running = await self.observe()
        await self._ask("", "forget", names=gone)
        for spec in (running[name].spec for name in gone if name in running):
            for file in spec.config_files if spec else ():
                own_folder.remove(self._network.folder, file)

    async def lines(self, names: Sequence[str], last: int, follow: bool) -> AsyncGenerator[Line, None]:
        return merged([LogReader(self._network.folder, name) for name in names], last, follow)

    async def run(self, name: str, command: Sequence[str], within: float) -> int:
        from robocomp_yaml.deploy.local.kernel import death_with_this

        process = self._specs[name].process if name in self._specs else self._network.processes[name]
        try:
            started = await asyncio.create_subprocess_exec(
                *command, cwd=process.cwd or None, env=whole_environment_of(process), stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.DEVNULL, start_new_session=True,
                preexec_fn=death_with_this(),
            )  # fmt: skip
        except OSError:
            return 127
        try:
            return await asyncio.wait_for(started.wait(), within)
        except TimeoutError:
            return 124
        finally:
            if started.returncode is None:
                os.killpg(started.pid, signal.SIGKILL)
                await started.wait()

    async def close(self, *, end: bool = False) -> None:
        if self._has_staged:
            own_folder.drop_staged(self._network.folder)
        if self._client:
            if end:
                try:
                    await self._ask("", "end")
                    await self._client.wait_closed()
                except (EngineHangs, TimeoutError):
                    await self._end_hung()
                await client.wait_gone(self._network.folder)
            await self._disconnect()
        if end:
            registered.forget(self._network.folder)

    async def _disconnect(self) -> None:
        if self._client:
            await self._client.close()
            self._client = None

    async def _ask(self, about: str, do: str, **facts: object) -> dict[str, Any]:
        """An answer of the supervisor. An error is reported for the process of the name `about`, if there is one."""
        assert self._client, "open it first"
        try:
            return await self._client.ask(do, **facts)
        except TimeoutError as error:
            raise self._hangs() from error
        except RequestFailed as error:
            where = self._network.span_of(about)
            raise DeployFailed(deploying.CANNOT.at(where, name=about, what=_DONE.get(do, do), reason=error)) from error
        except SupervisorGone as error:
            raise self._gone() from error

    def _gone(self) -> DeployFailed:
        return DeployFailed(deploying.NOT_SUPERVISED.at(Span(self._network.path), what=KILLED).as_severity(ERROR))

    def _folder_failed(self, path: str, reason: str) -> DeployFailed:
        return DeployFailed(deploying.FOLDER.at(Span(self._network.path), path=shown_path(path), reason=reason.lower()))


def _question(spec: ProcessSpec) -> tuple[str | int, ...] | None:
    """What the supervisor asks a process: host, port and message; for TLS, also the file with the certificates, which a
    supervisor of an earlier version does not expect."""
    process = spec.process
    asked = liveness.question(process.alive, is_secured=process.is_secured)
    return (*asked, *([f"{spec.config_path}{PEM}"] if process.is_secured else [])) if asked else None


_DONE = {"start": "started", "stop": "stopped"}


def _running(entry: dict[str, Any], spec: ProcessSpec | None) -> Running:
    process = entry["spec"]["process"]
    kept = ("state", "pid", "uptime", "restarts", "last_exit", "memory", "cpu", "spread", "lost_lines", "not_alive")
    return Running(
        process["name"],
        spec,
        process["host"],
        **{key: entry[key] for key in kept if key in entry},
    )
