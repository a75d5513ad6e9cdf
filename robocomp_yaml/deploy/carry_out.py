"""A plan is carried out: first what is no longer desired stops; then each process starts when all that it is after are
ready. Processes that restart do so one level of the order at a time."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import aclosing
from typing import Any

import msgspec

from robocomp_yaml.deploy.circles import Circles, circles_in
from robocomp_yaml.deploy.engine import DeployFailed, Engine, Running
from robocomp_yaml.deploy.levels import in_the_way, levels
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan, PlanStep, in_order
from robocomp_yaml.deploy.readiness import RECENT, State, holds, unready, until_it_serves, until_ready
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ALIVE, RUNNING, SILENT, fault, is_done
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic

LASTING = 0.5
"""Seconds that a process which became ready must have run before an operation reports success."""

_AGAIN = 0.1  # seconds between two checks whether a process lasts
_TICK = 0.05  # seconds: these checks are made at multiples of it, so that one observation serves many processes

STOPPING, GONE, STARTING, READY, FAILED, SKIPPED = "stopping", "stopped", "starting", "ready", "failed", "not started"
UNCHANGED = "not restarted"


class ProcessEvent(msgspec.Struct, frozen=True):
    """An event of one process. `seconds` is how long it took, `text` has details."""

    name: str
    kind: str
    text: str = ""
    seconds: float = 0.0


class StartOutcome(msgspec.Struct):
    """What came of the starts. `began` are the processes that were started, ready or not. `failed` has the reason for
    each that is not ready. `skipped` were not started or not restarted, because others failed or the
    time limit expired (`is_late`); in the latter case, `late` are the failed ones that were still pending."""

    began: list[str] = []
    failed: dict[str, Diagnostic] = {}
    skipped: list[str] = []
    is_late: bool = False
    late: list[str] = []


Report = Callable[[ProcessEvent], None]


class Watch:
    """The engine's observations for any number of waiting tasks: one observation at a time serves all of them."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._observed: dict[str, Running] = {}
        self._when = -math.inf  # the time before the last observation
        self._task: asyncio.Task[None] | None = None

    def of(self, name: str) -> State:
        async def state(since: float) -> Running | None:
            while self._when < since:
                if self._task is None or self._task.done():
                    self._task = asyncio.create_task(self._observe())
                await asyncio.shield(self._task)  # other tasks wait for it, too
            return self._observed.get(name)

        return state

    async def _observe(self) -> None:
        began = time.monotonic()
        self._observed = await self._engine.observe()
        self._when = began

    async def close(self) -> None:
        if self._task:
            await _cancel([self._task])


async def carry_out(
    engine: Engine, plan: Plan, report: Report, *, keep_going: bool, limit: TimeLimit | None = None,
    blocked: Mapping[str, Diagnostic] | None = None,
) -> StartOutcome:  # fmt: skip
    """Carries out a plan. When a process fails to start, no further process is started; with `keep_going`, only those
    that depend on it are skipped. These are skipped also when a process that ran before is not ready. When the time
    limit expires, nothing more is started, and every process that is not ready has failed. A `blocked` process is not
    changed, and counts as failed. Raises DeployFailed if a process cannot be stopped or prepared, and if not all
    configurations can be written: then nothing was changed."""
    blocked = blocked or {}
    early = in_the_way(plan)
    turns = levels(plan, {*early, *blocked})
    if specs := [step.spec for step in plan.of(START, RESTART, CHANGE) if step.spec and step.name not in blocked]:
        await engine.stage(specs)
    leaving = [step.running for step in plan.of(STOP, RESTART) if step.action == STOP or step.name in early]
    leaving += [step.running for step in plan.of(START) if step.running and step.running.is_alive]
    await stop_all(engine, [running for running in leaving if running and running.name not in blocked], report)
    if gone := [step.name for step in plan.of(STOP)]:
        await engine.forget(gone)
    later = {step.name for steps in turns for step in steps}
    if now := [spec for spec in specs if spec.name not in later]:
        await engine.prepare(now)
    return await _Starts(engine, Watch(engine), plan, report, keep_going, limit or TimeLimit(), blocked, turns).run()


async def stop_all(engine: Engine, running: Iterable[Running], report: Report) -> None:
    """Stops processes, each when all that are after it have stopped. Raises DeployFailed if one cannot be stopped, when
    all others have stopped."""
    leaving = {one.name: one for one in running if one.state not in SILENT}
    after = {name: one.spec.process.after if one.spec else () for name, one in leaving.items()}
    tasks: dict[str, asyncio.Task[None]] = {}

    async def stop(name: str, users: list[asyncio.Task[None]]) -> None:
        if users:
            await asyncio.wait(users)
        began, is_reported = time.monotonic(), leaving[name].is_alive
        if is_reported:
            report(ProcessEvent(name, STOPPING))
        await engine.stop(name)
        if is_reported:
            report(ProcessEvent(name, GONE, seconds=time.monotonic() - began))

    for name in reversed(in_order(after)):
        users = [task for user, task in tasks.items() if name in after[user]]
        tasks[name] = asyncio.create_task(stop(name, users))
    for result in await asyncio.gather(*tasks.values(), return_exceptions=True):
        if isinstance(result, BaseException):
            raise result


class _Starts(msgspec.Struct):
    """The starts of one plan. `_levels` are the steps whose old process still runs. `_before` has for each process the
    ones that it waits for, and `_since` the time at which the wait for each pending process began. `_serving` ends with
    whether a process that starts first in a circle serves."""

    _engine: Engine
    _watch: Watch
    _plan: Plan
    _report: Report
    _keep_going: bool
    _limit: TimeLimit
    _blocked: Mapping[str, Diagnostic]
    _levels: list[list[PlanStep]]
    _outcome: StartOutcome = msgspec.field(default_factory=StartOutcome)
    _since: dict[str, float] = {}
    _tasks: dict[str, asyncio.Task[bool]] = {}
    _turns: dict[str, asyncio.Task[set[str]]] = {}
    _before: dict[str, list[str]] = {}
    _circles: Circles = msgspec.field(default_factory=Circles)
    _serving: dict[str, asyncio.Task[bool]] = {}
    _stopped: set[str] = set()

    async def run(self) -> StartOutcome:
        starting = {step.name for step in self._plan.of(START, RESTART)}
        order = in_order({step.name: _after(step) for step in self._plan.of(START, RESTART, CHANGE, KEEP)})
        self._circles = circles_in(self._plan)
        for steps in self._levels:
            turn = asyncio.create_task(self._turn(steps))
            self._turns |= {step.name: turn for step in steps}
        try:
            for step in (self._plan.steps[name] for name in order):
                # A process that closes a circle comes later in the order: this one does not wait for it.
                self._before[step.name] = [name for name in _after(step) if name in self._tasks]
                if step.name in starting:
                    self._tasks[step.name] = asyncio.create_task(self._start(step))
                else:  # it already runs, and is usually ready
                    self._tasks[step.name] = asyncio.create_task(self._ends_ready(step, is_new=False))
                if step.name in self._circles.awaited:
                    self._serving[step.name] = asyncio.create_task(self._serves(step, step.name in starting))
            pending = set(self._tasks.values())
            while pending:
                if self._limit.is_over:
                    self._outcome.is_late = True
                    break
                done, pending = await asyncio.wait(
                    pending, timeout=self._limit.left, return_when=asyncio.FIRST_COMPLETED
                )
                for task in done:
                    if not task.cancelled():
                        task.result()
                if self._is_over():
                    break
            if not pending:
                every = self._plan.of(START, RESTART, CHANGE, KEEP)
                ready = [step for step in every if self._tasks[step.name].result()]
                await asyncio.gather(*(self._lasts(step, step.name in starting) for step in ready))
        finally:
            await _cancel([*self._serving.values(), *self._tasks.values()])
            await _cancel([turn for name, turn in self._turns.items() if name not in self._stopped])
            await asyncio.gather(*self._turns.values(), return_exceptions=True)  # a stop that has begun goes on
        if self._outcome.is_late:
            self._outcome.late = [*self._since]
            for name in self._outcome.late:
                await self._report_late(self._plan.steps[name])
        await self._watch.close()
        tried = {*self._outcome.began, *self._outcome.failed}
        self._outcome.skipped = [step.name for step in self._plan.of(START, RESTART) if step.name not in tried]
        for name in self._outcome.skipped:
            goes_on = name in self._turns and name not in self._stopped
            self._report(ProcessEvent(name, UNCHANGED if goes_on else SKIPPED))
        return self._outcome

    async def _turn(self, steps: list[PlanStep]) -> set[str]:
        """Stops and prepares one level of restarts, when all earlier levels are ready. A process that is after one
        which failed goes on as it was. Returns the names of those that stopped."""
        await asyncio.sleep(0)  # until all tasks are there
        here = {step.name for step in steps}
        earlier = {self._tasks[step.name] for level in self._levels[: self._levels.index(steps)] for step in level}
        if tasks := earlier.union(*(self._waits_for(step, here).values() for step in steps)):
            await asyncio.wait(tasks)
        if self._is_over():
            return set()
        of = self._circles.of
        stay = {of.get(step.name, step.name) for step in steps if not self._may_start(step, here)}
        going = [step for step in steps if of.get(step.name, step.name) not in stay]
        self._stopped.update(step.name for step in going)
        await stop_all(self._engine, [step.running for step in going if step.running], self._report)
        if going:
            await self._engine.prepare([step.spec for step in going if step.spec])
        return {step.name for step in going}

    def _is_over(self) -> bool:
        """Whether nothing more is started, because a process failed to start."""
        started = (self._plan.steps[name].action in (START, RESTART) for name in self._outcome.failed)
        return not self._keep_going and any(started)

    def _waits_for(self, step: PlanStep, ignored: Collection[str] = ()) -> dict[str, asyncio.Task[bool]]:
        """What a process waits for before it starts, by the name of the other process: that this one is ready; that it
        serves, if it waits for this process itself."""
        return {
            name: self._serving[name] if self._circles.need_not_be_ready(name, step.name) else self._tasks[name]
            for name in self._before[step.name]
            if name not in ignored
        }

    async def _serves(self, step: PlanStep, is_new: bool) -> bool:
        """Whether a process that starts first in a circle comes to serve in time, ready or not."""
        assert step.spec
        whole = self._tasks[step.name]
        while is_new and step.name not in self._outcome.began and not whole.done():
            await asyncio.sleep(_AGAIN)
        serves = asyncio.create_task(until_it_serves(step.spec))
        try:
            within = step.spec.process.ready.within
            await asyncio.wait((whole, serves), timeout=within, return_when=asyncio.FIRST_COMPLETED)
            return whole.result() if whole.done() else serves.done()
        finally:
            serves.cancel()

    def _may_start(self, step: PlanStep, ignored: Collection[str] = ()) -> bool:
        """Whether all that the process waited for are ready, or optional."""
        optional = step.spec.process.optional if step.spec else ()
        return all(task.result() or name in optional for name, task in self._waits_for(step, ignored).items())

    async def _start(self, step: PlanStep) -> bool:
        """Starts a process when all that it is after are ready, or are optional and have failed. Returns whether it
        became ready."""
        if step.name in self._blocked:
            self._since[step.name] = time.monotonic()
            self._fail(step.name, self._blocked[step.name])
            return False
        if before := self._waits_for(step):
            await asyncio.wait(before.values())
        if not self._may_start(step):
            return False
        if step.name in self._turns and step.name not in await asyncio.shield(self._turns[step.name]):
            return False
        self._report(ProcessEvent(step.name, STARTING))
        return await self._ends_ready(step, is_new=True)

    async def _ends_ready(self, step: PlanStep, *, is_new: bool) -> bool:
        assert step.spec
        self._since[step.name] = time.monotonic()
        try:
            logs = [step.name] if step.spec.process.ready.log else []
            async with aclosing(await self._engine.lines(logs, 0, True)) as lines:
                if is_new:
                    self._outcome.began.append(step.name)
                    await self._engine.start(step.name)
                if is_new or not (step.running and await self._is_ready(step.spec, step.running)):
                    others = [self._tasks[one] for one in self._circles.awaited.get(step.name, ())]
                    state, restarts = self._watch.of(step.name), self._restarts_before(step)
                    await until_ready(self._engine, step.spec, lines, state, others, restarts)
        except DeployFailed as error:
            self._fail(step.name, error.diagnostic)
            return False
        took = self._took(step.name)
        if is_new:
            self._report(ProcessEvent(step.name, READY, seconds=took))
        return True

    async def _is_ready(self, spec: ProcessSpec, running: Running) -> bool:
        return is_done(running, is_server=spec.process.is_server) or await holds(self._engine, spec, running)

    async def _lasts(self, step: PlanStep, is_new: bool) -> None:
        """Waits until a ready process has run for a moment, so that one that ends right after its start is no success.
        A process that ended in the meantime must become ready again, and no process may end again and again."""
        assert step.spec
        is_server = step.spec.process.is_server
        began, left = time.monotonic(), self._limit.left
        end = began + (step.spec.process.ready.within if left is None else min(step.spec.process.ready.within, left))
        running, pid, since = None if is_new else step.running, 0, began
        while True:
            running = running or await self._watch.of(step.name)(time.monotonic())
            why = fault(running, is_server=is_server) if running else "it was stopped in the meantime"
            if running and running.pid != pid:
                pid, since = running.pid, time.monotonic()
            # Its uptime is unknown if it runs on another host with a wrong clock.
            lasted = running is not None and max(running.uptime, time.monotonic() - since) >= LASTING
            if running and not why and (running.state != RUNNING or lasted):
                if not (is_new and running.restarts) or await self._is_ready(step.spec, running):
                    return
            if time.monotonic() > end or (running and running.state not in ALIVE):
                break
            pause = _AGAIN if why or running is None else max(LASTING - running.uptime, _AGAIN)
            await asyncio.sleep(-(time.monotonic() + pause) % _TICK + pause)
            running = None
        self._since.setdefault(step.name, time.monotonic())
        if running is None or running.state not in ALIVE:
            where, how = step.spec.process.span, running.end if running else why
            self._fail(step.name, deploying.ENDED_EARLY.at(where, name=step.name, how=how, hint=""))
        else:
            within = f"{step.spec.process.ready.within:g}"
            self._fail(step.name, await unready(step.spec, running, within, self._restarts_before(step)))

    async def _report_late(self, step: PlanStep) -> None:
        """Reports a process that was pending when the time limit expired."""
        assert step.spec
        running = await self._watch.of(step.name)(time.monotonic() - RECENT)
        self._fail(step.name, await unready(step.spec, running, self._limit, self._restarts_before(step)))

    def _restarts_before(self, step: PlanStep) -> int:
        """The restarts of a process that goes on, before its wait began. A start counts anew."""
        return step.running.restarts if step.running and step.name not in self._outcome.began else 0

    def _fail(self, name: str, reason: Diagnostic) -> None:
        self._outcome.failed[name] = reason
        self._report(ProcessEvent(name, FAILED, reason.message, self._took(name)))

    def _took(self, name: str) -> float:
        """Ends the wait for a process; the seconds that it took."""
        return time.monotonic() - self._since.pop(name)


def _after(step: PlanStep) -> tuple[str, ...]:
    return step.spec.process.after if step.spec else ()


async def _cancel(tasks: Iterable[asyncio.Task[Any]]) -> None:
    rest = [task for task in tasks if not task.done()]
    for task in rest:
        task.cancel()
    await asyncio.gather(*rest, return_exceptions=True)


def _is_same(before: Running, now: Running | None) -> bool:
    """Whether a process has not been restarted."""
    return now is not None and (before.pid, before.spec, before.state) == (now.pid, now.spec, now.state)


def undo(plan: Plan, before: Mapping[str, Running], now: Mapping[str, Running]) -> Plan:
    """The plan that restores what ran before this plan was carried out, also if only partly. Unchanged processes are
    not in it, so that it does not wait for them."""
    steps: dict[str, PlanStep] = {}
    for name, step in plan.steps.items():
        spec = before[name].spec if name in before and before[name].is_alive else None
        if step.action == KEEP or (step.action == RESTART and _is_same(before[name], now.get(name))):
            continue
        if spec is None:
            if name in now:
                steps[name] = PlanStep(name, STOP, "it did not run before", running=now[name])
        else:
            action = CHANGE if step.action == CHANGE else START
            steps[name] = PlanStep(name, action, "it ran before", spec=spec, running=now.get(name))
    return Plan(steps)
