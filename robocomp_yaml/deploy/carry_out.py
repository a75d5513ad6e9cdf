"""A plan is carried out: first processes stop, in reverse order; then each process starts when all that it is after are
ready."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import aclosing
from typing import Any

import msgspec

from robocomp_yaml.deploy.engine import LOST, STOPPED, DeployFailed, Engine, Running
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan, PlanStep, in_order
from robocomp_yaml.deploy.readiness import RECENT, State, holds, until_ready, why_not
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic

STOPPING, GONE, STARTING, READY, FAILED, SKIPPED = "stopping", "stopped", "starting", "ready", "failed", "not started"


class ProcessEvent(msgspec.Struct, frozen=True):
    """An event of one process. `seconds` is how long it took, `text` has details."""

    name: str
    kind: str
    text: str = ""
    seconds: float = 0.0


class StartOutcome(msgspec.Struct):
    """What came of the starts. `began` are the processes that were started, ready or not. `failed` has the reason for
    each that is not ready. `skipped` were not started, because others failed or the time limit expired (`is_late`);
    in the latter case, `late` are the failed ones that were still pending."""

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
    changed, and counts as failed. Raises DeployFailed if a process cannot be stopped or prepared."""
    blocked = blocked or {}
    leaving = [step.running for step in plan.of(STOP, RESTART) if step.running]
    leaving += [step.running for step in plan.of(START) if step.running and step.running.is_alive]
    await stop_all(engine, [running for running in leaving if running.name not in blocked], report)
    if gone := [step.name for step in plan.of(STOP)]:
        await engine.forget(gone)
    if specs := [step.spec for step in plan.of(START, RESTART, CHANGE) if step.spec and step.name not in blocked]:
        await engine.prepare(specs)
    return await _Starts(engine, Watch(engine), plan, report, keep_going, limit or TimeLimit(), blocked).run()


async def stop_all(engine: Engine, running: Iterable[Running], report: Report) -> None:
    """Stops processes, each when all that are after it have stopped. Raises DeployFailed if one cannot be stopped, when
    all others have stopped."""
    leaving = {one.name: one for one in running if one.state not in (STOPPED, LOST)}
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
    """The starts of one plan. `_since` has the time at which the wait for each pending process began."""

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
                    # A process that closes a circle comes later in the order: this one does not wait for it.
                    before = {name: self._tasks[name] for name in _after(step) if name in self._tasks}
                    self._tasks[step.name] = asyncio.create_task(self._start(step, before))
                else:  # it already runs, and is usually ready
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
                await self._report_late(self._plan.steps[name])
        await self._watch.close()
        tried = {*self._outcome.began, *self._outcome.failed}
        self._outcome.skipped = [step.name for step in self._plan.of(START, RESTART) if step.name not in tried]
        for name in self._outcome.skipped:
            self._report(ProcessEvent(name, SKIPPED))
        return self._outcome

    async def _start(self, step: PlanStep, before: Mapping[str, asyncio.Task[bool]]) -> bool:
        """Starts a process when all that it is after are ready, or are optional and have failed. Returns whether it
        became ready."""
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

    async def _report_late(self, step: PlanStep) -> None:
        """Reports a process that was pending when the time limit expired."""
        assert step.spec
        why = await why_not(step.spec, await self._watch.of(step.name)(time.monotonic() - RECENT))
        where = step.spec.process.span
        self._fail(step.name, deploying.NOT_READY.at(where, name=step.name, within=self._limit, why=why))

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


def undo(plan: Plan, before: Mapping[str, Running], now: Mapping[str, Running]) -> Plan:
    """The plan that restores what ran before this plan was carried out, also if only partly. Unchanged processes are
    not in it, so that it does not wait for them."""
    steps: dict[str, PlanStep] = {}
    for name, step in plan.steps.items():
        if step.action == KEEP:
            continue
        spec = before[name].spec if name in before and before[name].is_alive else None
        if spec is None:
            if name in now:
                steps[name] = PlanStep(name, STOP, "it did not run before", running=now[name])
        else:
            action = CHANGE if step.action == CHANGE else START
            steps[name] = PlanStep(name, action, "it ran before", spec=spec, running=now.get(name))
    return Plan(steps)
