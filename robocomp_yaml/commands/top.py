"""`rcyaml top`: what the processes of a running deployment do, live."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options, _signals, _talking
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.commands._ddsl import DocumentAnd, default_document, running_document
from robocomp_yaml.commands._duration import Duration
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.errors import Faulty

if TYPE_CHECKING:
    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.commands._top_view import TopView
    from robocomp_yaml.deploy.sampling import NetworkSample

SORTS = ("document", "name", "state", "cpu", "memory", "missed", "calls", "slowest", "topics")


def _processes(addresses: Addresses, incomplete: str) -> list[str]:
    """For completion."""
    return [one.name for one in addresses.network.enabled()] if addresses.network else []


@click.command(cls=LibraryCommand, short_help="Show what the processes of a deployment do, live.")
@click.argument("names", cls=DocumentAnd, metavar="[NAME]...", running=True,
                shell_complete=_talking.completing(_processes))  # fmt: skip
@click.option("--deployment", metavar="DDSL", help="The deployment: its document, or its name in `deploy ls`.")
@click.option("--sort", type=click.Choice(SORTS), default="document", show_default=True, help="What comes first.")
@click.option("--reverse", is_flag=True, help="The other way round.")
@click.option("--every", type=Duration(), default="2s", show_default=True, metavar="TIME", help="Time between samples.")
@click.option("--count", type=click.IntRange(1), metavar="N", help="End after N samples.")
@click.option("--once", is_flag=True, help="Print one table, and end.")
@_options.include
@_options.format_of(["text", "json"], "json: a line for each sample.")
@click.pass_context
def command(
    ctx: click.Context, ddsl: str, names: tuple[str, ...], deployment: str | None, sort: str, reverse: bool,
    every: float, count: int | None, once: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Show the processes of a running deployment until q or Ctrl-C: their state, CPU and memory, and what components
    say of themselves: the desired period, the achieved one and how many turns were missed, calls per second and the
    method with the longest call, and the messages of topics per second.

    DDSL is the document, or a name of `rcyaml deploy ls`; by default, the only deployment here, else the only one that
    runs. NAMEs are its processes or groups. If the output is not a terminal, tables are printed one after the other.
    """
    from robocomp_yaml.api.sampling import sample
    from robocomp_yaml.commands import _screen
    from robocomp_yaml.commands._deploying import open_session
    from robocomp_yaml.commands._top_view import TopView

    if deployment is not None:
        names, ddsl = ((ddsl, *names) if ddsl else names), running_document(deployment)
    session = open_session(ctx, ddsl or default_document(), include, "text", None, lenient=True)
    opened, count = session.deployment, 1 if once else count
    title = f"{opened.network.name} ({opened.engine})"
    view = TopView(title, sort, _options.colored(ctx), is_reversed=reverse)
    is_live = format_ == "text" and not once and _screen.is_screen()

    async def show(samples: AsyncGenerator[NetworkSample, None]) -> None:
        if is_live:
            await _live(samples, view, count)
        else:
            await _printed(samples, view, count, (opened.network.name, opened.engine) if format_ == "json" else None)

    try:
        with _signals.hangup_handled():
            sample(opened, *names, every=every, show=show)
    except Faulty:
        session.end()


async def _printed(
    samples: AsyncGenerator[NetworkSample, None], view: TopView, count: int | None, json: tuple[str, str] | None
) -> None:
    """Prints samples one after the other. The first one has no rates, and is not shown."""
    from robocomp_yaml.commands._top_view import as_data

    number = 0
    async for sample in samples:
        if json is not None and number:
            terminal.data(_talking.as_json(as_data(*json, sample)), json=True)
        elif number:
            terminal.say(*([""] if number > 1 else []), *view.lines(sample))
        if number == count:
            return
        number += 1


async def _live(samples: AsyncGenerator[NetworkSample, None], view: TopView, count: int | None) -> None:
    """Draws the last sample on the whole terminal, and again when a key is typed, until q."""
    from robocomp_yaml.commands import _screen
    from robocomp_yaml.commands._top_view import QUIT

    last: list[NetworkSample] = []
    over = asyncio.Event()

    def draw() -> None:
        screen.draw(view.screen(last[0] if last else None, *screen.size))

    def on_key(key: str) -> None:
        if key == QUIT:
            over.set()
        else:
            view.key(key)
            draw()

    async def follow() -> None:
        number = 0
        async for sample in samples:
            last[:] = [sample]
            draw()
            if number == count:
                return
            number += 1

    with _screen.Screen(on_key, draw) as screen:
        draw()
        tasks = [asyncio.create_task(follow()), asyncio.create_task(over.wait())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()
