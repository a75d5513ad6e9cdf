"""What the processes of a network do now, again and again: what the system says (CPU, memory), what components say of
themselves, and rates, which are differences of two such answers.

A value that is unknown is None, never 0.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Callable, Collection, Mapping, Sequence
from contextlib import suppress
from typing import TypeVar

import msgspec

from robocomp_yaml.deploy import ice_call, introspection
from robocomp_yaml.deploy.engine import DeployFailed, Engine, Running
from robocomp_yaml.deploy.ice_call import PLAIN, SECURE
from robocomp_yaml.deploy.introspection import NoFacet, OwnState
from robocomp_yaml.deploy.ownership import NotOwn
from robocomp_yaml.deploy.states import RUNNING, fault, state_of
from robocomp_yaml.network.network import TOPIC, Network, Process
from robocomp_yaml.wire import introspection as wire
from robocomp_yaml.wire import protocol, tls
from robocomp_yaml.wire.introspection import Facts, Sections
from robocomp_yaml.wire.protocol import Connection, Reply

T = TypeVar("T")

NOT_STARTED, UNKNOWN = "not started", "unknown"
_SECTIONS = (wire.STATE, wire.WORKER, wire.CALLS, wire.TOPICS)
FIRST = 1.0  # seconds, at most, from the first sample to the second
_LONGEST = 1.0  # seconds that an answer may take
_MOMENT = 0.3


class WorkerUse(msgspec.Struct, frozen=True):
    """The turns of a worker: the desired and the achieved period in seconds, and how many turns it missed."""

    period: float | None
    achieved: float | None
    turns: int | None
    missed: int | None


class MethodUse(msgspec.Struct, frozen=True):
    """The calls of a method since the start of its component, with their mean and longest time in seconds. `failed` are
    those that raised an exception. `rate` are calls per second since the last sample."""

    method: str
    calls: int
    failed: int
    mean: float | None
    longest: float | None
    rate: float | None


class TopicUse(msgspec.Struct, frozen=True):
    """The messages of a topic since the start of its component. `direction` is `in` or `out`; `rate` are messages per
    second since the last sample."""

    topic: str
    direction: str
    messages: int
    rate: float | None


class ProcessSample(msgspec.Struct, frozen=True):
    """A process at a moment. `memory` are bytes, `cpu` is the part of a core that it used since the last sample, both
    with all its descendants. `is_component` is whether it describes itself; if it does and does not answer, the last
    three are None."""

    name: str
    host: str
    state: str
    is_fault: bool
    pid: int | None
    uptime: float | None
    restarts: int | None
    memory: int | None
    cpu: float | None
    is_component: bool
    worker: WorkerUse | None = None
    methods: tuple[MethodUse, ...] | None = None
    topics: tuple[TopicUse, ...] | None = None

    @property
    def calls(self) -> float | None:
        """Calls per second of all methods."""
        return _sum(self.methods, lambda one: one.rate)

    @property
    def slowest(self) -> MethodUse | None:
        """The method with the longest call so far."""
        timed = [one for one in self.methods or () if one.longest is not None]
        return max(timed, key=lambda one: one.longest or 0.0, default=None)

    @property
    def messages(self) -> float | None:
        """Messages per second of all topics."""
        return _sum(self.topics, lambda one: one.rate)


class NetworkSample(msgspec.Struct, frozen=True):
    """All processes. `problem` is why their states are unknown, else ''."""

    problem: str
    processes: tuple[ProcessSample, ...]


class _Reading(msgspec.Struct, frozen=True):
    """What is known of a process at a time of the monotonic clock. `uptime` is that of the component by its own
    clock."""

    clock: float
    running: Running | None
    sections: Sections | None

    @property
    def uptime(self) -> float | None:
        return _first(self.sections, wire.STATE).numbers.get("uptime")


def _sum(items: tuple[T, ...] | None, rate: Callable[[T], float | None]) -> float | None:
    rates = [rate(one) for one in items or ()]
    return None if items is None or None in rates else sum(one or 0.0 for one in rates)


async def samples(
    engine_of: Callable[[], Engine], network: Network, names: Collection[str], every: float
) -> AsyncGenerator[NetworkSample, None]:
    """A sample each so many seconds, for ever; without `names`, of all processes. The first one has no rates, and the
    second one follows after at most a second. If the engine does not answer, it is
    opened again each time, and components are still asked. Raises NotOwn."""
    session, asked, before = _Session(engine_of, network), _Asked(_SECTIONS), dict[str, _Reading]()
    pause = min(every, FIRST)
    try:
        while True:
            began = time.monotonic()
            running, problem = await session.observed()
            clock = time.monotonic()
            own = [one.name for one in network.enabled()]
            order = [*own, *(name for name in running if name not in own)]
            chosen = [name for name in order if not names or name in names]
            processes = {name: _process(network, running.get(name), name) for name in chosen}
            targets = _targets(processes, None if problem else running)
            told = await asked.sections(targets, min(_LONGEST, max(every, 0.2)))
            now = {name: _Reading(clock, running.get(name), told.get(name)) for name in chosen}
            found = (
                _sample(processes[name], name, now[name], before.get(name), asked.has_facet(targets.get(name)), problem)
                for name in chosen
            )
            yield NetworkSample(problem, tuple(found))
            before = now
            await asyncio.sleep(max(0.0, began + pause - time.monotonic()))
            pause = every
    finally:
        asked.close()
        await session.close()


def _process(network: Network, running: Running | None, name: str) -> Process | None:
    return running.spec.process if running and running.spec else network.processes.get(name)


def _targets(
    processes: Mapping[str, Process | None], running: Mapping[str, Running] | None
) -> dict[str, tuple[str, str]]:
    """Whom to ask: those that run and describe themselves. Without `running`, it is unknown which ones run."""
    return {
        name: (process.introspection, process.pem)
        for name, process in processes.items()
        if process and process.introspection
        and (running is None or (name in running and running[name].state == RUNNING))
    }  # fmt: skip


class _Session:
    """An engine that is opened again when it does not answer any more."""

    def __init__(self, engine_of: Callable[[], Engine], network: Network) -> None:
        self._engine_of, self._network = engine_of, network
        self._engine: Engine | None = None

    async def observed(self) -> tuple[dict[str, Running], str]:
        """The states, and why they are unknown."""
        if self._engine is not None:
            with suppress(DeployFailed):
                return await self._engine.observe(use=True), ""
            await self.close()
            await asyncio.sleep(_MOMENT)  # it may just be ending, because somebody takes the deployment down
        try:
            self._engine = self._engine_of()
            if await self._engine.open(self._network, create=False):
                return await self._engine.observe(use=True), ""
            notes = [note.message for note in self._engine.notes]
            await self.close()
            return {}, " ".join(notes)
        except NotOwn:
            raise  # nothing of it can be seen, however long one waits
        except DeployFailed as error:
            await self.close()
            return {}, error.diagnostic.message

    async def close(self) -> None:
        engine, self._engine = self._engine, None
        if engine is not None:
            with suppress(DeployFailed, OSError):
                await engine.close()


class _Asked:
    """The components, over connections that stay open: to open one for each answer would cost more than the answer."""

    def __init__(self, sections: Sequence[str]) -> None:
        self._sections = sections
        self._open: dict[str, Connection] = {}
        self._without: set[str] = set()

    def has_facet(self, target: tuple[str, str] | None) -> bool:
        return target is not None and target[0] not in self._without

    async def sections(self, targets: Mapping[str, tuple[str, str]], within: float) -> dict[str, Sections]:
        """What each component says, by name; without those that do not answer in time. A target is a proxy, and a key
        and certificates if it is over TLS."""
        proxies = {proxy for proxy, _ in targets.values()}
        for gone in self._open.keys() - proxies:
            self._open.pop(gone).close()
        self._without &= proxies
        answers = await asyncio.gather(*(self._report(*target, within) for target in targets.values()))
        return {name: answer for name, answer in zip(targets, answers, strict=True) if answer is not None}

    async def _report(self, proxy: str, pem: str, within: float) -> Sections | None:
        if proxy in self._without:
            return None
        try:
            address = ice_call.address_of(proxy, SECURE if pem else PLAIN)
            if address is None:
                return await introspection.report(proxy, self._sections, within, pem)
            return introspection.sections_in(await self._reply(proxy, *address, pem, within))
        except NoFacet:
            self._without.add(proxy)
            return None

    async def _reply(self, proxy: str, identity: str, host: str, port: int, pem: str, within: float) -> Reply | None:
        message = protocol.request(identity, wire.REPORT, wire.FACET, wire.names(self._sections))
        is_new = proxy not in self._open
        try:
            async with asyncio.timeout(within):
                while True:
                    if proxy not in self._open:
                        self._open[proxy] = await Connection.open(host, port, tls.of_text(pem) if pem else None)
                    try:
                        return await self._open[proxy].answer(message)
                    except ConnectionError:  # it was started again
                        self._open.pop(proxy).close()
                        if is_new:
                            return None
                        is_new = True
        except (OSError, ValueError):  # also at the end of the time: a late answer would be taken for the next one
            if proxy in self._open:
                self._open.pop(proxy).close()
        return None

    def close(self) -> None:
        for connection in self._open.values():
            connection.close()
        self._open.clear()


class PublishedTopics:
    """What publishers count of their topics, whoever listens."""

    def __init__(self) -> None:
        self._asked = _Asked((wire.STATE, wire.TOPICS))
        self._before: dict[str, _Reading] = {}

    async def rates(self, network: Network, running: Mapping[str, Running]) -> dict[str, float]:
        """The messages per second of each topic since the last call, of all its publishers that run and answer."""
        publishers = {one.source for one in network.connections if one.kind == TOPIC and one.is_out}
        processes = {name: _process(network, running.get(name), name) for name in publishers}
        targets = _targets(processes, running)
        told = await self._asked.sections(targets, _LONGEST)
        now = {name: _Reading(time.monotonic(), running.get(name), told.get(name)) for name in targets}
        found: dict[str, float] = {}
        for name, reading in now.items():
            _, topics = _uses(reading, self._before.get(name))
            for one in topics or ():
                if one.direction == "out" and one.rate is not None:
                    found[one.topic] = found.get(one.topic, 0.0) + one.rate
        self._before = now
        return {topic: round(rate, 1) for topic, rate in found.items()}

    def close(self) -> None:
        self._asked.close()


def _sample(
    process: Process | None, name: str, now: _Reading, before: _Reading | None, has_facet: bool, problem: str
) -> ProcessSample:
    running = now.running
    own = introspection.state_in(now.sections) if now.sections else None
    is_same = before is not None and _is_same_run(before.running, running)
    alive = running if running and running.pid else None
    is_server = process is not None and process.is_server
    return ProcessSample(
        name, running.host if running else process.host if process else "", _state(running, own, problem),
        bool(running and fault(running, is_server=is_server)),
        alive.pid if alive else None, alive.uptime if alive else None, running.restarts if running else None,
        alive.memory if alive else None, _cpu(now, before) if is_same else None,
        has_facet, _worker(now.sections), *_uses(now, before),
    )  # fmt: skip


def _is_same_run(before: Running | None, now: Running | None) -> bool:
    return before is not None and now is not None and 0 != before.pid == now.pid


def _state(running: Running | None, own: OwnState | None, problem: str) -> str:
    if running is None:
        return (own.words if own else UNKNOWN) if problem else NOT_STARTED
    state = state_of(running)
    if state == RUNNING:
        return f"not alive: {running.not_alive}" if running.not_alive else own.words if own else RUNNING
    return f"{state}: {running.last_exit}" if running.last_exit else state


def _cpu(now: _Reading, before: _Reading | None) -> float | None:
    """The part of a core that a process used between two readings; None if a descendant of it ended, and took its time
    along."""
    if not (before and before.running and now.running) or None in (before.running.cpu, now.running.cpu):
        return None
    used, over = (now.running.cpu or 0.0) - (before.running.cpu or 0.0), now.clock - before.clock
    return used / over if used >= 0 and over > 0 else None


def _first(sections: Sections | None, name: str) -> Facts:
    return next(iter((sections or {}).get(name, ())), Facts("", {}, {}))


def _worker(sections: Sections | None) -> WorkerUse | None:
    if sections is None or not sections.get(wire.WORKER):
        return None
    numbers = _first(sections, wire.WORKER).numbers
    turns, missed, achieved = numbers.get("turns"), numbers.get("missed"), numbers.get("achieved")
    if achieved is not None:  # a turn that does not end is not in the mean
        achieved = max(achieved, numbers.get("heartbeat", 0.0))
    return WorkerUse(
        numbers.get("period"), achieved, None if turns is None else int(turns),
        None if missed is None else int(missed),
    )  # fmt: skip


def _uses(now: _Reading, before: _Reading | None) -> tuple[tuple[MethodUse, ...] | None, tuple[TopicUse, ...] | None]:
    if now.sections is None:
        return None, None
    over = _between(now, before)
    earlier = before.sections if before and before.sections and over is not None else None
    methods = tuple(
        MethodUse(
            one.name, int(one.numbers.get("calls", 0)),
            int(one.numbers.get("exceptions", 0) + one.numbers.get("failures", 0)), one.numbers.get("mean"),
            one.numbers.get("longest"), _rate(one, wire.CALLS, "calls", earlier, over),
        )
        for one in now.sections.get(wire.CALLS, ())
    )  # fmt: skip
    topics = tuple(
        TopicUse(
            one.texts.get("topic", one.name), one.texts.get("direction", ""), int(one.numbers.get("events", 0)),
            _rate(one, wire.TOPICS, "events", earlier, over),
        )
        for one in now.sections.get(wire.TOPICS, ())
    )  # fmt: skip
    return methods, topics


def _between(now: _Reading, before: _Reading | None) -> float | None:
    """The seconds between two answers of a component, by its own clock; None if it was started again."""
    if before is None or now.uptime is None or before.uptime is None or now.uptime <= before.uptime:
        return None
    return now.uptime - before.uptime


def _rate(one: Facts, section: str, number: str, earlier: Sections | None, over: float | None) -> float | None:
    """How many were counted in a second. What was not there earlier has begun since."""
    if earlier is None or over is None:
        return None
    same = (
        each.numbers.get(number, 0.0) for each in earlier.get(section, ())
        if each.name == one.name and each.texts.get("direction") == one.texts.get("direction")
    )  # fmt: skip
    more = one.numbers.get(number, 0.0) - next(same, 0.0)
    return more / over if more >= 0 else None
