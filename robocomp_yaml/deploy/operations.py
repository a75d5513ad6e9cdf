"""Operations on a whole deployment, with any engine: bring it up, report its status, take it down."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Collection, Iterable, Mapping
from contextlib import aclosing
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy import remains
from robocomp_yaml.deploy.carry_out import GONE, ProcessEvent, Report, StartOutcome, carry_out, stop_all, undo
from robocomp_yaml.deploy.engine import LOST, STOPPED, Engine, EngineHangs, Running, of_last_run
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan, in_order, plan, with_dependents
from robocomp_yaml.deploy.readiness import holds, own_state, unmet
from robocomp_yaml.deploy.states import RUNNING, fault, state_of
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network, Process

if TYPE_CHECKING:
    from robocomp_yaml.deploy.introspection import OwnState

STOP_THEM, ROLL_BACK, KEEP_GOING = "stop", "rollback", "keep"

_PRESENT_WITHIN = 1.0  # seconds

SHOWN_LINES = 10
"""Lines of the log that are shown with a failed process."""


class Result(msgspec.Struct):
    """The result of `up`. `undone` is what was done after a failure (STOP_THEM, ROLL_BACK or KEEP_GOING), else ''.
    `not_restored` are the processes that a rollback started again, or should have, and that are not ready."""

    plan: Plan
    outcome: StartOutcome = msgspec.field(default_factory=StartOutcome)
    diagnostics: list[Diagnostic] = []
    undone: str = ""
    not_restored: list[str] = []


Choose = Callable[[Result], Awaitable[str]]


def always(what: str) -> Choose:
    """The choice that is the same for every result."""

    async def choose(result: Result) -> str:
        return what

    return choose


class Status(msgspec.Struct, frozen=True):
    """The status of a process of the network, or of a process that runs and is no longer part of it. `running` is None
    if it was never started."""

    name: str
    host: str
    is_ready: bool
    running: Running | None = None
    is_server: bool = False
    own: OwnState | None = None
    """What a component says of itself, if it is not ready."""
    unmet: str = ""
    """Which part of the condition of a process that runs and is alive does not hold."""

    @property
    def state(self) -> str:
        return state_of(self.running) if self.running else STOPPED

    @property
    def is_down(self) -> bool:
        """Whether it should run and does not, or ends again and again."""
        return bool(self.running and fault(self.running, is_server=self.is_server))

    @property
    def is_as_desired(self) -> bool:
        """Whether it is ready or done, or nobody started it, or somebody stopped it."""
        return not self.is_down and (self.is_ready or self.state != RUNNING)


async def without_present(network: Network, running: Collection[str]) -> Network:
    """The network without shared processes for which another one answers, which is not of this deployment."""
    shared = [one for one in network.enabled() if one.unless and one.name not in running]
    present = {one.name for one in shared if await _is_present(one)}
    if not present:
        return network
    processes = {
        name: replace(one, enabled=one.enabled and name not in present) for name, one in network.processes.items()
    }
    return replace(network, processes=processes)


async def _is_present(process: Process) -> bool:
    from robocomp_yaml.deploy import ice_ping  # unused without an IceStorm that may be running elsewhere

    return all([await ice_ping.answers(proxy, _PRESENT_WITHIN, process.pem) for proxy in process.unless])


async def up(
    engine: Engine, network: Network, names: Iterable[str], forced: Collection[str], choose: Choose, report: Report,
    *, keep_going: bool = False, limit: TimeLimit | None = None,
) -> Result:  # fmt: skip
    """Brings the network up, and waits until all its processes are ready.

    If there are obstacles, nothing is changed; with `keep_going`, only the processes with obstacles, and those that
    depend on them, are skipped. When a process fails to start, or the time limit expires, `choose` returns what happens
    to the processes that were started. A process that ran before and is not ready is only reported. Raises
    DeployFailed.
    """
    limit = limit or TimeLimit()
    before = await engine.observe()
    network = await without_present(network, {name for name, one in before.items() if one.is_alive})
    result = Result(plan(network, before, names, forced))
    starting = [step.spec for step in result.plan.of(START, RESTART) if step.spec]
    leaving = {step.name for step in result.plan.of(STOP, RESTART)}
    result.diagnostics = await engine.obstacles(starting, leaving) if starting else []
    if limit.is_over:
        result.diagnostics.append(
            deploying.EXPIRED.at(Span(network.path), within=limit, when="before anything was done")
        )
    blocked: dict[str, Diagnostic] = {}
    if result.diagnostics and keep_going and not limit.is_over:
        every = [(spec.name, await engine.obstacles([spec], leaving)) for spec in starting]
        blocked = {name: obstacles[0] for name, obstacles in every if obstacles}
    if result.diagnostics and not blocked:
        return result
    result.outcome = await carry_out(engine, result.plan, report, keep_going=keep_going, limit=limit, blocked=blocked)
    outcome = result.outcome
    if outcome.failed or outcome.is_late:
        result.diagnostics = await _what_failed(engine, network, result, limit)
        is_unfinished = outcome.failed.keys() & set(outcome.began) or (outcome.is_late and outcome.skipped)
        result.undone = await choose(result) if is_unfinished and not keep_going else KEEP_GOING
        await _undo(engine, network, result, before, report)
    return result


async def _undo(
    engine: Engine, network: Network, result: Result, before: Mapping[str, Running], report: Report
) -> None:  # fmt: skip
    now = await engine.observe()
    if result.undone == STOP_THEM:
        await stop_all(engine, [now[name] for name in result.outcome.began if name in now], report)
    elif result.undone == ROLL_BACK:
        again = await carry_out(engine, undo(result.plan, before, now), report, keep_going=True)
        result.not_restored = [*again.failed, *again.skipped]
        for name, reason in again.failed.items():
            # The spec that an engine keeps of a process has no location.
            result.diagnostics.append(replace(reason, span=network.span_of(name)))


async def _what_failed(engine: Engine, network: Network, result: Result, limit: TimeLimit) -> list[Diagnostic]:
    """A diagnostic for each failed process, with the last lines of its log, and one for all that were late."""
    outcome = result.outcome
    logs = {name: await last_lines(engine, name) for name in outcome.failed}
    failed = {name: reason for name, reason in outcome.failed.items() if name not in outcome.late}
    reported = list(dict.fromkeys(replace(reason, more="\n".join(logs[name])) for name, reason in failed.items()))
    if not outcome.is_late:
        return reported
    desired = [step.name for step in result.plan.of(START, RESTART, CHANGE, KEEP)]
    ready = [name for name in desired if name not in outcome.failed and name not in outcome.skipped]
    groups = {"ready": ready, "pending": outcome.late, "failed": failed, "not started": outcome.skipped}
    more = [f"{what}: {', '.join(names)}" for what, names in groups.items() if names]
    late = deploying.EXPIRED.at(
        Span(network.path), within=limit,
        when=f"when {len(ready)} of {len(desired)} processes {'was' if len(ready) == 1 else 'were'} ready",
        related=[Related(outcome.failed[name].message, outcome.failed[name].span) for name in outcome.late],
        more="\n".join([*more, *(line for name in outcome.late for line in logs[name])]),
    )  # fmt: skip
    return [late, *reported]


async def last_lines(engine: Engine, name: str) -> list[str]:
    """The last lines of the last run of a process."""
    async with aclosing(await engine.lines([name], SHOWN_LINES, False)) as lines:
        found = [line.text async for line in lines]
    last = of_last_run(found)
    return [f"{name} | {line}" for line in (found if last is None else last)]


async def status(
    engine: Engine, network: Network, names: Collection[str], reached: bool, known: Mapping[str, Status] | None = None
) -> list[Status]:  # fmt: skip
    """The status of processes: those of the network first, in its order. `reached` is what `Engine.open` returned.
    Without `names`, all processes. Those that are `known` are not asked: only what the engine observes is new of them.
    Raises DeployFailed."""
    running = await engine.observe(use=True) if reached else {}

    async def status_of(name: str) -> Status:
        one, process = running.get(name), network.processes.get(name)
        if one and known and name in known:
            return replace(known[name], running=one)
        host = one.host if one else process.host if process else ""
        process = process or (one.spec.process if one and one.spec else None)
        is_server = process is not None and process.is_server
        if process and process.unless and not (one and one.is_alive):
            return Status(name, host, await _is_present(process), None, is_server)
        if one is None or one.spec is None:
            return Status(name, host, False, one, is_server)
        if one.state != RUNNING:
            return Status(name, host, await holds(engine, one.spec, one), one, is_server)
        is_ready, own = await asyncio.gather(holds(engine, one.spec, one), own_state(one.spec))
        says_why = is_ready or one.not_alive or (own is not None and not own.is_running)
        return Status(name, host, is_ready, one, is_server, own, "" if says_why else await unmet(one.spec))

    enabled = [process.name for process in network.enabled()]
    every = [*enabled, *(name for name in running if name not in enabled)]
    return await asyncio.gather(*(status_of(name) for name in every if not names or name in names))


async def down(engine: Engine, names: Collection[str], report: Report, folder: str) -> list[str]:
    """Stops all processes, or these and all that are after them. Returns those that ran. The engine ends with its last
    process. Without `names`, nothing of the network is left in its folder. Raises DeployFailed."""
    running = await engine.observe()
    stopped = leaving(running, names)
    alive = [name for name in stopped if running[name].is_alive]
    await stop_all(engine, [running[name] for name in stopped], report)
    await engine.forget(set(stopped))
    await engine.close(end=len(stopped) == len(running))
    if not names:
        remains.after_down(folder)
    return alive


async def take_down(engine: Engine, network: Network, names: Collection[str], report: Report) -> list[str]:
    """The same as `down`, whether the engine runs, was killed, or hangs; then it is killed, unless `names` are to stop
    only. Raises DeployFailed."""
    try:
        is_running = await engine.open(network, create=False)
    except EngineHangs as hanging:
        if names:
            raise
        ended = await hanging.end()
        for name in ended:
            report(ProcessEvent(name, GONE))
    else:
        if is_running:
            return await down(engine, names, report, network.folder)
        ended = []
    await engine.close(end=not names)
    if not names:  # what is left of a network whose engine was killed, and whose processes with it
        remains.after_down(network.folder)
    return ended


def leaving(running: Mapping[str, Running], names: Collection[str]) -> list[str]:
    """The names of these processes and all that are after them, without names of all, in the order in which they
    stop."""
    after = {name: one.spec.process.after if one.spec else () for name, one in running.items()}
    stopped = with_dependents(after, names) if names else set(running)
    return [name for name in reversed(in_order(after)) if name in stopped]


def reasons_to_stop(network: Network, stopping: Collection[str], chosen: Collection[str]) -> dict[str, str]:
    """Why those of the `stopping` processes stop that are not `chosen`."""
    return {
        name: f"it is after {needed}"
        for name in stopping if chosen and name not in chosen and name in network.processes
        for needed in network.processes[name].after if needed in stopping
    }  # fmt: skip


async def end_if_idle(engine: Engine, folder: str, *, is_down: bool = False) -> None:
    """Closes an engine, and ends it if no process runs. Then nothing of the network is left in its folder, but what a
    rollback needs, unless the user took it down."""
    running = await engine.observe()
    is_idle = not any(one.is_alive or one.state == LOST for one in running.values())
    await engine.close(end=is_idle)
    if is_idle:
        (remains.after_down if is_down else remains.after_failure)(folder)
