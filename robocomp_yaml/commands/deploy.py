"""`rcyaml deploy`: plans, starts, watches and stops a network of components."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._ddsl import DocumentAnd
from robocomp_yaml.commands._duration import Duration
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.deploy.engines import ENGINES

if TYPE_CHECKING:
    from robocomp_yaml.commands._deploying import DeploySession
    from robocomp_yaml.plugins import Plugins


class _Since(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A time, or a duration before now; in UTC as logs have it."""

    name = "time"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        from datetime import UTC, datetime, timedelta

        from robocomp_yaml.model.duration import duration

        if not value:
            return ""
        now = datetime.now(UTC)
        if seconds := duration(value):
            when = now - timedelta(seconds=seconds)
        else:
            is_time = "-" not in value[:5]
            try:
                when = datetime.fromisoformat(f"{now.astimezone():%Y-%m-%d}T{value}" if is_time else value)
            except ValueError:
                self.fail(f"'{value}' is neither a duration, such as 5min, nor a time, such as 10:30", param, ctx)
        return f"{when.astimezone(UTC):%Y-%m-%dT%H:%M:%S}.{when.microsecond // 1000:03}Z"


_names = click.argument("names", cls=DocumentAnd, metavar="[NAME]...")
_nothing = click.argument("nothing", cls=DocumentAnd, limit=0, expose_value=False)
_engine = click.option("--engine", type=click.Choice([*ENGINES]),
                       help="The engine: local for one machine, icegrid for several.")  # fmt: skip
_timeout = click.option("--timeout", type=Duration(), metavar="TIME",
                        help="The longest total duration: 30s, 2min.")  # fmt: skip


def _on_failure(text: str) -> Callable[[Any], Any]:
    choice = click.Choice(["ask", "stop", "rollback", "keep"])
    return click.option("--on-failure", type=choice, default="ask", help=text)


def _exports(plugins: Plugins) -> list[str]:
    from robocomp_yaml.emit.exports import forms

    return forms(plugins)


@click.group(cls=CommandGroup, short_help="Run a network of components: plan, up, status, logs, down.")
def command() -> None:
    """Deploy the network that a document (NAME.ddsl.yaml) describes.

    DDSL is the document, or a folder with one; by default, the only one below this folder. NAMEs are its processes or
    groups.
    """


def _subcommand(
    short_help: str, *options: Callable[[Any], Any], lenient: bool = False
) -> Callable[[Callable[..., None]], click.Command]:
    """A command about a deployment. Its function gets the session, and the values of its own options."""

    def decorate(function: Callable[..., None]) -> click.Command:
        @wraps(function)
        def run(ddsl: str, include: tuple[str, ...], format_: str, engine: str | None = None, **own: Any) -> None:
            from robocomp_yaml.commands._deploying import open_session

            ctx = click.get_current_context()
            function(open_session(ctx, ddsl, include, format_, engine, lenient=lenient), **own)

        of_all = (_options.text_or_json, _options.include)
        return command.command(short_help=short_help)(_options.together(*of_all, *options)(run))

    return decorate


@_subcommand("Print what up would do, and why.", _names, _engine)
def plan(session: DeploySession, names: tuple[str, ...]) -> None:
    """Print what `up` would start, stop, restart and change, field by field, compared to what is running. Nothing is
    changed."""
    session.plan(names)


@_subcommand("Start the network, and apply changes to it.", _names, _engine)
@_on_failure("What happens to the started processes if one fails; ask: on a terminal, else stop.")
@_timeout
@click.option("--build", is_flag=True, help="First build the components that are not up to date.")
@click.option("--attach", is_flag=True, help="Print the logs until Ctrl-C, then stop the processes.")
def up(
    session: DeploySession, names: tuple[str, ...], on_failure: str, timeout: float | None, build: bool, attach: bool
) -> None:
    """Start the network: start each process when all that it depends on is ready, restart what changed, stop what is no
    longer in the network. NAMEs limit it to some processes, with all that they depend on."""
    if build:
        session.build(names)
    session.up(names, on_failure, timeout, attach=attach)


@_subcommand("Show the state of the processes.", _names, _engine, lenient=True)
def status(session: DeploySession, names: tuple[str, ...]) -> None:
    """Show each process: its state, whether it is ready, its host, its uptime, and what it serves. The exit code is 1
    if a process that should run is not running."""
    session.status(names)


@command.command(name="ls", short_help="List the running deployments of this user.")
@_options.text_or_json
def list_(format_: str) -> None:
    """List the deployments that this user has started and not taken down, wherever their documents are. `status`,
    `logs` and `down` accept the names of this list instead of a document."""
    from robocomp_yaml.commands._listing import list_running

    list_running(click.get_current_context(), format_)


@_subcommand("Print the logs of the processes, merged.", _names, _engine, lenient=True)
@click.option("-f", "--follow", is_flag=True, help="Also print new lines, until Ctrl-C.")
@click.option("-n", "--lines", "last", type=click.IntRange(min=0),
              help="Last lines of each; default: 20, with --since all.")  # fmt: skip
@click.option("--since", type=_Since(), default="", help="Only lines since a time, or a duration ago: 10:30, 5min.")
@click.option("--grep", "pattern", metavar="REGEX", default="", help="Only lines that match a regular expression.")
@click.option("-t", "--times", is_flag=True, help="Print the time of each line.")
def logs(
    session: DeploySession,
    names: tuple[str, ...],
    last: int | None,
    since: str,
    pattern: str,
    follow: bool,
    times: bool,
) -> None:
    """Print the last lines of the logs of the processes, in the order in which they were written. A time is that of
    this machine, unless it has an offset, such as Z for UTC; a time without a date is of today."""
    last = 20 if last is None and not since else last
    session.logs(names, last, follow=follow, times=times, since=since, pattern=pattern)


@_subcommand("Stop processes, and start them again.", _names, _engine)
@_on_failure("What happens to the restarted processes if one fails.")
@_timeout
@click.option("--dry-run", is_flag=True, help="Print what would be restarted, and why.")
def restart(
    session: DeploySession, names: tuple[str, ...], on_failure: str, timeout: float | None, dry_run: bool
) -> None:  # fmt: skip
    """Restart the processes NAME (by default, all), as the document describes them now."""
    if dry_run:
        session.plan(names, restart=True)
    session.up(names, on_failure, timeout, restart=True)


@_subcommand("Go back to the last up that was all ready.", _engine, lenient=True)
@_nothing
@_on_failure("What happens to the restarted processes if one fails.")
@_timeout
def rollback(session: DeploySession, on_failure: str, timeout: float | None) -> None:
    """Go back to what ran after the last `up` that was all ready, and that differs from what runs now. The document is
    not changed: the next `up` applies it again. Programs that were rebuilt stay rebuilt."""
    session.rollback(on_failure, timeout)


@_subcommand("Stop the processes, in reverse order.", _names, _engine, lenient=True)
@click.option("--dry-run", is_flag=True, help="Print what would be stopped, and why.")
def down(session: DeploySession, names: tuple[str, ...], dry_run: bool) -> None:
    """Stop all running processes of the network, or the processes NAME with all that depend on them. A process is
    stopped before those that it depends on."""
    session.down(names, dry_run=dry_run)


@_subcommand("Bring the files of the network to its other hosts.", _names)
@click.option("--dry-run", is_flag=True, help="Print what would be sent and deleted.")
def push(session: DeploySession, names: tuple[str, ...], dry_run: bool) -> None:
    """Bring to each other host what its processes need: programs, code, run time and Slice, with rsync over ssh. Files
    that an earlier push brought, and that nothing needs any more, are deleted; all other files there stay. NAMEs are
    hosts, processes or groups."""
    from robocomp_yaml.commands import _pushing

    _pushing.push(session, names, dry_run=dry_run)


@_subcommand("Let systemd start the network at boot.", _engine)
@_nothing
@click.option("--user", "manager", flag_value="user", help="Units of the users, whatever the hosts say.")
@click.option("--system", "manager", flag_value="system", help="Units of the machines: root, or sudo.")
@click.option("--print", "prints", is_flag=True, help="Only print the units.")
@click.option("--dry-run", is_flag=True, help="Only print which units would be written.")
def install(session: DeploySession, manager: str | None, prints: bool, dry_run: bool) -> None:
    """Write units for systemd on all hosts, so that the network comes up when they boot. Without --user and --system,
    `systemd:` of each host says whose units. The network is started now, if systemd can be reached."""
    from robocomp_yaml.commands import _installing

    _installing.install(session, manager or "", prints=prints, dry_run=dry_run)


@_subcommand("Remove what install has written.", _nothing, lenient=True)
def uninstall(session: DeploySession) -> None:
    """Take the network down, and remove the units on all hosts."""
    from robocomp_yaml.commands import _installing

    _installing.uninstall(session)


@_subcommand(
    "Show which programs of the network a host has.",
    click.argument("host", cls=DocumentAnd, limit=1, metavar="[HOST]"),
    lenient=True,
)
def probe(session: DeploySession, host: tuple[str, ...]) -> None:
    """Show which programs of the network HOST has (by default, all hosts), in which version, and which of the required
    libraries are missing."""
    session.probe(*host)


@_subcommand("Write the network in the format of another tool.", _nothing)
@click.option("--as", "form", required=True, type=PluginChoice(_exports), help="The tool.")
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write the files below DIR.")
def export(session: DeploySession, form: str, output: str | None) -> None:
    """Print the files with which IceGrid, RCManager, systemd or docker compose run the network, or those of a plug-in
    of the workspace; or write them."""
    session.export(form, output)
