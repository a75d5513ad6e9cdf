"""How the commands of `rcyaml deploy` call the library, and tell what came of it."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import click
import msgspec

from robocomp_yaml import api
from robocomp_yaml.api.deployments import document
from robocomp_yaml.commands import _deploy_views as views
from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.commands._progress import Progress
from robocomp_yaml.deploy.engine import Line
from robocomp_yaml.deploy.operations import Result
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.diag.render import text
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.network.network import Network

T = TypeVar("T")


class Opened(msgspec.Struct):
    """A deployment as a command works on it; of its diagnostics some have been `shown`. `ended_by` is the exit code
    where the user had enough of what was brought up."""

    deployment: api.Deployment
    format_: str
    shown: list[Diagnostic] = []
    ended_by: int = 0

    @property
    def network(self) -> Network:
        return self.deployment.network


def open_(
    ctx: click.Context, ddsl: str, include: tuple[str, ...], format_: str, engine: str | None, *, lenient: bool = False
) -> Opened:  # fmt: skip
    """Reads the document and all that belongs to it. Ends the command where it has errors; `lenient` lets those pass
    that leave the network readable, and takes what runs where they do not: it can be taken down whatever became of its
    documents."""
    path = os.path.normpath(document(ddsl, include))
    try:
        deployment = api.load(path, include=include).deployment(path, engine=engine, lenient=lenient)
    except Faulty as faulty:
        _options.report(ctx, format_, faulty.diagnostics, faulty.documents)
        raise
    if deployment.unread:
        terminal.say(f"{path} cannot be read (see `rcyaml check`): this is about what runs of it", err=True)
    return Opened(deployment, format_)


def plan(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    found = carried_out(ctx, opened, lambda: opened.deployment.plan(*names))
    if opened.format_ == "json":
        end(ctx, opened, {"plan": views.plan_data(found)})
    terminal.say(*views.plan_lines(found, _options.colored(ctx), everything=ctx.obj.verbosity > 0))
    end(ctx, opened)


def build(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    """Ends the command where something cannot be built: nothing is started then."""
    from robocomp_yaml.commands import _building

    built = _building.run(
        ctx, opened.format_, lambda report: opened.deployment.build(*names, report=report),
        "interrupted: nothing was started; what was built stays",
    )  # fmt: skip
    if any(one.has_errors for one in built):
        told = [one for each in built for one in each.diagnostics]
        if opened.format_ == "json":
            head = {"deployment": opened.network.name, "engine": opened.deployment.engine}
            terminal.data(dumps({**head, "diagnostics": [as_data(one) for one in told]}), json=True)
        else:
            terminal.say(f"{opened.network.name}: nothing was touched")
        ctx.exit(1)


def up(
    ctx: click.Context, opened: Opened, names: tuple[str, ...], on_failure: str, timeout: float | None, *,
    restart: bool = False, attach: bool = False,
) -> None:  # fmt: skip
    is_asked = on_failure == "ask" and sys.stdin.isatty() and sys.stdout.isatty() and opened.format_ == "text"
    progress = _progress(ctx, opened)

    async def choose(result: Result) -> str:
        progress.pause()
        show(ctx, opened, opened.deployment.placed(result.diagnostics))
        return await _options.ask(
            "stop what was started, roll back to what ran before, or keep it as it is?", ("stop", "rollback", "keep")
        )

    def bring_up() -> Result:
        with progress:
            return opened.deployment.up(
                *names, restart=restart, timeout=timeout, report=progress.report,
                on_failure=choose if is_asked else "stop" if on_failure == "ask" else on_failure,
                stays=_attached(ctx, opened, progress) if attach else None,
            )  # fmt: skip

    result = carried_out(ctx, opened, bring_up, "interrupted: all was taken down" if attach else None)
    if opened.format_ == "json":
        end(ctx, opened, views.result_data(result))
    if not attach and ctx.obj.verbosity >= 0:
        terminal.say(views.result_text(opened.network, result))
    end(ctx, opened)


def _attached(ctx: click.Context, opened: Opened, progress: Progress) -> api.Attached:
    """The user, who sees what the processes print and has enough with Ctrl-C."""
    view = views.LogView(opened.deployment.enabled, _options.colored(ctx), times=False)

    def on_line(line: Line) -> None:
        terminal.say(view.text(line))

    def on_up(enough: asyncio.Event) -> None:
        def stop(number: int) -> None:
            opened.ended_by = 128 + number
            enough.set()

        progress.pause()
        for number in (signal.SIGINT, signal.SIGTERM):
            asyncio.get_running_loop().add_signal_handler(number, stop, number)
        if opened.format_ == "text" and ctx.obj.verbosity >= 0:
            terminal.say(f"{opened.network.name}: Ctrl-C takes it down")

    return api.Attached(on_up, on_line if opened.format_ == "text" else None)


def status(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    found = carried_out(ctx, opened, lambda: opened.deployment.status(*names))
    code = 1 if any(one.is_down for one in found) else 0
    if opened.format_ == "json":
        end(ctx, opened, {"processes": views.status_data(opened.network, found)}, code)
    room = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    terminal.say(*views.status_lines(opened.network, found, _options.colored(ctx), room))
    end(ctx, opened, code=code)


def logs(ctx: click.Context, opened: Opened, names: tuple[str, ...], last: int, *, follow: bool, times: bool) -> None:
    wanted = opened.deployment.chosen(names) or opened.deployment.enabled
    view = views.LogView(wanted, _options.colored(ctx), times)

    def on_line(line: Line) -> None:
        if opened.format_ == "json":
            terminal.data(views.line_data(line), json=True)
        else:
            terminal.say(view.text(line))

    carried_out(
        ctx, opened, lambda: opened.deployment.logs(*names, last=last, follow=follow, on_line=on_line), on_interrupt=""
    )


def down(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    def take_down() -> list[str]:
        with _progress(ctx, opened) as progress:
            return opened.deployment.down(*names, report=progress.report)

    stopped = carried_out(ctx, opened, take_down)
    if opened.format_ == "json":
        end(ctx, opened, {"stopped": stopped})
    if not stopped:
        terminal.say(f"{opened.network.name}: nothing ran")
    end(ctx, opened)


def _progress(ctx: click.Context, opened: Opened) -> Progress:
    is_shown = opened.format_ == "text" and ctx.obj.verbosity >= 0
    return Progress(is_shown, _options.colored(ctx), opened.deployment.enabled)


def carried_out(ctx: click.Context, opened: Opened, work: Callable[[], T], on_interrupt: str | None = None) -> T:
    """What a call gives. What fails it ends the command, and so does Ctrl-C, with a line that says what that means for
    what runs."""
    try:
        return work()
    except Faulty:
        end(ctx, opened)
        raise
    except KeyboardInterrupt as error:
        if on_interrupt is None:
            stop = terminal.typed("rcyaml", "deploy", "down", opened.deployment.path)
            on_interrupt = f"interrupted: what runs goes on; `{stop}` stops it"
        if on_interrupt:
            terminal.say(on_interrupt, err=True)
        ctx.exit(_signals.code_of(error))
        raise


def end(ctx: click.Context, opened: Opened, data: dict[str, object] | None = None, code: int = 0) -> None:
    """Tells what is wrong and ends the command: with 1 where one of it is an error."""
    told = opened.deployment.diagnostics
    if opened.format_ == "json":
        head = {"deployment": opened.network.name, "engine": opened.deployment.engine, **(data or {})}
        terminal.data(dumps({**head, "diagnostics": [as_data(one) for one in told]}), json=True)
    else:
        show(ctx, opened, told)
    ctx.exit(opened.ended_by or (1 if has_errors(told) else code))


def show(ctx: click.Context, opened: Opened, told: Iterable[Diagnostic]) -> None:
    """Prints what was not printed before."""
    new = [one for one in told if one not in opened.shown]
    opened.shown += new
    if new:
        blocks = text.each(new, _options.colored(ctx, sys.stderr))
        terminal.say(*[line for block in blocks for line in (terminal.Shown(), *block)][1:], err=True)
