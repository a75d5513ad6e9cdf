"""`rcyaml param`: the parameters of a running component."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial, wraps
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options, _talking
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._duration import Duration
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.api.listed_values import RunningValue
    from robocomp_yaml.api.running_parameters import RunningParameters, Session


def _names(addresses: Addresses, incomplete: str) -> list[str]:
    from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
    from robocomp_yaml.diag.errors import Refused

    names = []
    for name in addresses.names():
        with suppress(Refused):  # several components of a name
            names += [name for one in addresses.peer(name).doors if one.name == COMMON_BEHAVIOR]
    return names


def _complete_path(ctx: click.Context, param: click.Parameter, incomplete: str) -> Any:
    """The paths of the parameters that the documents define."""

    def known(addresses: Addresses, incomplete: str) -> list[str]:
        from robocomp_yaml.api.running_parameters import RunningParameters
        from robocomp_yaml.parameters.types import leaves

        root = RunningParameters(addresses, ctx.params.get("name") or "").root
        return [path for path, _ in leaves(root)] if root is not None else []

    return _talking.completing(known)(ctx, param, incomplete)


def _complete_value(ctx: click.Context, param: click.Parameter, incomplete: str) -> Any:
    """The values that a parameter may have, if they can be listed."""

    def known(addresses: Addresses, incomplete: str) -> list[str]:
        from robocomp_yaml.api.completing.values import member_at, values_of
        from robocomp_yaml.api.running_parameters import RunningParameters

        root = RunningParameters(addresses, ctx.params.get("name") or "").root
        member = member_at(root, [ctx.params.get("path") or ""]) if root is not None else None
        return list(dict.fromkeys(one.text for one in values_of(member))) if member is not None else []

    return _talking.completing(known)(ctx, param, incomplete)


_name = click.argument("name", metavar="COMPONENT", shell_complete=_talking.completing(_names))
_path = click.argument("path", shell_complete=_complete_path)


def _running(function: Callable[..., None]) -> Callable[..., None]:
    """The options of all these commands, of which the function gets the parameters and a connection."""

    @wraps(function)
    def run(
        name: str, deployment: str | None, include: tuple[str, ...], timeout: float, ice_config: str | None, **own: Any
    ) -> None:
        from robocomp_yaml.api.addresses import Addresses
        from robocomp_yaml.api.running_parameters import RunningParameters

        parameters = RunningParameters(Addresses(deployment or "", include), name)
        with parameters.connected(ice_config or "", timeout) as session:
            function(parameters, session, **own)

    options = (_talking.deployment, _talking.timeout, _talking.ice_config, _options.include, _options.text_or_json)
    return _options.together(*options)(run)


@click.group(cls=CommandGroup, short_help="Parameters of a running component: list, get, set, watch.")
def command() -> None:
    """Show and change the parameters of a running component. `rcyaml config` does this for its documents.

    COMPONENT is an entry of the deployment, a component of this workspace, or the HOST:PORT of its CommonBehavior.
    """


@command.command("list", short_help="Print all values of a running component.")
@_name
@_running
def list_(parameters: RunningParameters, session: Session, format_: str) -> None:
    """Print all values that a running COMPONENT has now. Secrets are hidden."""
    rows = session.values()
    if format_ == "json":
        terminal.data(_talking.as_json({"parameters": [_as_data(row) for row in rows]}, line=False), json=True)
        return
    width = max((min(len(_assignment(row)), 50) for row in rows), default=0)
    for row in rows:
        about = [word for word in (row.type, "editable" if row.editable else "") if word]
        terminal.say(f"{_assignment(row):<{width}}  # {', '.join(about)}")


@command.command(short_help="Print one value of a running component.")
@_name
@_path
@_running
@click.pass_context
def get(ctx: click.Context, parameters: RunningParameters, session: Session, path: str, format_: str) -> None:
    """Print the value that a running COMPONENT has now at PATH, such as motors[0].vel. A secret is hidden."""

    _options.print_value(ctx, format_, path, session.get(path), partial(_talking.as_json, line=False))


@command.command("set", short_help="Change one value of a running component, for now.",
                 context_settings={"ignore_unknown_options": True})  # fmt: skip
@_name
@_path
@click.argument("value", shell_complete=_complete_value)
@click.option("--save", is_flag=True, help="Also write it to the values document, for the next start.")
@_running
@click.pass_context
def set_(
    ctx: click.Context, parameters: RunningParameters, session: Session, path: str, value: str, save: bool, format_: str
) -> None:  # fmt: skip
    """Set the parameter at PATH to VALUE in a running COMPONENT, if its type and limits accept it: until the component
    ends. With --save also in the values document with which it starts; comments and layout of the document stay."""
    from robocomp_yaml.api.listed_values import in_line
    from robocomp_yaml.diag.errors import Refused

    change = parameters.saving(path, value) if save else None
    before, now = session.set(path, value)
    if change is not None:
        try:
            change.apply()
        except Refused as error:
            raise Refused(f"{parameters.name} has {path} = {in_line(now)} until it ends, but {error}") from None
    saved = change.file if change is not None else None
    if format_ == "json":
        terminal.data(
            _talking.as_json({"path": path, "value": now, "was": before, "saved": saved}, line=False), json=True
        )
    elif ctx.obj.verbosity >= 0:
        was = "" if before is None else f" (was {in_line(before)})"
        until = f"also in {saved}" if saved else "for now: the next start does not have it, unless --save writes it"
        terminal.say(f"{parameters.name}: {path} = {in_line(now)}{was}; {until}")


@command.command(short_help="Print changes of values as they happen.")
@_name
@click.argument("paths", nargs=-1, metavar="[PATH]...", shell_complete=_complete_path)
@click.option("--every", type=Duration(), default="1s", show_default=True, metavar="TIME", help="How often to ask.")
@_talking.ending
@_running
def watch(
    parameters: RunningParameters, session: Session, paths: tuple[str, ...], every: float, duration: float | None,
    format_: str,
) -> None:  # fmt: skip
    """Print the values of a running COMPONENT, and then each change, until Ctrl-C. PATHs are parameters or groups."""
    from robocomp_yaml.api.listed_values import in_line

    for path in paths:
        session.get(path)  # unknown ones are reported
    known: dict[str, Any] = {}
    end = time.monotonic() + duration if duration else None
    for _ in _talking.times(None, every):
        now = {row.path: row.data for row in session.values() if not paths or _is_in(row.path, paths)}
        for path in [*now, *(known.keys() - now.keys())]:
            if path in known and known[path] == now.get(path):
                continue
            value = now.get(path)
            if format_ == "json":
                row = {"time": time.time(), "path": path, "value": value, "was": known.get(path)}
                terminal.data(_talking.as_json(row), json=True)
            else:
                was = f" (was {in_line(known[path])})" if path in known else ""
                terminal.say(f"{time.strftime('%H:%M:%S')} {path} = {in_line(value)}{was}")
        known = now
        if end is not None and time.monotonic() + every > end:
            return


def _is_in(path: str, paths: tuple[str, ...]) -> bool:
    return any(path == one or path.startswith((f"{one}.", f"{one}[")) for one in paths)


def _assignment(row: RunningValue) -> str:
    from robocomp_yaml.api.listed_values import in_line

    return f"{row.path} = {in_line(row.data)}" + (f" {row.unit}" if row.unit else "")


def _as_data(row: RunningValue) -> dict[str, Any]:
    return {"path": row.path, "value": row.data, "type": row.type, "unit": row.unit, "editable": row.editable}
