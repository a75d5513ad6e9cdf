"""`rcyaml run`: one component in the foreground."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options, _talking
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.source.discover import kind_of

if TYPE_CHECKING:
    from robocomp_yaml.api.running import Run
    from robocomp_yaml.deploy.carry_out import ProcessEvent
    from robocomp_yaml.deploy.single import SingleResult
    from robocomp_yaml.diag.diagnostic import Diagnostic


class _RunCommand(LibraryCommand):
    """What follows `--` is for the program, also if NAME is omitted."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        own = args.index("--") if "--" in args else len(args)
        ctx.meta[_ARGUMENTS] = tuple(args[own + 1 :])
        return super().parse_args(ctx, args[:own])

    def collect_usage_pieces(self, ctx: click.Context) -> list[str]:
        return [*super().collect_usage_pieces(ctx), "[-- ARGUMENT...]"]


_ARGUMENTS = "robocomp_yaml.run.arguments"


@click.command(cls=_RunCommand, short_help="Run one component in the foreground, with what it needs.")
@click.argument("words", nargs=-1, metavar="[NAME]")
@click.option("--with-needed", is_flag=True, help="Start what it needs beside it, and stop that at the end.")
@click.option("--deployment", metavar="DDSL", type=_talking.DeploymentName(),
              help="The deployment: its document, or its name; by default, the one that has it.")  # fmt: skip
@click.option("--alone", is_flag=True, help="With its own configuration, whether or not a deployment has it.")
@click.option(
    "--set", "settings", multiple=True, metavar="NAME=VALUE", help="A parameter for this run; may be repeated."
)
@click.option("--config", metavar="FILE", type=click.Path(exists=True, dir_okay=False),
              help="A configuration for this run, as `config:` of the entry.")  # fmt: skip
@click.option("--build", is_flag=True, help="First build what is not up to date.")
@click.option("--dry-run", is_flag=True, help="Print the command and the configuration, and start nothing.")
@_options.reading
def command(
    ctx: click.Context, words: tuple[str, ...], with_needed: bool, deployment: str | None, alone: bool,
    settings: tuple[str, ...], config: str | None, build: bool, dry_run: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Run NAME in the foreground, as `deploy up` would run it: an entry of a deployment, or a component by its name or
    folder (by default, this one). A component that no deployment has runs with its own configuration.

    Its output goes to the terminal, and its exit code is that of the command. Ctrl-C ends it (exit code 130); a second
    Ctrl-C kills it. ARGUMENTs after `--` are passed to the program. With --format json, how it ended is printed after
    its output.
    """
    from robocomp_yaml.api.running import Run
    from robocomp_yaml.diag.errors import Faulty
    from robocomp_yaml.diag.render.json import dumps

    name, deployment = _name(words, deployment or "")
    if alone and deployment:
        raise click.UsageError("--alone and --deployment exclude each other")
    run = Run(
        name, deployment=deployment, include=include, alone=alone, with_needed=with_needed,
        settings=_options.pairs(settings, "NAME=VALUE, such as period.compute=50", can_be_empty=True),
        config=config or "", arguments=ctx.meta[_ARGUMENTS],
    )  # fmt: skip
    if dry_run:
        _describe(ctx, run, format_)
        return
    if build:
        _build(ctx, run)
    if ctx.obj.verbosity >= 0:
        how = f"as in {run.document}" if run.document else "with its own configuration"
        _say(f"{run.process.name}: {_shown(run.process.command[0])}, {how}")
    result = None
    shown: list[Diagnostic] = []

    def show(pid: int = 0) -> None:
        if format_ == "text":
            _show(ctx, run.diagnostics[len(shown) :])
            shown[:] = run.diagnostics

    with contextlib.suppress(Faulty):
        result = run.start(lambda event: _report(ctx, event), on_start=show)
    code = _code(run, result)
    if format_ == "json":
        terminal.data(dumps({"name": run.process.name, "code": code, **_as_data(run.diagnostics)}), json=True)
    show()
    ctx.exit(code)


def _as_data(diagnostics: Sequence[Diagnostic]) -> dict[str, Any]:
    from robocomp_yaml.diag.render.json import as_data

    return {"diagnostics": [as_data(one) for one in diagnostics]}


def _name(words: tuple[str, ...], deployment: str) -> tuple[str, str]:
    """The name of what runs, and the deployment, which can also precede the name, as in `rcyaml deploy`."""
    if len(words) == 2 and kind_of(words[0]) == "ddsl" and not deployment:
        return words[1], words[0]
    if len(words) == 1 and kind_of(words[0]) == "ddsl":
        command = terminal.typed("rcyaml", "run", words[0])
        raise click.UsageError(f"{words[0]} is a deployment: which of its entries? `{command} NAME`")
    if len(words) > 1:
        raise click.UsageError(f"'{words[1]}' is unexpected: arguments of the program follow `--`")
    return (words[0] if words else "."), deployment


def _shown(program: str) -> str:
    """A program as in a command that is typed here."""
    return os.path.relpath(program) if os.path.isabs(program) else program


def _describe(ctx: click.Context, run: Run, format_: str) -> None:
    """Prints what a run would start."""
    from robocomp_yaml.diag.render.json import dumps

    one = run.description()
    if format_ == "json":
        terminal.data(dumps(one), json=True)
        return
    shown = {**one, "command": terminal.typed(*one["command"])}
    lines = [f"{title:<8} {shown[key]}" for title, key in _TITLES.items() if shown[key]]
    lines += [f"env      {name}={value}" for name, value in one["environment"].items()]
    lines += [f"needs    {', '.join(one['needed'])}"] if one["needed"] else []
    terminal.say(*lines, *(["", *one["configuration"].rstrip().splitlines()] if one["configuration"] else []))


_TITLES = {"name": "name", "as in": "deployment", "command": "command", "folder": "folder"}


def _build(ctx: click.Context, run: Run) -> None:
    """Ends the command if a component cannot be built."""
    from robocomp_yaml.commands import build

    built = build.run(ctx, "text", run.build, "interrupted: nothing was started; what was built stays")
    if any(one.has_errors for one in built):
        ctx.exit(1)


def _report(ctx: click.Context, event: ProcessEvent) -> None:
    from robocomp_yaml.deploy.carry_out import STARTING, STOPPING

    if ctx.obj.verbosity >= 0 and event.kind not in (STARTING, STOPPING):
        _say(f"{event.name}: {event.kind}")


def _code(run: Run, result: SingleResult | None) -> int:
    """The exit code of the command, and a line about an end that the component did not choose."""
    from robocomp_yaml.diag.diagnostic import has_errors

    if result is None:
        return 1
    if result.interrupted_by:
        return 128 + result.interrupted_by
    if result.code is None or has_errors(run.diagnostics):
        return 1
    if result.code < 0:
        _say(f"{run.process.name}: ended by {signal.Signals(-result.code).name}")
        return 128 - result.code
    if result.code:
        _say(f"{run.process.name}: ended with exit code {result.code}")
    return result.code


def _show(ctx: click.Context, diagnostics: Sequence[Diagnostic]) -> None:
    from robocomp_yaml.diag.render import text

    for block in text.each(diagnostics, _options.colored(ctx, sys.stderr)):
        terminal.say(*block, err=True)


def _say(line: str) -> None:

    terminal.say(line, err=True)
