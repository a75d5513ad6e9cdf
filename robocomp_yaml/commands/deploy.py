"""`rcyaml deploy`: a network of components, planned, brought up, watched and taken down."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import Group
from robocomp_yaml.commands._deployment_argument import DocumentAnd
from robocomp_yaml.commands._plugged import Plugged
from robocomp_yaml.deploy.engines import ENGINES

if TYPE_CHECKING:
    from robocomp_yaml.plugins import Plugins

_FORMATS = click.Choice(["text", "json"])


def _shared(function: Callable[..., Any]) -> Callable[..., Any]:
    """What all of them take: how to read and tell."""
    format_ = click.option("--format", "format_", type=_FORMATS, default="text", help="How to print it.")
    return format_(_options.include(function))


engine = click.option("--engine", type=click.Choice([*ENGINES]),
                      help="What runs it; local on one machine, icegrid on several.")  # fmt: skip
names = click.argument("names", cls=DocumentAnd, metavar="[NAME]...")


class _Duration(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A length of time with its unit, as in documents."""

    name = "time"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        from robocomp_yaml.model.build_component import duration

        seconds = value if isinstance(value, float) else duration(value)
        if not seconds:
            self.fail(f"'{value}' is no length of time, such as 30s or 2min", param, ctx)
        return seconds


timeout = click.option("--timeout", type=_Duration(), metavar="TIME",
                       help="How long it may take, all in all: 30s, 2min.")  # fmt: skip


def _exports(plugins: Plugins) -> list[str]:
    from robocomp_yaml.emit.exports import forms

    return forms(plugins)


@click.group(cls=Group, short_help="A network of components: plan, up, status, logs, down.")
def command() -> None:
    """Deploy the network that a document (NAME.ddsl.yaml) describes.

    DDSL is the document, or a folder with one; by default, the only one below this folder. NAMEs are processes or
    groups of it.
    """


@command.command(short_help="What up would do, and why.")
@_shared
@names
@engine
@click.pass_context
def plan(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, include: tuple[str, ...],
         format_: str) -> None:  # fmt: skip
    """Say what `up` would start, stop, restart and change, field by field, against what runs now. Nothing is done."""
    from robocomp_yaml.commands import _deploying

    _deploying.plan(ctx, _deploying.open_(ctx, ddsl, include, format_, engine), names)


@command.command(short_help="Bring it about; what is as it should be is not touched.")
@_shared
@names
@engine
@click.option(
    "--on-failure",
    type=click.Choice(["ask", "stop", "rollback", "keep"]),
    default="ask",
    help="What becomes of what was started when a process fails; asked on a terminal, else stop.",
)
@timeout
@click.option("--build", is_flag=True, help="Build first what is not built, or is older than what it is made of.")
@click.option("--attach", is_flag=True, help="Stay, show what they print, and take them down at the end.")
@click.pass_context
def up(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, on_failure: str,
       timeout: float | None, build: bool, attach: bool, include: tuple[str, ...], format_: str) -> None:  # fmt: skip
    """Bring the network about: start each process when all that it needs are ready, restart what changed, stop what is
    no longer part of it. NAMEs limit it to some, with all that they need."""
    from robocomp_yaml.commands import _deploying

    opened = _deploying.open_(ctx, ddsl, include, format_, engine)
    if build:
        _deploying.build(ctx, opened, names)
    _deploying.up(ctx, opened, names, on_failure, timeout, attach=attach)


@command.command(short_help="How the processes are.")
@_shared
@names
@engine
@click.pass_context
def status(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, include: tuple[str, ...],
           format_: str) -> None:  # fmt: skip
    """Show each process: its state, whether it is ready now, where it runs, for how long, and what it serves. The exit
    code is 1 where one that should run does not."""
    from robocomp_yaml.commands import _deploying

    _deploying.status(ctx, _deploying.open_(ctx, ddsl, include, format_, engine, lenient=True), names)


@command.command(short_help="What the processes print, merged.")
@_shared
@names
@engine
@click.option("-f", "--follow", is_flag=True, help="Go on with what comes, until Ctrl-C.")
@click.option("-n", "--lines", "last", type=click.IntRange(min=0), default=20, help="The last lines of each; 20.")
@click.option("-t", "--times", is_flag=True, help="With the time of each line.")
@click.pass_context
def logs(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, follow: bool, last: int,
         times: bool, include: tuple[str, ...], format_: str) -> None:  # fmt: skip
    """Print the last lines of the processes' logs, in the order in which they were written."""
    from robocomp_yaml.commands import _deploying

    opened = _deploying.open_(ctx, ddsl, include, format_, engine, lenient=True)
    _deploying.logs(ctx, opened, names, last, follow=follow, times=times)


@command.command(short_help="Stop and start processes again.")
@_shared
@names
@engine
@click.option(
    "--on-failure",
    type=click.Choice(["ask", "stop", "rollback", "keep"]),
    default="ask",
    help="What becomes of those that were restarted when one fails.",
)
@timeout
@click.pass_context
def restart(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, on_failure: str,
            timeout: float | None, include: tuple[str, ...], format_: str) -> None:  # fmt: skip
    """Restart the processes NAME (without: all), as the document describes them now."""
    from robocomp_yaml.commands import _deploying

    opened = _deploying.open_(ctx, ddsl, include, format_, engine)
    _deploying.up(ctx, opened, names, on_failure, timeout, restart=True)


@command.command(short_help="Take it down, in reverse order.")
@_shared
@names
@engine
@click.pass_context
def down(ctx: click.Context, ddsl: str, names: tuple[str, ...], engine: str | None, include: tuple[str, ...],
         format_: str) -> None:  # fmt: skip
    """Stop everything that runs of the network, or the processes NAME with all that need them; those first that need
    others."""
    from robocomp_yaml.commands import _deploying

    _deploying.down(ctx, _deploying.open_(ctx, ddsl, include, format_, engine, lenient=True), names)


@command.command(short_help="Which known components a host has.")
@_shared
@click.argument("host", cls=DocumentAnd, most=1, metavar="[HOST]")
@click.pass_context
def probe(ctx: click.Context, ddsl: str, host: tuple[str, ...], include: tuple[str, ...], format_: str) -> None:
    """Say which of the network's programs HOST has (without: all its hosts), in which version, and which of the
    libraries that they need are missing there."""
    from robocomp_yaml.commands import _deploying, _probing

    _probing.tell(ctx, _deploying.open_(ctx, ddsl, include, format_, None, lenient=True), *host)


@command.command(short_help="The network in the words of other tools.")
@_shared
@click.argument("nothing", cls=DocumentAnd, most=0, expose_value=False)
@click.option("--as", "form", required=True, type=Plugged(_exports), help="Which tool.")
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR, not to standard output."
)
@click.pass_context
def export(ctx: click.Context, ddsl: str, form: str, output: str | None, include: tuple[str, ...],
           format_: str) -> None:  # fmt: skip
    """Print the files from which IceGrid, RCManager, systemd or docker compose run the network, or what a plug-in of
    the workspace makes of it; or write them."""
    from robocomp_yaml.commands import _deploying, _exporting

    _exporting.export(ctx, _deploying.open_(ctx, ddsl, include, format_, None), form, output)
