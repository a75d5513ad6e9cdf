"""What the commands of `rcyaml deploy` share, and how each is carried out and told."""

from __future__ import annotations

import asyncio
import os
import shutil
import sys
from collections.abc import Collection, Coroutine, Iterable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, TypeVar

import click
import msgspec
from msgspec.structs import replace

from robocomp_yaml.api.deployments import document
from robocomp_yaml.commands import _deploy_views as views
from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.commands._attaching import attached
from robocomp_yaml.commands._progress import Progress
from robocomp_yaml.deploy import folder, operations
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import DeployFailed, Engine
from robocomp_yaml.deploy.engines import make_engine
from robocomp_yaml.deploy.time_limit import TimeLimit
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.render import text
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.network.network import Network

if TYPE_CHECKING:
    from robocomp_yaml.pipeline import Analysis

T = TypeVar("T")


class Opened(msgspec.Struct):
    """A deployment as a command works on it. `path` is its document's, as the user gave it; `told` are the diagnostics
    so far, of which some have been `shown`; `analysis` is of the documents. `lock` is held while it is changed.
    `ended_by` is the exit code where the user had enough of what was brought up."""

    path: str
    network: Network
    engine: Engine
    format_: str
    analysis: Analysis
    told: list[Diagnostic] = []
    shown: list[Diagnostic] = []
    lock: ExitStack = msgspec.field(default_factory=ExitStack)
    ended_by: int = 0

    @property
    def enabled(self) -> set[str]:
        return {process.name for process in self.network.enabled()}


def open_(
    ctx: click.Context, ddsl: str, include: tuple[str, ...], format_: str, engine: str | None, *, lenient: bool = False
) -> Opened:  # fmt: skip
    """Reads the document and all that belongs to it. Ends the command where it has errors; `lenient` lets those pass
    that leave the network readable, and takes what runs where they do not: it can be taken down whatever became of its
    documents."""
    from robocomp_yaml.pipeline import analyse

    path = os.path.normpath(document(ddsl, include))
    analysis = analyse([path], include)
    network = analysis.networks.get(os.path.realpath(path))
    if network is None and lenient:
        from robocomp_yaml.deploy.stand_in import stand_in

        if network := stand_in(path):
            terminal.say(f"{path} cannot be read (see `rcyaml check`): this is about what runs of it", err=True)
    if network is None or (has_errors(analysis.diagnostics) and not lenient):
        _options.report(ctx, format_, analysis.diagnostics, analysis.program.documents)
    assert network
    told: list[Diagnostic] = []
    if not lenient:
        from robocomp_yaml.deploy.outdated import outdated

        told = analysis.with_more(outdated(analysis.program.deployments[os.path.realpath(path)]))
    return Opened(path, network, make_engine(engine, network), format_, analysis, told)


def chosen(network: Network, names: Iterable[str]) -> set[str]:
    """The processes that are meant: by their names, aliases or groups. Ends the command where one is unknown."""
    found: set[str] = set()
    for name in names:
        members = {process.name for process in network.processes.values() if name in process.groups}
        process = network.find(name)
        if not members and process is None:
            known = [*network.processes, *(group for one in network.processes.values() for group in one.groups)]
            meant = suggest(name, known)
            raise click.UsageError(
                f"{network.name} has no process or group '{name}'" + (f"; did you mean '{meant}'?" if meant else "")
            )
        found |= members or {process.name for process in [process] if process}
    return found


def plan(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    from robocomp_yaml.deploy.plan import RESTART, START, STOP
    from robocomp_yaml.deploy.plan import plan as make_plan

    wanted = chosen(opened.network, names)

    async def work() -> None:
        reached = await opened.engine.open(opened.network, create=False)
        found = make_plan(opened.network, await opened.engine.observe() if reached else {}, wanted)
        specs = [step.spec for step in found.of(START, RESTART) if step.spec]
        opened.told += await opened.engine.obstacles(specs, {step.name for step in found.of(STOP, RESTART)})
        await opened.engine.close()
        if opened.format_ == "json":
            end(ctx, opened, {"plan": views.plan_data(found)})
        terminal.say(*views.plan_lines(found, _options.colored(ctx), everything=ctx.obj.verbosity > 0))

    _run(ctx, opened, work())
    end(ctx, opened)


def up(
    ctx: click.Context, opened: Opened, names: tuple[str, ...], forced: Collection[str], on_failure: str,
    timeout: float | None, *, attach: bool = False,
) -> None:  # fmt: skip
    wanted, limit = chosen(opened.network, names), TimeLimit(timeout)
    is_asked = on_failure == "ask" and sys.stdin.isatty() and sys.stdout.isatty() and opened.format_ == "text"
    progress = Progress(opened.format_ == "text" and ctx.obj.verbosity >= 0, _options.colored(ctx), opened.enabled)

    async def choose(result: operations.Result) -> str:
        if not is_asked:
            return operations.STOP_THEM if on_failure == "ask" else on_failure
        progress.pause()
        show(ctx, opened, result.diagnostics)
        return await _options.ask(
            "stop what was started, roll back to what ran before, or keep it as it is?", ("stop", "rollback", "keep")
        )

    async def work() -> operations.Result:
        await opened.engine.open(opened.network, create=True)
        async with attached(ctx, opened, attach) as follow, progress:
            result = await operations.up(
                opened.engine, opened.network, wanted, forced, choose, progress.report,
                keep_going=on_failure == "keep", limit=limit,
            )  # fmt: skip
            opened.told += result.diagnostics
            progress.pause()
            if attach and not result.diagnostics:
                opened.lock.close()  # what has come up may be worked on
                opened.told += await follow()
        if result.diagnostics or attach:
            await operations.end_if_idle(opened.engine)
        else:
            await opened.engine.close()
        return result

    interrupted = "interrupted: all was taken down" if attach else None
    result = _run(ctx, opened, work(), change=True, on_interrupt=interrupted)
    if opened.format_ == "json":
        end(ctx, opened, views.result_data(result))
    if not attach and ctx.obj.verbosity >= 0:
        terminal.say(views.result_text(opened.network, result))
    end(ctx, opened)


def status(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    wanted = chosen(opened.network, names)

    async def work() -> list[operations.Status]:
        reached = await opened.engine.open(opened.network, create=False)
        found = await operations.status(opened.engine, opened.network, wanted, reached)
        await opened.engine.close()
        return found

    found = _run(ctx, opened, work())
    code = 1 if any(one.is_down for one in found) else 0
    if opened.format_ == "json":
        end(ctx, opened, {"processes": views.status_data(opened.network, found)}, code)
    room = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    terminal.say(*views.status_lines(opened.network, found, _options.colored(ctx), room))
    end(ctx, opened, code=code)


def logs(ctx: click.Context, opened: Opened, names: tuple[str, ...], last: int, *, follow: bool, times: bool) -> None:
    wanted = chosen(opened.network, names) or opened.enabled
    shown = views.LogView(wanted, _options.colored(ctx), times)

    async def work() -> None:
        await opened.engine.open(opened.network, create=False)
        lines = await opened.engine.lines([name for name in opened.network.processes if name in wanted], last, follow)
        async for line in lines:
            if opened.format_ == "json":
                terminal.data(views.line_data(line), json=True)
            else:
                terminal.say(shown.text(line))
        await opened.engine.close()

    _run(ctx, opened, work(), on_interrupt="")


def down(ctx: click.Context, opened: Opened, names: tuple[str, ...]) -> None:
    wanted = chosen(opened.network, names)
    progress = Progress(opened.format_ == "text" and ctx.obj.verbosity >= 0, _options.colored(ctx), opened.enabled)

    async def work() -> list[str]:
        if not await opened.engine.open(opened.network, create=False):
            return []
        async with progress:
            return await operations.down(opened.engine, wanted, progress.report)

    stopped = _run(ctx, opened, work(), change=True)
    if opened.format_ == "json":
        end(ctx, opened, {"stopped": stopped})
    if not stopped:
        terminal.say(f"{opened.network.name}: nothing ran")
    end(ctx, opened)


def _run(
    ctx: click.Context, opened: Opened, work: Coroutine[Any, Any, T], *, change: bool = False,
    on_interrupt: str | None = None,
) -> T:  # fmt: skip
    """Carries out what a command does; `change` where only one may at a time. What fails it ends the command, and so
    does Ctrl-C, with a line that says what that means for what runs."""
    try:
        if not change:
            return asyncio.run(work)
        if opened.lock.enter_context(folder.locked(opened.network.folder)):
            return asyncio.run(work)
        reason = "another rcyaml is changing this deployment"
    except DeployFailed as error:
        opened.told += [*opened.engine.notes, error.diagnostic]
        opened.engine.notes = []
        end(ctx, opened)
        raise
    except BrokenPipeError:
        raise  # whoever reads what is printed has had enough
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
    except KeyboardInterrupt as error:
        if on_interrupt is None:
            stop = terminal.typed("rcyaml", "deploy", "down", opened.path)
            on_interrupt = f"interrupted: what runs goes on; `{stop}` stops it"
        if on_interrupt:
            terminal.say(on_interrupt, err=True)
        ctx.exit(_signals.code_of(error))
    finally:
        work.close()
        opened.lock.close()
    where = shown_path(opened.network.folder)
    opened.told.append(deploying.FOLDER.at(Span(opened.network.path), path=where, reason=reason))
    end(ctx, opened)
    raise AssertionError("a command that failed has ended")


def end(ctx: click.Context, opened: Opened, data: dict[str, object] | None = None, code: int = 0) -> None:
    """Tells what is wrong and ends the command: with 1 where one of it is an error."""
    told = [*opened.told, *opened.engine.notes]
    if opened.format_ == "json":
        head: dict[str, object] = {"deployment": opened.network.name, "engine": opened.engine.name, **(data or {})}
        terminal.data(dumps({**head, "diagnostics": [as_data(_placed(opened, one)) for one in told]}), json=True)
    else:
        show(ctx, opened, told)
    ctx.exit(opened.ended_by or (1 if has_errors(told) else code))


def show(ctx: click.Context, opened: Opened, told: Iterable[Diagnostic]) -> None:
    """Prints what was not printed before."""
    new = [_placed(opened, one) for one in told if one not in opened.shown]
    opened.shown += told
    if new:
        blocks = text.each(new, _options.colored(ctx, sys.stderr))
        terminal.say(*[line for block in blocks for line in (terminal.Shown(), *block)][1:], err=True)


def _placed(opened: Opened, told: Diagnostic) -> Diagnostic:
    """Engines know the document by its whole path, which is not how the user named it, and nothing of secrets."""
    if told.span.file == opened.network.path:
        told = replace(told, span=replace(told.span, file=opened.path))
    return opened.analysis.veiled([told])[0]
