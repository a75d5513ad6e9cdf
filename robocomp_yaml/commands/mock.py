"""`rcyaml mock`: stand-ins for interfaces and topics."""

from __future__ import annotations

import itertools
import os
import threading
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.source.discover import kind_of

if TYPE_CHECKING:
    from robocomp_yaml.api.mocking import Mock
    from robocomp_yaml.wire.stand_ins import Call, Serving


@click.command(cls=LibraryCommand, short_help="Serve interfaces and publish topics in place of components.")
@click.argument("interfaces", nargs=-1, metavar="[INTERFACE]...")
@click.option("--script", type=click.Path(dir_okay=False, exists=True), help="What they answer and publish, in YAML.")
@click.option("--endpoint", "endpoints", multiple=True, metavar="NAME=ENDPOINT", help="Where an interface is served.")
@click.option(
    "--storm",
    default="",
    metavar="PROXY",
    help="IceStorm's topic manager; by default, at port 9999.",
)
@click.option("--check", is_flag=True, help="Check the script, and serve nothing.")
@_options.reading
def command(
    ctx: click.Context, interfaces: tuple[str, ...], script: str | None, endpoints: tuple[str, ...], storm: str,
    check: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Stand in for the components that serve INTERFACEs or publish topics, until Ctrl-C.

    Methods return example values, and topics get example messages once a second; a script says it otherwise. Each
    interface is served wherever the components of this workspace, and those of its deployments, expect it. If no
    IceStorm answers, one is started.
    """
    from robocomp_yaml.api.mocking import Mock

    for name in interfaces:
        if os.path.isfile(name):
            hint = f"{terminal.typed('--script', name)} reads a script"
            if kind_of(name) == "idsl":
                hint = "an interface or topic is named, such as Laser, and found in the documents of the workspace"
            raise click.UsageError(f"'{name}' is a file: {hint}", ctx)
    mock = Mock(interfaces, script or "", include)
    if check or mock.diagnostics:
        _options.report(ctx, format_, mock.diagnostics, 1)
    _serve(ctx, mock, _options.pairs(endpoints, "NAME=ENDPOINT, such as Mouth='tcp -p 10005'"), storm, format_)


def _serve(ctx: click.Context, mock: Mock, endpoints: Mapping[str, str], storm: str, format_: str) -> None:
    from robocomp_yaml.diag.render.json import dumps

    lock = threading.Lock()

    def show(call: Call) -> None:
        with lock:
            if format_ == "json":
                terminal.data(dumps(_as_data(call), indent=None), json=True)
            elif ctx.obj.verbosity >= 0:
                terminal.say(_line(call))

    try:
        with mock.running(endpoints=endpoints, storm=storm, on_call=show) as served:
            if ctx.obj.verbosity >= 0:
                terminal.say(*map(_served, served), "Ctrl-C stops it", err=format_ == "json")
            while True:
                time.sleep(3600)
    except KeyboardInterrupt as error:
        ctx.exit(_signals.code_of(error))


def _served(one: Serving) -> str:
    if one.problem:
        return f"skipped  {one.proxy}: {one.problem}"
    return f"serving  {one.proxy}" + (f"  for {', '.join(one.users)}" if one.users else "")


_LONGEST = 200  # characters of a value: an image is not to be read


def _line(call: Call) -> str:
    from robocomp_yaml.source.yaml_text import flow

    at = time.strftime("%H:%M:%S", time.localtime(call.time))

    def shown(value: Any) -> str:
        text = flow(_begin(value))
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…{_count(value)}"

    arguments = ", ".join(f"{name}: {shown(value)}" for name, value in call.arguments.items())
    if call.is_published:
        end = ""
    elif call.raises:
        end = f" raises {call.raises}"
    else:
        end = f" returns {shown(_results(call.results))}" if call.results else ""
    return f"{at} {'published ' if call.is_published else ''}{call.interface}.{call.method}({arguments}){end}"


def _begin(value: Any) -> Any:
    """A value without the elements that are not shown: to write all of an image takes seconds."""
    match value:
        case list():
            return [_begin(one) for one in value[:_LONGEST]]
        case dict():
            return {name: _begin(one) for name, one in itertools.islice(value.items(), _LONGEST)}
        case str():
            return value[: _LONGEST + 1]
        case _:
            return value


def _count(value: Any) -> str:
    what = "characters" if isinstance(value, str) else "values"
    return f" ({len(value)} {what})" if isinstance(value, (str, list, dict)) and len(value) > _LONGEST else ""


def _results(results: Mapping[str, Any]) -> Any:
    """One result by itself, several by name."""
    return next(iter(results.values())) if list(results) == ["returns"] else dict(results)


def _as_data(call: Call) -> dict[str, Any]:
    results = {"raises": call.raises} if call.raises else {"results": dict(call.results)}
    return {
        "time": call.time, "interface": call.interface, "method": call.method, "arguments": dict(call.arguments),
        **({"published": True} if call.is_published else results),
    }  # fmt: skip
