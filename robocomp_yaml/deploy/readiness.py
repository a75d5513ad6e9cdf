"""Readiness of processes: the condition of a `Readiness` is checked until it holds or the time expires."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Collection
from contextlib import aclosing, suppress
from typing import TYPE_CHECKING

from msgspec.structs import replace

from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import OWN, DeployFailed, Engine, Line, Running, of_last_run
from robocomp_yaml.deploy.patterns import PatternTooSlow, search
from robocomp_yaml.deploy.plan import ill
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ENDED, GIVEN_UP, RUNNING, SILENT
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.terminal import typed

if TYPE_CHECKING:
    from robocomp_yaml.deploy.introspection import OwnState

SETTLED = 0.1
"""Seconds that a process without a condition must run before it counts as ready, unless the document sets more."""

LOG_LINES = 1000
"""Lines of the log in which the line that makes a running process ready is looked up."""

_SHORTEST, _LONGEST, _SLOWER = 0.02, 0.2, 1.2  # seconds between two checks, and the factor by which they grow
_ONE_TRY = 2.0  # seconds for one check
_END = 0.4  # seconds between two checks whether it has ended
_NEW = 0.05  # the maximum age, in seconds, of an observed state of a starting process

RECENT = 0.2
"""The maximum age, in seconds, of an observed state if no change is expected."""

State = Callable[[float], Awaitable[Running | None]]
"""The observed state of a process, not older than a time (`time.monotonic`)."""


async def holds(engine: Engine, spec: ProcessSpec, running: Running) -> bool:
    """Whether a process is ready now. Raises DeployFailed."""
    ready = spec.process.ready
    if running.state == ENDED:
        return not (ready.has_condition or spec.process.is_server)
    if running.state != RUNNING or running.not_alive:
        return False
    if ready.log:
        async with aclosing(await engine.lines([spec.name], LOG_LINES, False)) as lines:
            texts = [line.text async for line in lines]
        last = of_last_run(texts)
        # A process that has written so many lines since its start is ready.
        with suppress(PatternTooSlow):
            return last is None or any(_matches(ready.log, text) for text in last)
        return False
    return await _check(engine, spec, _ONE_TRY) and bool(running.uptime >= SETTLED or ready.pings or ready.port)


def _settled(spec: ProcessSpec) -> float:
    return max(spec.process.settled or 0.0, SETTLED)


def _hint_for_127(spec: ProcessSpec) -> str:
    document = [shown_path(spec.process.span.file)] if spec.process.span.file else []
    probe = typed("rcyaml", "deploy", "probe", *document, spec.process.host)
    return f"exit code 127 means that a program is missing: `{probe}` shows the programs of host '{spec.process.host}'"


async def until_ready(
    engine: Engine, spec: ProcessSpec, lines: AsyncIterator[Line], state: State,
    others: Collection[asyncio.Task[bool]] = (), restarts: int = 0,
) -> None:  # fmt: skip
    """Waits until a process is ready. Raises DeployFailed if it ends before, or takes too long. `lines` are its output
    from now on. Its time begins when the `others` are done, for which it waits. `restarts` are those before."""
    end = asyncio.create_task(_until_it_ends(spec, state))
    ready = asyncio.create_task(_until_it_holds(engine, spec, lines, state))
    try:
        limit = spec.process.ready.within + (0 if spec.process.ready.has_condition else _settled(spec))
        while pending := [other for other in others if not other.done()]:
            done, _ = await asyncio.wait((end, ready, *pending), return_when=asyncio.FIRST_COMPLETED)
            if done & {end, ready}:
                break
        done, _ = await asyncio.wait((end, ready), timeout=limit, return_when=asyncio.FIRST_COMPLETED)
        if ready in done:
            return ready.result()
        running = await state(time.monotonic() - _NEW)
        if end in done:
            how = end.result()
            hint = _hint_for_127(spec) if "exit code 127" in how else ""
            raise DeployFailed(deploying.ENDED_EARLY.at(spec.process.span, name=spec.name, how=how, hint=hint))
        raise DeployFailed(await unready(spec, running, f"{spec.process.ready.within:g}", restarts))
    finally:
        for task in (end, ready):
            task.cancel()
            with suppress(asyncio.CancelledError, DeployFailed):
                await task


async def _until_it_ends(spec: ProcessSpec, state: State) -> str:
    """Waits until the process has ended and is not restarted; returns how it ended."""
    began = time.monotonic()
    while True:
        # Before the first check: most processes are ready by then, and the others share one observation.
        await asyncio.sleep(_END)
        running = await state(max(began, time.monotonic() - RECENT))
        if running is None or running.state in (GIVEN_UP, *SILENT):
            return (running.end if running else "") or "it was stopped in the meantime"
        if running.state == ENDED and (spec.process.ready.has_condition or spec.process.is_server):
            # Its last line can make it ready, and is read a little later.
            await asyncio.sleep(2 * _LONGEST if spec.process.ready.log else 0)
            return running.last_exit


async def _until_it_holds(engine: Engine, spec: ProcessSpec, lines: AsyncIterator[Line], state: State) -> None:
    if spec.process.ready.log:
        async for line in lines:
            try:
                if _matches(spec.process.ready.log, line.text):
                    return
            except PatternTooSlow as error:
                where, pattern = spec.process.span, spec.process.ready.log
                raise DeployFailed(deploying.TOO_SLOW.at(where, name=spec.name, pattern=pattern)) from error
    has_condition, settled = spec.process.ready.has_condition, _settled(spec)
    pause = _SHORTEST if has_condition else settled
    while True:
        await asyncio.sleep(pause)
        pause = min(pause * _SLOWER, _LONGEST)
        if has_condition:
            if await _check(engine, spec, min(_ONE_TRY, spec.process.ready.within)):
                return
        elif running := await state(time.monotonic() - _NEW):
            if running.state == ENDED and not spec.process.is_server:
                return
            if running.state == RUNNING and running.uptime >= settled:
                return
            if running.state == RUNNING:
                pause = max(settled - running.uptime, _SHORTEST)


async def _check(engine: Engine, spec: ProcessSpec, within: float) -> bool:
    """Checks any condition but that of the log, once."""
    ready = spec.process.ready
    if ready.pings:
        return await _serves(spec, within)
    if ready.port:
        return await listens(spec.address, ready.port, within)
    if ready.command:
        return await engine.run(spec.name, ready.command, within) == 0
    return True


async def until_it_serves(spec: ProcessSpec) -> None:
    """Waits until everything that a component serves answers a ping, also if the component waits for others."""
    for proxy in spec.process.ready.pings:
        while not await _answers(proxy, _ONE_TRY, spec.process.pem):
            await asyncio.sleep(_LONGEST)


async def _serves(spec: ProcessSpec, within: float) -> bool:
    """Whether a component runs, as it says itself, and everything that it serves answers a ping."""
    pings, own = spec.process.ready.pings, spec.process.introspection
    if own:
        from robocomp_yaml.deploy import introspection

        with suppress(introspection.NoFacet):
            state = await introspection.state(own, within, spec.process.pem)
            if state is None or not state.is_running:
                return False
            pings = tuple(proxy for proxy in pings if proxy != own)
    for proxy in pings:
        if not await _answers(proxy, within, spec.process.pem):
            return False
    return True


async def own_state(spec: ProcessSpec, within: float = _ONE_TRY) -> OwnState | None:
    """What a component says of itself; None if it does not answer, or does not describe itself."""
    proxy = spec.process.introspection
    if not proxy:
        return None
    from robocomp_yaml.deploy import introspection  # programs have none

    with suppress(introspection.NoFacet):
        return await introspection.state(proxy, within, spec.process.pem)
    return None


async def _answers(proxy: str, within: float, pem: str) -> bool:
    from robocomp_yaml.deploy import ice_ping  # programs serve nothing

    return await ice_ping.answers(proxy, within, pem)


async def listens(host: str, port: int, within: float) -> bool:
    """Whether something listens on a TCP port; False after `within` seconds."""
    try:
        async with asyncio.timeout(within):
            _, writer = await asyncio.open_connection(host, port)
    except OSError:
        return False
    writer.close()
    return True


def _matches(pattern: str, text: str) -> bool:
    return not text.startswith(OWN) and search(pattern, text)


async def unready(spec: ProcessSpec, running: Running | None, within: object, restarts: int) -> Diagnostic:
    """The diagnostic for a process that is not ready in time. Of one that ends again and again or is not alive, it is
    the one of `plan`: whatever else it lacks follows from that."""
    if running and (found := ill(running, spec.process.span)):
        return found
    why = await _why_not(spec, running, restarts)
    return deploying.NOT_READY.at(spec.process.span, name=spec.name, within=within, why=why)


async def _why_not(spec: ProcessSpec, running: Running | None, restarts: int) -> str:
    """Why a process is not ready, for which somebody waits since it had been restarted so many times: an earlier end is
    no reason any more."""
    if running and running.restarts > restarts:
        return f"it ended in the meantime: {replace(running, restarts=running.restarts - restarts).end}"
    own = await own_state(spec) if spec.process.ready.pings else None
    if own is not None and not own.is_running:
        from robocomp_yaml.wire.introspection import WAITING

        return f"it is {own.words}" + (f" ({own.why})" if own.state == WAITING and own.why else "")
    return await unmet(spec) or "it does not keep running"


async def unmet(spec: ProcessSpec) -> str:
    """Which part of the condition of a running process does not hold, '' without a condition."""
    ready = spec.process.ready
    if ready.pings:
        checks = (_answers(proxy, _ONE_TRY, spec.process.pem) for proxy in ready.pings)
        silent = [proxy for proxy, is_it in zip(ready.pings, await asyncio.gather(*checks), strict=True) if not is_it]
        return "no answer from " + ", ".join(one.partition(":")[0].split()[0] for one in silent or ready.pings)
    if ready.port:
        return f"nothing listens on port {ready.port}"
    if ready.command:
        return f"`{' '.join(ready.command)}` did not succeed"
    return f"no line of its log matches '{ready.log}'" if ready.log else ""
