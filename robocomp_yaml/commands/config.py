"""`rcyaml config`: the values of a component's parameters, without a build and without a robot."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import CommandGroup, LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render.json import dumps

if TYPE_CHECKING:
    from robocomp_yaml.parameters.editing.show import Value
    from robocomp_yaml.source.tree import Node


def _values_document(ctx: click.Context, param: click.Parameter, argument: str) -> str:
    from robocomp_yaml.api import which

    return which.values(argument)


def _values_or_flat(ctx: click.Context, param: click.Parameter, argument: str) -> str:
    from robocomp_yaml.api import which

    return which.values(argument, has_flat=True)


class _OptionalFile(LibraryCommand):
    """A command whose first argument may be omitted if only one document is possible."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        names = [param.name for param in self.get_params(ctx) if isinstance(param, click.Argument)]
        parsed, _, _ = self.make_parser(ctx).parse_args(list(args))
        passed = [parsed[name] for name in names if name and isinstance(parsed.get(name), str)]
        lacks = len(passed) == len(names) - 1 and not os.path.exists(passed[0])
        return super().parse_args(ctx, ["", *args] if lacks else args)


file = click.argument("file", metavar="[FILE]", default="", callback=_values_document)
read_only = click.argument("file", metavar="[FILE]", default="", callback=_values_or_flat)
reveal = click.option("--reveal", is_flag=True, help="Also show secrets.")


@click.group(cls=CommandGroup, short_help="Check, show, change and export the values of parameters.")
def command() -> None:
    """Check, show, change and export the values of a component's parameters, without a build and without a robot.

    FILE is a values document: etc/config.yaml, or NAME.config.yaml. The folder, the document or the name of a component
    means its etc/config.yaml, or without such a document, for commands that only read, its etc/config. If there is only
    one component, FILE may be omitted.
    """


@command.command(short_help="Write a first document, with defaults and docs as comments.")
@click.argument("file", metavar="[COMPONENT]", default="")
@_options.reading
def new(ctx: click.Context, file: str, include: tuple[str, ...], format_: str) -> None:
    """Write a first values document to etc/config.yaml in a component's folder. COMPONENT is that folder, the
    component's document (or that of its parameters), or its name; if there is only one component, it may be omitted. It
    may also be the values document to write, NAME.config.yaml, for the component beside it or one folder up.

    Values and connections of the component's etc/config are copied.
    """
    from robocomp_yaml.api.values import write_new

    target = write_new(file, include)
    report = _options.FileReport(ctx, format_)
    with report.writing():
        report.add("wrote", target)
    report.end(terminal.typed("rcyaml", "config", "check", target))


@command.command(short_help="Report everything that is wrong with the values.")
@read_only
@_options.reporting
def check(ctx: click.Context, file: str, include: tuple[str, ...], format_: str) -> None:
    """Report everything that is wrong with the values in FILE and its layers, with line and column."""
    from robocomp_yaml.api.values import Values

    values = Values(file, include)
    _options.report(ctx, format_, values.diagnostics, values.documents_read)


@command.command(short_help="Print every effective value, and its location.")
@read_only
@reveal
@_options.reading
def show(ctx: click.Context, file: str, reveal: bool, include: tuple[str, ...], format_: str) -> None:
    """Print every effective value with the file and line that set it, and the values that it overrides: parameters,
    endpoints, proxies, topics, and properties of Ice and others. Secrets are hidden. References to the environment and
    to files are printed as they are: they are never resolved here. A component without a values document has the values
    of its etc/config. With `rcyaml -v`, the endpoints, proxies and properties that nobody sets are printed, too."""
    from robocomp_yaml.api.values import Values
    from robocomp_yaml.commands._origins import origin, settings_data
    from robocomp_yaml.parameters.editing.settings import SET

    values = Values(file, include)
    rows, settings = values.rows(reveal=reveal), values.settings(reveal=reveal)
    if format_ == "json":
        data = {"values": [_as_json(row) for row in rows], "properties": settings_data(settings)}
        terminal.data(dumps(data), json=True)
        return
    chosen = [one for one in settings if one.source == SET or ctx.obj.verbosity > 0]
    _print_table([(_assignment(row), _origin(row)) for row in rows])
    _print_table([(f"{one.key} = {one.value}", origin(one)) for one in chosen])


@command.command(short_help="Print one effective value.", cls=_OptionalFile)
@read_only
@click.argument("path")
@reveal
@_options.reading
def get(
    ctx: click.Context, file: str, path: str, reveal: bool, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Print the effective value at PATH, such as motors[0].vel. A secret is hidden."""
    from robocomp_yaml.api.values import Values

    _options.print_value(ctx, format_, path, Values(file, include).get(path, reveal=reveal), dumps)


@command.command("set", short_help="Change one value, and nothing else.", cls=_OptionalFile,
                 context_settings={"ignore_unknown_options": True})  # fmt: skip
@file
@click.argument("path")
@click.argument("value")
@_options.reading
def set_(
    ctx: click.Context, file: str, path: str, value: str, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Set the parameter at PATH to VALUE in FILE, if its type and limits accept it. Text needs no quotes; null returns
    to the default; {env: NAME} or {file: PATH} is resolved when the component starts. Comments, order and layout of the
    document stay, byte for byte."""
    from robocomp_yaml.api.values import Values

    change = Values(file, include).set(path, value)
    change.apply()
    if format_ == "json":
        terminal.data(dumps({"path": path, "value": change.value, "was": change.was or None}), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(f"{path} = {change.value}" + (f" (was {change.was})" if change.was else ""))


@command.command(short_help="Print the values as Ice properties or TOML.")
@read_only
@click.option("--as", "form", type=click.Choice(["ice", "toml"]), default="ice", show_default=True, help="The format.")
@reveal
@_options.include
@click.pass_context
def export(ctx: click.Context, file: str, form: str, reveal: bool, include: tuple[str, ...]) -> None:
    """Print all effective values as Ice properties, with which a component runs without any YAML, or as TOML. Secrets
    are hidden on a terminal, but not in a pipe or a file."""
    from robocomp_yaml.api.values import Values

    terminal.data(Values(file, include).export(form, reveal=reveal or not sys.stdout.isatty()))


def _print_table(lines: list[tuple[str, str]]) -> None:
    width = max((min(len(assigned), 50) for assigned, _ in lines), default=0)
    terminal.data("".join(f"{assigned:<{width}}  # {where}\n" for assigned, where in lines))


def _assignment(row: Value) -> str:
    return f"{row.path} = {row.text}" + (f" {row.unit}" if row.unit else "")


def _origin(row: Value) -> str:
    if row.node is None:
        where = f", {_location(row.default)}" if row.default is not None else ""
        return f"default{where}"
    overrode = "".join(f", overrides {_overridden(row, node)} ({_location(node)})" for node in row.overrode)
    return f"{_location(row.node)}{overrode}"


def _overridden(row: Value, node: Node) -> str:
    from robocomp_yaml.source.tree import Scalar
    from robocomp_yaml.source.yaml_text import flow

    data = row.hide(node.data)
    text = node.lexeme if isinstance(node, Scalar) and data == node.data else flow(data)
    return text if len(text) <= 40 else text[:39] + "…"


def _location(node: Node) -> str:
    return f"{node.span.file}:{node.span.line}"


def _as_json(row: Value) -> dict[str, Any]:
    return {
        "path": row.path, "value": row.data, "unit": row.unit, "editable": row.editable, "default": row.node is None,
        **_json_location(row.node or row.default),
        "overrode": [{"value": row.hide(node.data), **_json_location(node)} for node in row.overrode],
    }  # fmt: skip


def _json_location(node: Node | None) -> dict[str, Any]:
    return {"file": node.span.file if node else None, "line": node.span.line if node else None}
