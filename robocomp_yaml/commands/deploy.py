"""`rcyaml deploy`: a network of components, planned, brought up, watched and taken down."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.deploy.engines import ENGINES
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.commands._deploying import Session
    from robocomp_yaml.plugins import Plugins


class _DocumentAnd(click.Argument):
    """`[DDSL]` and the words behind it, as the parameters `ddsl` and this one. A first word that is neither a document
    nor a folder with one is a word already, about the only deployment below this folder."""

    def __init__(self, declarations: list[str], most: int | None = None, metavar: str = "", **more: Any) -> None:
        self._most = most
        super().__init__(declarations, nargs=-1, type=click.Path(), metavar=f"[DDSL] {metavar}".rstrip(), **more)

    def process_value(self, ctx: click.Context, value: object) -> tuple[str, ...]:
        words: tuple[str, ...] = super().process_value(ctx, value) or ()
        ctx.params["ddsl"], rest = self._split(ctx, words)
        if self._most is not None and len(rest) > self._most:
            extra = rest[self._most :]
            raise click.UsageError(f"Got unexpected extra argument{'s' * (len(extra) > 1)} ({' '.join(extra)})", ctx)
        return rest

    def _split(self, ctx: click.Context, words: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
        if not words:
            return ".", ()
        first = words[0]
        if os.path.isdir(first):
            is_document = bool(of_kind(first, "ddsl")) or not of_kind(".", "ddsl")
        else:
            is_document = os.path.exists(first)
        if is_document:
            return first, words[1:]
        is_path = "/" in first or first.endswith((".yaml", ".yml"))
        if self._most == 0 or is_path or not of_kind(".", "ddsl"):
            raise click.BadParameter(f"Path '{first}' does not exist.", ctx, self, "'[DDSL]'")
        return ".", words


class _Duration(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A length of time with its unit, as in documents."""

    name = "time"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        from robocomp_yaml.model.build_component import duration

        seconds = value if isinstance(value, float) else duration(value)
        if not seconds:
            self.fail(f"'{value}' is no length of time, such as 30s or 2min", param, ctx)
        return seconds


_names = click.argument("names", cls=_DocumentAnd, metavar="[NAME]...")
_engine = click.option("--engine", type=click.Choice([*ENGINES]),
                       help="What runs it; local on one machine, icegrid on several.")  # fmt: skip
_timeout = click.option("--timeout", type=_Duration(), metavar="TIME",
                        help="How long it may take, all in all: 30s, 2min.")  # fmt: skip


def _on_failure(text: str) -> Callable[[Any], Any]:
    choice = click.Choice(["ask", "stop", "rollback", "keep"])
    return click.option("--on-failure", type=choice, default="ask", help=text)


def _exports(plugins: Plugins) -> list[str]:
    from robocomp_yaml.emit.exports import forms

    return forms(plugins)


@click.group(cls=CommandGroup, short_help="A network of components: plan, up, status, logs, down.")
def command() -> None:
    """Deploy the network that a document (NAME.ddsl.yaml) describes.

    DDSL is the document, or a folder with one; by default, the only one below this folder. NAMEs are processes or
    groups of it.
    """


def _subcommand(
    short_help: str, *options: Callable[[Any], Any], lenient: bool = False
) -> Callable[[Callable[..., None]], click.Command]:
    """A command on one deployment: its function gets the session, and the values of its own options."""

    def decorate(function: Callable[..., None]) -> click.Command:
        @wraps(function)
        def run(ddsl: str, include: tuple[str, ...], format_: str, engine: str | None = None, **own: Any) -> None:
            from robocomp_yaml.commands._deploying import open_session

            ctx = click.get_current_context()
            function(open_session(ctx, ddsl, include, format_, engine, lenient=lenient), **own)

        for option in (*reversed(options), _options.include, _options.text_or_json):
            run = option(run)
        return command.command(short_help=short_help)(run)

    return decorate


@_subcommand("What up would do, and why.", _names, _engine)
def plan(session: Session, names: tuple[str, ...]) -> None:
    """Say what `up` would start, stop, restart and change, field by field, against what runs now. Nothing is done."""
    session.plan(names)


@_subcommand("Bring it about; what is as it should be is not touched.", _names, _engine)
@_on_failure("What becomes of what was started when a process fails; asked on a terminal, else stop.")
@_timeout
@click.option("--build", is_flag=True, help="Build first what is not built, or is older than what it is made of.")
@click.option("--attach", is_flag=True, help="Stay, show what they print, and take them down at the end.")
def up(
    session: Session, names: tuple[str, ...], on_failure: str, timeout: float | None, build: bool, attach: bool
) -> None:
    """Bring the network about: start each process when all that it needs are ready, restart what changed, stop what is
    no longer part of it. NAMEs limit it to some, with all that they need."""
    if build:
        session.build(names)
    session.up(names, on_failure, timeout, attach=attach)


@_subcommand("How the processes are.", _names, _engine, lenient=True)
def status(session: Session, names: tuple[str, ...]) -> None:
    """Show each process: its state, whether it is ready now, where it runs, for how long, and what it serves. The exit
    code is 1 where one that should run does not."""
    session.status(names)


@_subcommand("What the processes print, merged.", _names, _engine, lenient=True)
@click.option("-f", "--follow", is_flag=True, help="Go on with what comes, until Ctrl-C.")
@click.option("-n", "--lines", "last", type=click.IntRange(min=0), default=20, help="The last lines of each; 20.")
@click.option("-t", "--times", is_flag=True, help="With the time of each line.")
def logs(session: Session, names: tuple[str, ...], last: int, follow: bool, times: bool) -> None:
    """Print the last lines of the processes' logs, in the order in which they were written."""
    session.logs(names, last, follow=follow, times=times)


@_subcommand("Stop and start processes again.", _names, _engine)
@_on_failure("What becomes of those that were restarted when one fails.")
@_timeout
def restart(session: Session, names: tuple[str, ...], on_failure: str, timeout: float | None) -> None:
    """Restart the processes NAME (without: all), as the document describes them now."""
    session.up(names, on_failure, timeout, restart=True)


@_subcommand("Take it down, in reverse order.", _names, _engine, lenient=True)
def down(session: Session, names: tuple[str, ...]) -> None:
    """Stop everything that runs of the network, or the processes NAME with all that need them; those first that need
    others."""
    session.down(names)


@_subcommand(
    "Which known components a host has.",
    click.argument("host", cls=_DocumentAnd, most=1, metavar="[HOST]"),
    lenient=True,
)
def probe(session: Session, host: tuple[str, ...]) -> None:
    """Say which of the network's programs HOST has (without: all its hosts), in which version, and which of the
    libraries that they need are missing there."""
    session.probe(*host)


@_subcommand(
    "The network in the words of other tools.",
    click.argument("nothing", cls=_DocumentAnd, most=0, expose_value=False),
)
@click.option("--as", "form", required=True, type=PluginChoice(_exports), help="Which tool.")
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR, not to standard output."
)
def export(session: Session, form: str, output: str | None) -> None:
    """Print the files from which IceGrid, RCManager, systemd or docker compose run the network, or what a plug-in of
    the workspace makes of it; or write them."""
    session.export(form, output)
