"""`rcyaml deploy up --attach`: stays while the network runs, shows what it prints, and takes it down at the end."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _deploy_views as views
from robocomp_yaml.commands import _options
from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.carry_out import stop_all
from robocomp_yaml.deploy.engine import GIVEN_UP, RUNNING, WAITING
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic

if TYPE_CHECKING:
    from robocomp_yaml.commands._deploying import Opened

_PERIOD = 0.2  # seconds between two looks whether anything is left

Follow = Callable[[], Awaitable[list[Diagnostic]]]


@asynccontextmanager
async def attached(ctx: click.Context, opened: Opened, wanted: bool) -> AsyncIterator[Follow]:
    """Shows from now on what the processes print, if `wanted`. The function that it gives waits until nothing runs any
    more or the user has had enough, and takes down what is left; it returns what went wrong."""
    printer = asyncio.create_task(_print(ctx, opened)) if wanted and opened.format_ == "text" else None
    try:
        yield lambda: _stay(ctx, opened)
    except asyncio.CancelledError:
        if wanted:  # while it came up
            await _take_down(opened)
            await operations.end_if_idle(opened.engine)
        raise
    finally:
        if printer:
            await asyncio.sleep(_PERIOD)  # for what was printed last
            printer.cancel()
            with suppress(asyncio.CancelledError):
                await printer


async def _print(ctx: click.Context, opened: Opened) -> None:
    shown = views.LogView(opened.enabled, _options.colored(ctx), times=False)
    async for line in await opened.engine.lines(list(opened.network.processes), 0, True):
        terminal.say(shown.text(line))


async def _stay(ctx: click.Context, opened: Opened) -> list[Diagnostic]:
    enough = asyncio.Event()

    def end(number: int) -> None:
        opened.ended_by = 128 + number
        enough.set()

    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, end, number)
    if opened.format_ == "text" and ctx.obj.verbosity >= 0:
        terminal.say(f"{opened.network.name}: Ctrl-C takes it down")
    failed: dict[str, Diagnostic] = {}
    while not enough.is_set():
        running = await opened.engine.observe()
        for one in running.values():
            if one.state == GIVEN_UP and one.spec:
                failed[one.name] = deploying.GIVEN_UP.at(one.spec.process.span, name=one.name, how=one.end)
        if not any(one.state in (RUNNING, WAITING) for one in running.values()):
            break
        with suppress(TimeoutError):
            await asyncio.wait_for(enough.wait(), _PERIOD)
    await _take_down(opened)
    return list(failed.values())


async def _take_down(opened: Opened) -> None:
    running = await opened.engine.observe()
    await stop_all(opened.engine, running.values(), lambda event: None)
