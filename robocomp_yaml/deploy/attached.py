"""An `up` that stays attached: it forwards what the processes print, and takes the network down at the end."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress

import msgspec

from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.carry_out import stop_all
from robocomp_yaml.deploy.engine import Engine, Line
from robocomp_yaml.deploy.states import OVER, fault
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network

_PERIOD = 0.2  # seconds between two observations

Follow = Callable[[], Awaitable[list[Diagnostic]]]


class Attached(msgspec.Struct, frozen=True):
    """Callbacks of an attached `up`. `on_line` receives each line that the processes print, from the beginning. `on_up`
    is called when the network is up, with the event that ends the attachment."""

    on_up: Callable[[asyncio.Event], None]
    on_line: Callable[[Line], None] | None = None


@asynccontextmanager
async def attached(engine: Engine, network: Network, stays: Attached | None) -> AsyncIterator[Follow]:
    """Yields a function that waits until nothing runs any more or the attachment ends, takes down what still runs, and
    returns diagnostics."""
    printer = asyncio.create_task(_print(engine, network, stays.on_line)) if stays and stays.on_line else None
    try:
        yield lambda: _stay(engine, network, stays)
    except asyncio.CancelledError:
        if stays:  # cancelled while the network came up
            await _take_down(engine)
            await operations.end_if_idle(engine, network.folder, is_down=True)
        raise
    finally:
        if printer:
            await asyncio.sleep(_PERIOD)  # for the last lines
            printer.cancel()
            with suppress(asyncio.CancelledError):
                await printer


async def _print(engine: Engine, network: Network, on_line: Callable[[Line], None]) -> None:
    async for line in await engine.lines(list(network.processes), 0, True):
        on_line(line)


async def _stay(engine: Engine, network: Network, stays: Attached | None) -> list[Diagnostic]:
    ended = asyncio.Event()
    if stays:
        stays.on_up(ended)
    failed: dict[str, Diagnostic] = {}
    while not ended.is_set():
        running = await engine.observe()
        for one in running.values():
            if one.spec and one.state in OVER and fault(one, is_server=one.spec.process.is_server):
                failed[one.name] = deploying.GIVEN_UP.at(network.span_of(one.name), name=one.name, how=one.end)
        if not any(one.is_alive for one in running.values()):
            break
        with suppress(TimeoutError):
            await asyncio.wait_for(ended.wait(), _PERIOD)
    await _take_down(engine)
    return list(failed.values())


async def _take_down(engine: Engine) -> None:
    running = await engine.observe()
    await stop_all(engine, running.values(), lambda event: None)
