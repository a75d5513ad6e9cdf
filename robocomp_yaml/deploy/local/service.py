"""The supervisor's service: its children, and the requests of clients on the control socket.

A request is a line `{"id", "do", …}`. Its answer is a line `{"id", …}` with the result, or with `error`, the text of an
`errno`. Requests run in parallel, except those for the same child.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
from collections.abc import Awaitable
from typing import Any

from robocomp_yaml.deploy.local import channel, procfs, record
from robocomp_yaml.deploy.local.alive import AliveWatch, Question
from robocomp_yaml.deploy.local.channel import LONGEST, PROTOCOL, RESTORE
from robocomp_yaml.deploy.local.child import ChildProcess
from robocomp_yaml.deploy.local.kernel import OpenFiles
from robocomp_yaml.deploy.local.log_file import LIMIT, LogFile

_FACTS = ("spec", "state", "pid", "restarts", "last_exit", "spread", "lost_lines", "not_alive")

END_WITHIN = 5.0

Request = dict[str, Any]


def serve(folder: str) -> None:
    """Runs until a client or a signal ends it."""
    asyncio.run(_Service(folder).run())


class _Service:
    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.children: dict[str, ChildProcess] = {}
        self._watches: dict[str, asyncio.Task[None]] = {}
        self._files = OpenFiles()
        self._limit = int(os.environ.get("RCYAML_LOG_LIMIT") or LIMIT)
        self._over = asyncio.Event()
        self._servers: list[asyncio.Server] = []
        self._families = procfs.Families(
            lambda: {child.root: child.mark for child in self.children.values() if child.root}
        )

    async def run(self) -> None:
        self._files.raise_limit()
        loop = asyncio.get_running_loop()
        loop.add_signal_handler(signal.SIGCHLD, self._reap)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            loop.add_signal_handler(number, self._over.set)
        keeper = os.getppid()
        await self._listen(keeper)
        loop.add_signal_handler(RESTORE, lambda: asyncio.ensure_future(self._restore(keeper)))
        await self._over.wait()
        for server in self._servers:
            server.close()
        for name in list(self._watches):
            self._watch(name, None)
        left = dict(self.children)
        while left:  # first those that no other one needs
            needed = {name for child in left.values() for name in child.spec["process"]["after"]}
            free = [name for name in left if name not in needed] or list(left)
            stops = (self._stop(left.pop(name), END_WITHIN) for name in free)
            await asyncio.gather(*stops, return_exceptions=True)  # the keeper kills what does not end
        for child in self.children.values():
            child.log.close()
        if os.getppid() != keeper:  # the keeper was killed, and cannot remove the record
            record.remove(self.folder)

    async def _listen(self, keeper: int) -> None:
        record.write(self.folder, keeper)  # before the first client: if it fails, nothing was started
        self._servers.append(
            await asyncio.start_unix_server(
                self._serve_client, sock=channel.listen(f"{self.folder}/state"), limit=LONGEST
            )
        )

    async def _restore(self, keeper: int) -> None:
        """Makes the supervisor reachable again if its folder was deleted, and writes the logs again."""
        with contextlib.suppress(OSError):
            if os.path.lexists(f"{self.folder}/state/{channel.SOCKET}"):
                return
            for part in ("config", "logs", "state"):
                os.makedirs(f"{self.folder}/{part}", mode=0o700, exist_ok=True)
            os.chmod(self.folder, 0o700)
            for child in self.children.values():
                child.log.restore()
            await self._listen(keeper)

    def _reap(self) -> None:
        """Collects the exit codes of ended processes: children, and adopted orphans of them."""
        by_pid = {child.pid: child for child in self.children.values() if child.pid}
        while True:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if pid == 0:
                return
            if child := by_pid.get(pid):
                child.on_exit(status)

    async def _serve_client(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        tasks: set[asyncio.Task[None]] = set()
        try:
            if not channel.is_of_owner(writer.get_extra_info("socket")):
                return
            while line := await reader.readline():
                request = json.loads(line)
                work = getattr(self, f"do_{request['do']}")(request)
                task = asyncio.create_task(self._answer(request["id"], work, writer))
                tasks.add(task)
                task.add_done_callback(tasks.discard)
        except (ValueError, LookupError, TypeError, AttributeError, ConnectionError):
            pass  # not a client of rcyaml
        finally:
            # Requests are completed, even if the client has disconnected.
            await asyncio.gather(*tasks)
            writer.close()

    async def _answer(self, number: int, work: Awaitable[Request], writer: asyncio.StreamWriter) -> None:
        try:
            answer = await work
        except OSError as error:
            answer = {"error": (error.strerror or "it does not end, although it was killed").lower()}
        try:
            writer.write(json.dumps({"id": number, **answer}).encode() + b"\n")
            await writer.drain()
        except ConnectionError:
            pass

    async def do_hello(self, request: Request) -> Request:
        return {"protocol": PROTOCOL, "pid": os.getpid(), "restores": True}

    async def do_observe(self, request: Request) -> Request:
        """All processes; if `settled`, when no stop is pending, such as that of an interrupted command."""
        for child in [*self.children.values()] if request.get("settled") else ():
            async with child.lock:
                pass
        now, families = asyncio.get_running_loop().time(), self._families.now()
        found = []
        for child in self.children.values():
            members = families.get(child.pid, set())
            facts = {name: getattr(child, name) for name in _FACTS}
            is_asked = child.spec["process"]["name"] in self._watches
            if not is_asked and child.pid in members and self._families.alive[child.pid].is_halted:
                facts["not_alive"] = "it is halted"
            if child.is_stopping:
                facts["not_alive"] = "it is being stopped"
            cpu = sum(self._families.alive[pid].cpu for pid in members)
            used = {"memory": procfs.memory(members), "cpu": cpu, "members": sorted(members)}
            found.append({**facts, "uptime": now - child.since, **used})
        return {"processes": found}

    async def do_prepare(self, request: Request) -> Request:
        policies = request.get("policies", {})  # a client of an earlier version sends none
        for spec in request["specs"]:
            name = spec["process"]["name"]
            if name in self.children:
                self.children[name].spec = spec
            else:
                log = LogFile(f"{self.folder}/logs/{name}.log", self._limit)
                self.children[name] = ChildProcess(spec, f"{self.folder}:{name}", log, self._families, self._files)
            self.children[name].policy = policies.get(name, spec["process"]["restart"]["policy"])
            self._watch(name, request.get("questions", {}).get(name))
        return {}

    def _watch(self, name: str, question: list[Any] | None) -> None:
        """From now on, asks whether a process is alive. `question` is None if it is not asked."""
        if watch := self._watches.pop(name, None):
            watch.cancel()
        if not question and name in self.children:
            self.children[name].not_alive = ""
        if question:
            host, port, message, *pem = question
            asked = Question(host, port, bytes.fromhex(message), *pem)
            self._watches[name] = asyncio.create_task(AliveWatch(self.children[name], asked).run())

    async def do_start(self, request: Request) -> Request:
        child = self.children[request["name"]]
        async with child.lock:
            child.start(request["environment"])
        return {}

    async def do_stop(self, request: Request) -> Request:
        if child := self.children.get(request["name"]):
            await self._stop(child, request["within"])
        return {}

    async def _stop(self, child: ChildProcess, within: float) -> None:
        async with child.lock:
            await child.stop(within)

    async def do_forget(self, request: Request) -> Request:
        for name in request["names"]:
            self._watch(name, None)
            if child := self.children.pop(name, None):
                child.log.close()
        return {}

    async def do_end(self, request: Request) -> Request:
        self._over.set()
        return {}
