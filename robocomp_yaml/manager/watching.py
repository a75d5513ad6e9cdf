"""Watches a deployment while the manager runs: its processes, and its documents.

The engine is observed often, which is one question for all processes. Whether each is ready is asked seldom, and at
once after a change. What is sent are differences.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import AsyncIterator, Collection, Mapping, Sequence
from contextlib import aclosing
from typing import Any

from robocomp_yaml.api.refusals import meant
from robocomp_yaml.deploy import json_data, operations
from robocomp_yaml.deploy.engine import DeployFailed, Engine, Running
from robocomp_yaml.deploy.engines import make_engine
from robocomp_yaml.deploy.log_filter import LogFilter, selected
from robocomp_yaml.deploy.operations import Status
from robocomp_yaml.deploy.sampling import PublishedTopics
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.manager.events import DOCUMENTS, STATES, Events, ServerEvent
from robocomp_yaml.manager.managed import ManagedDeployment
from robocomp_yaml.manager.requests import Unknown
from robocomp_yaml.manager.topics import TopicFeeds
from robocomp_yaml.network.network import Network

OBSERVE, ASK, AGAIN, COMMANDS, DISK, RATES = 0.4, 2.0, 6.0, 10.0, 1.0, 2.0
"""Seconds between two observations, between two questions whether all are ready, between two questions to a process
that was, between two runs of the command that says so, between two looks at the disk, and between two looks at what
publishers count."""


class Watcher:
    """Watches one deployment. `states` are those of its processes, as `deploy status --format json` has them."""

    def __init__(self, managed: ManagedDeployment) -> None:
        self.managed, self.events = managed, Events()
        self.topics = TopicFeeds(managed.topics)
        self._sent_rates: Mapping[str, Any] = {}
        self._published: Mapping[str, float] = {}
        self.states: dict[str, dict[str, Any]] = {}
        self.problem = ""
        self._network: Network | None = None
        self._engine: Engine | None = None
        self._engine_name = ""
        self._running: Mapping[str, Running] = {}
        self._asked, self._seen = 0.0, dict[str, tuple[object, ...]]()
        self._ready: dict[str, tuple[tuple[object, ...], float, Status]] = {}  # at the last question, and when it was
        self._measured: dict[str, tuple[int, float, float]] = {}  # process id, seconds of CPU, and when

    async def begin(self) -> None:
        """Reads the documents, and the first states."""
        await self._read()
        self.managed.changes()
        await self._look()

    async def run(self) -> None:
        """Watches until it is cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._watch_processes())
            tasks.create_task(self._watch_documents())
            tasks.create_task(self._watch_topics())

    @property
    def rates(self) -> dict[str, dict[str, float]]:
        """Messages per second of topics: what their publishers count, or what listeners of this manager get."""
        return {**{topic: {"rate": rate} for topic, rate in self._published.items()}, **self.topics.rates}

    @property
    def first(self) -> list[ServerEvent]:
        """What a new listener gets before all further events."""
        processes = list(self.states.values())
        return [ServerEvent(STATES, {
            "all": True, "processes": processes, "problem": self.problem, "topics": self.rates,
        })]  # fmt: skip

    def chosen(self, names: Sequence[str]) -> list[str]:
        """The processes that these names and groups mean, all without names. Raises Unknown if one is."""
        network = self._network
        processes = network.processes if network is not None else {}
        found: list[str] = []
        for name in names:
            members = [one.name for one in processes.values() if name in (one.name, *one.aliases, *one.groups)]
            if not members:
                raise Unknown(f"there is no process or group '{name}'{meant(name, processes)}")
            found += members
        return found or [one.name for one in processes.values() if one.enabled]

    async def log_lines(self, names: Sequence[str], last: int) -> AsyncIterator[dict[str, str]]:
        """The last lines of the logs of these processes, and all that follow, until the engine ends."""
        if self._network is None:
            return
        engine = make_engine(self._engine_name, self._network)
        with contextlib.suppress(DeployFailed, OSError):
            await engine.open(self._network, create=False)
            try:
                async with aclosing(selected(engine, names, last, True, LogFilter())) as lines:
                    async for line in lines:
                        yield json_data.line_data(line)
            finally:
                await engine.close()

    async def _watch_documents(self) -> None:
        while True:
            await asyncio.sleep(DISK)
            if changed := self.managed.changes():
                for path in (path for path, is_elsewhere in changed.items() if is_elsewhere):
                    self.events.happened("", f"{os.path.relpath(path)} was changed elsewhere")
                await self._read()
                self.events.send(DOCUMENTS, {"problem": self.problem})

    async def _read(self) -> None:
        problem = ""
        try:
            network, name = await asyncio.to_thread(self.managed.network)
        except (Faulty, Refused) as error:
            problem = str(error)
        else:
            if self._network is not None and (name != self._engine_name or network.folder != self._network.folder):
                await self._leave()
            self._network, self._engine_name = network, name
        self.problem, self._asked, self._ready = problem, 0.0, {}

    async def _watch_processes(self) -> None:
        while True:
            await asyncio.sleep(OBSERVE)
            await self._look()
            if self.rates != self._sent_rates:
                self._send()

    async def _watch_topics(self) -> None:
        """While somebody looks."""
        counts = PublishedTopics()
        try:
            while True:
                await asyncio.sleep(RATES)
                if self._network is not None and self.events.has_listeners:
                    self._published = await counts.rates(self._network, self._running)
        finally:
            counts.close()

    def _send(self, changed: Sequence[dict[str, Any]] = (), gone: Sequence[str] = ()) -> None:
        self._sent_rates = self.rates
        self.events.send(STATES, {
            "all": False, "processes": changed, "gone": gone, "problem": self.problem, "topics": self._sent_rates,
        })  # fmt: skip

    async def _look(self) -> None:
        network, now = self._network, asyncio.get_running_loop().time()
        if network is None:
            return
        try:
            running = self._running = await self._observe(network)
            seen = {name: _gist(one) for name, one in running.items()}
            if seen != self._seen or now - self._asked > ASK:
                self._asked, self._seen = now, seen
                await self._ask(network)
        except (DeployFailed, OSError) as error:
            self._note(f"the state of the processes is unknown: {error}")
            await self._leave()

    async def _observe(self, network: Network) -> Mapping[str, Running]:
        if self._engine is None:
            engine = make_engine(self._engine_name, network)
            if not await engine.open(network, create=False):
                await engine.close()
                return {}
            self._engine = engine
        try:
            return await self._engine.observe()
        except DeployFailed:
            await self._leave()  # what supervised them ended
            return {}

    async def _ask(self, network: Network) -> None:
        """Asks which processes are ready, and sends what differs."""
        known = self._known(network)
        if self._engine is None:
            found = [Status(one.name, one.host, False, None, one.is_server) for one in network.enabled()]
        else:
            found = await operations.status(self._engine, network, (), True, known)
        states = {one["name"]: one for one in json_data.status_data(network, found)}
        words = {one.name: json_data.state_in_words(one) for one in found}
        down = {one.name: one.is_down for one in found}
        for name, state in states.items():
            state["words"], state["down"] = words[name], down[name]
            state["load"] = self._load(state)
        changed = [one for name, one in states.items() if _lasting(one) != _lasting(self.states.get(name, {}))]
        self._keep(found, known)
        gone = [name for name in self.states if name not in states]
        for one in changed:
            was = self.states.get(one["name"])
            if was is not None and one["restarts"] > was["restarts"]:
                self.events.happened(one["name"], f"ended by itself: {one['last_exit']}; started again")
            if was is not None and was["words"] != one["words"]:
                self.events.happened(one["name"], one["words"])
            elif (
                was is not None
                and was["pid"]
                and one["pid"] not in (0, was["pid"])
                and one["restarts"] <= was["restarts"]
            ):
                self.events.happened(one["name"], f"restarted, {one['words']}")
        order = {one.name: at for at, one in enumerate(network.enabled())}
        self.states = dict(sorted(states.items(), key=lambda one: order.get(one[0], len(order))))
        if changed or gone:
            self._send(changed, gone)

    def _known(self, network: Network) -> dict[str, Status]:
        """The processes that were ready not long ago, and to which nothing happened since: asking all of them each
        time would cost more than everything else here."""
        now = asyncio.get_running_loop().time()
        return {
            name: status for name, (gist, when, status) in self._ready.items()
            if (process := network.processes.get(name)) is not None and self._seen.get(name) == gist
            and now - when < (COMMANDS if process.ready.command else AGAIN)
        }  # fmt: skip

    def _keep(self, found: Sequence[Status], known: Collection[str]) -> None:
        before, now = self._ready, asyncio.get_running_loop().time()
        self._ready = {
            one.name: (self._seen[one.name], before[one.name][1] if one.name in known else now, one)
            for one in found if one.is_ready and one.name in self._seen
        }  # fmt: skip

    def _load(self, state: Mapping[str, Any]) -> float | None:
        """The percentage of a core that a process used since the last question; None for the first one, and where its
        use of the CPU is not known."""
        name, pid, cpu, now = state["name"], state["pid"], state["cpu"], asyncio.get_running_loop().time()
        if not pid or cpu is None:
            self._measured.pop(name, None)
            return None
        before = self._measured.get(name)
        if before is not None and before[0] == pid and now - before[2] < ASK / 2:
            return self.states.get(name, {}).get("load")  # too short to say anything
        self._measured[name] = pid, cpu, now
        return round(max(100 * (cpu - before[1]) / (now - before[2]), 0)) if before and before[0] == pid else None

    def _note(self, problem: str) -> None:
        if problem != self.problem:
            self.problem = problem
            self._send()

    async def _leave(self) -> None:
        engine, self._engine = self._engine, None
        if engine is not None:
            with contextlib.suppress(DeployFailed, OSError):
                await engine.close()


def _lasting(state: Mapping[str, Any]) -> dict[str, Any]:
    """What of a state does not change by itself."""
    return {key: value for key, value in state.items() if key != "uptime"}


def _gist(one: Running) -> tuple[object, ...]:
    """What of a process changes only if something happens to it."""
    return one.state, one.pid, one.restarts, one.last_exit, one.not_alive
