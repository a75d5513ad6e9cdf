"""Carrying out a plan: what stops, in reverse order; then what starts, each as soon as all it is after are ready."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import aclosing
from typing import Any

import msgspec

from robocomp_yaml.deploy.engine import LOST, RUNNING, STOPPED, WAITING, DeployFailed, Engine, Running
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan, PlanStep, in_order
from robocomp_yaml.deploy.readiness import RECENT, State, holds, until_ready, why_not
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic

STOPPING, GONE, STARTING, READY, FAILED, SKIPPED = "stopping", "stopped", "starting", "ready", "failed", "not started"


class ProcessEvent(msgspec.Struct, frozen=True):
    """Something happened to a process; `seconds` since it began to happen, `text` what to add."""

    name: str
    kind: str
    text: str = ""
    seconds: float = 0.0


class StartOutcome(msgspec.Struct):
    """`began` are the processes that were started, ready or not; `failed` why some are not ready; `skipped` are those
    that were not tried because of these, or because the time was over (`is_late`): then `late` are those of the failed
    that were still waited for."""

    began: list[str] = []
    failed: dict[str, Diagnostic] = {}
    skipped: list[str] = []
    is_late: bool = False
    late: list[str] = []


Report = Callable[[ProcessEvent], None]


class Watch:
    """What the engine sees, asked for by one at a time and no more often than needed, however many wait for it."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._seen: dict[str, Running] = {}
        self._when = -math.inf
        self._look: asyncio.Task[None] | None = None

    def of(self, name: str) -> State:
        async def look(since: float) -> Running | None:
            while self._when < since:
                if self._look is None or self._look.done():
                    self._look = asyncio.create_task(self._observe())
                await asyncio.shield(self._look)  # others wait for it too
            return self._seen.get(name)

        return look

    async def _observe(self) -> None:
        began = time.monotonic()
        self._seen = await self._engine.observe()
        self._when = began

    async def close(self) -> None:
        if self._look:
            await _cancel([self._look])


async def carry_out(
    engine: Engine, plan: Plan, report: Report, *, keep_going: bool, limit: TimeLimit | None = None,
    blocked: Mapping[str, Diagnostic] | None = None,
) -> StartOutcome:  # fmt: skip
    """Does what the plan says. Where a process that is started fails, nothing more is, or, with `keep_going`, only what
    depends on it is not; the latter holds also where one that ran already is not ready. When the time is over, nothing
    more is started, and what is not ready has failed. What is `blocked` is left as it is, and counts as failed."""
    blocked = blocked or {}
    leaving = [step.running for step in plan.of(STOP, RESTART) if step.running]
    leaving += [step.running for step in plan.of(START) if step.running and step.running.state in (RUNNING, WAITING)]
    await stop_all(engine, [running for running in leaving if running.name not in blocked], report)
    if gone := [step.name for step in plan.of(STOP)]:
        await engine.forget(gone)
    if specs := [step.spec for step in plan.of(START, RESTART, CHANGE) if step.spec and step.name not in blocked]:
        await engine.prepare(specs)
    return await _Starts(engine, Watch(engine), plan, report, keep_going, limit or TimeLimit(), blocked).run()


async def stop_all(engine: Engine, running: Iterable[Running], report: Report) -> None:
    """Stops processes, each after all that are after it. Raises DeployFailed when all that can stop have stopped."""
    leaving = {one.name: one for one in running if one.state not in (STOPPED, LOST)}
    after = {name: one.spec.process.after if one.spec else () for name, one in leaving.items()}
    tasks: dict[str, asyncio.Task[None]] = {}

    async def stop(name: str, users: list[asyncio.Task[None]]) -> None:
        if users:
            await asyncio.wait(users)
        began, is_reported = time.monotonic(), leaving[name].state in (RUNNING, WAITING)
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
    """The starts of one plan under way. `_since` has the start of the wait for each process that is pending."""

    _engine: Engine
    _watch: Watch
    _plan: Plan
    _report: Report
    _keep_going: bool
    _limit: TimeLimit
    _blocked: Mapping[str, Diagnostic]
    _outcome: StartOutcome = msgspec.field(default_factory=StartOutcome)
    _since: dict[str, float] = {}
    _tasks: dict[str, asyncio.Task[bool]] = {}

    async def run(self) -> StartOutcome:
        starting = {step.name for step in self._plan.of(START, RESTART)}
        order = in_order({step.name: _after(step) for step in self._plan.of(START, RESTART, CHANGE, KEEP)})
        try:
            for step in (self._plan.steps[name] for name in order):
                if step.name in starting:
                    # Those that close a cycle come later in the order, and are not waited for.
                    before = {name: self._tasks[name] for name in _after(step) if name in self._tasks}
                    self._tasks[step.name] = asyncio.create_task(self._start(step, before))
                else:  # it runs already: as a rule it answers at once
                    self._tasks[step.name] = asyncio.create_task(self._ends_ready(step, is_new=False))
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
                if self._outcome.failed.keys() & starting and not self._keep_going:
                    break
        finally:
            await _cancel(self._tasks.values())
        if self._outcome.is_late:
            self._outcome.late = [*self._since]
            for name in self._outcome.late:
                await self._is_late(self._plan.steps[name])
        await self._watch.close()
        tried = {*self._outcome.began, *self._outcome.failed}
        self._outcome.skipped = [step.name for step in self._plan.of(START, RESTART) if step.name not in tried]
        for name in self._outcome.skipped:
            self._report(ProcessEvent(name, SKIPPED))
        return self._outcome

    async def _start(self, step: PlanStep, before: Mapping[str, asyncio.Task[bool]]) -> bool:
        """Starts a process when all it is after are ready, or have failed where it can do without; whether it is ready
        then."""
        if step.name in self._blocked:
            self._since[step.name] = time.monotonic()
            self._fail(step.name, self._blocked[step.name])
            return False
        ready = await asyncio.gather(*(asyncio.shield(task) for task in before.values()))
        optional = step.spec.process.optional if step.spec else ()
        if not all(is_ready or name in optional for name, is_ready in zip(before, ready, strict=True)):
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
                if is_new or not (step.running and await holds(self._engine, step.spec, step.running)):
                    await until_ready(self._engine, step.spec, lines, self._watch.of(step.name))
        except DeployFailed as error:
            self._fail(step.name, error.diagnostic)
            return False
        took = self._took(step.name)
        if is_new:
            self._report(ProcessEvent(step.name, READY, seconds=took))
        return True

    async def _is_late(self, step: PlanStep) -> None:
        """It was still waited for when the time was over."""
        assert step.spec
        why = why_not(step.spec, await self._watch.of(step.name)(time.monotonic() - RECENT))
        where = step.spec.process.span
        self._fail(step.name, deploying.NOT_READY.at(where, name=step.name, within=self._limit, why=why))

    def _fail(self, name: str, found: Diagnostic) -> None:
        self._outcome.failed[name] = found
        self._report(ProcessEvent(name, FAILED, found.message, self._took(name)))

    def _took(self, name: str) -> float:
        """The seconds for which it was waited for, which is over."""
        return time.monotonic() - self._since.pop(name)


def _after(step: PlanStep) -> tuple[str, ...]:
    return step.spec.process.after if step.spec else ()


async def _cancel(tasks: Iterable[asyncio.Task[Any]]) -> None:
    rest = [task for task in tasks if not task.done()]
    for task in rest:
        task.cancel()
    await asyncio.gather(*rest, return_exceptions=True)


def undo(plan: Plan, before: Mapping[str, Running], now: Mapping[str, Running]) -> Plan:
    """The plan back to what ran before this plan was carried out, wholly or in part. What was not touched is not waited
    for either."""
    steps: dict[str, PlanStep] = {}
    for name, step in plan.steps.items():
        if step.action == KEEP:
            continue
        spec = before[name].spec if name in before and before[name].state in (RUNNING, WAITING) else None
        if spec is None:
            if name in now:
                steps[name] = PlanStep(name, STOP, "it did not run before", running=now[name])
        else:
            action = CHANGE if step.action == CHANGE else START
            steps[name] = PlanStep(name, action, "it ran before", spec=spec, running=now.get(name))
    return Plan(steps)
