"""What can be done with a deployment as a whole: bring it up, see how it is, take it down. Commands and managers call
these, whatever the engine."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Collection, Iterable, Mapping
from contextlib import aclosing

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy.carry_out import Report, StartOutcome, carry_out, stop_all, undo
from robocomp_yaml.deploy.engine import GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, Engine, Running
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP, Plan, plan, with_dependents
from robocomp_yaml.deploy.readiness import holds
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network

STOP_THEM, ROLL_BACK, KEEP_GOING = "stop", "rollback", "keep"

SHOWN_LINES = 10
"""Lines of a log that are shown with what failed."""


class Result(msgspec.Struct):
    """What came of an `up`. `undone` is what was done on failure, '' where nothing failed."""

    plan: Plan
    outcome: StartOutcome = msgspec.field(default_factory=StartOutcome)
    diagnostics: list[Diagnostic] = []
    undone: str = ""


Choose = Callable[[Result], Awaitable[str]]


class Status(msgspec.Struct, frozen=True):
    """A process of the network, or one that runs and is no longer part of it. `running` is None where it was never
    started."""

    name: str
    host: str
    is_ready: bool
    running: Running | None = None

    @property
    def state(self) -> str:
        return self.running.state if self.running else STOPPED

    @property
    def is_down(self) -> bool:
        """Whether it should run, but does not."""
        return self.state in (WAITING, GIVEN_UP, LOST)


async def up(
    engine: Engine, network: Network, names: Iterable[str], forced: Collection[str], choose: Choose, report: Report,
    *, keep_going: bool = False, limit: TimeLimit | None = None,
) -> Result:  # fmt: skip
    """Brings about what the network says, and waits until all of it is ready. Nothing is touched where something stands
    in the way that can be seen before; with `keep_going`, only what it keeps from starting, and what needs that. When a
    process that is started fails, or the time is over, `choose` says what becomes of those that were; one that ran
    already and is not ready is only reported."""
    limit = limit or TimeLimit()
    before = await engine.observe()
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
        found = [(spec.name, await engine.obstacles([spec], leaving)) for spec in starting]
        blocked = {name: obstacles[0] for name, obstacles in found if obstacles}
    if result.diagnostics and not blocked:
        return result
    result.outcome = await carry_out(engine, result.plan, report, keep_going=keep_going, limit=limit, blocked=blocked)
    outcome = result.outcome
    if outcome.failed or outcome.is_late:
        result.diagnostics = await _what_failed(engine, network, result, limit)
        is_unfinished = outcome.failed.keys() & set(outcome.began) or (outcome.is_late and outcome.skipped)
        is_asked = is_unfinished and not keep_going
        result.undone = await choose(result) if is_asked else KEEP_GOING
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
        for name, found in again.failed.items():
            # What an engine has kept of a process does not know where it stands in the document.
            result.diagnostics.append(replace(found, span=network.span_of(name)))


async def _what_failed(engine: Engine, network: Network, result: Result, limit: TimeLimit) -> list[Diagnostic]:
    """Each with the last lines of its log; those that were late together."""
    outcome = result.outcome
    logs = {name: await _last_lines(engine, name) for name in outcome.failed}
    failed = {name: found for name, found in outcome.failed.items() if name not in outcome.late}
    told = list(dict.fromkeys(replace(found, more="\n".join(logs[name])) for name, found in failed.items()))
    if not outcome.is_late:
        return told
    wanted = [step.name for step in result.plan.of(START, RESTART, CHANGE, KEEP)]
    ready = [name for name in wanted if name not in outcome.failed and name not in outcome.skipped]
    groups = {"ready": ready, "waited for": outcome.late, "failed": failed, "not started": outcome.skipped}
    more = [f"{what}: {', '.join(names)}" for what, names in groups.items() if names]
    late = deploying.EXPIRED.at(
        Span(network.path), within=limit,
        when=f"when {len(ready)} of {len(wanted)} processes {'was' if len(ready) == 1 else 'were'} ready",
        related=[Related(outcome.failed[name].message, outcome.failed[name].span) for name in outcome.late],
        more="\n".join([*more, *(line for name in outcome.late for line in logs[name])]),
    )  # fmt: skip
    return [late, *told]


async def _last_lines(engine: Engine, name: str) -> list[str]:
    async with aclosing(await engine.lines([name], SHOWN_LINES, False)) as lines:
        return [f"{name} | {line.text}" async for line in lines]


async def status(engine: Engine, network: Network, names: Collection[str], reached: bool) -> list[Status]:
    """How the processes are, the network's in its order first; `reached` is what `open` said."""
    running = await engine.observe() if reached else {}

    async def look(name: str) -> Status:
        one, process = running.get(name), network.processes.get(name)
        host = one.host if one else process.host if process else ""
        is_ready = bool(one and one.spec) and await holds(engine, one.spec, one)  # type: ignore[union-attr, arg-type]
        return Status(name, host, is_ready, one)

    known = [process.name for process in network.enabled()]
    wanted = [name for name in [*known, *(name for name in running if name not in known)] if not names or name in names]
    return list(await asyncio.gather(*(look(name) for name in wanted)))


async def down(engine: Engine, names: Collection[str], report: Report) -> list[str]:
    """Takes down what runs, or these processes with all that are after them; those that were. The engine ends with the
    last of them."""
    running = await engine.observe()
    after = {name: one.spec.process.after if one.spec else () for name, one in running.items()}
    leaving = with_dependents(after, names) & set(running) if names else set(running)
    alive = [one.name for one in running.values() if one.name in leaving and one.state in (RUNNING, WAITING)]
    await stop_all(engine, [running[name] for name in leaving], report)
    await engine.forget(leaving)
    await engine.close(end=len(leaving) == len(running))
    return alive


async def end_if_idle(engine: Engine) -> None:
    """Lets go of an engine; one that has nothing left to run ends."""
    running = await engine.observe()
    await engine.close(end=not any(one.state in (RUNNING, WAITING, LOST) for one in running.values()))
