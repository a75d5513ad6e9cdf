"""How the commands of `rcyaml config` tell what values are."""

from __future__ import annotations

import sys
from typing import Any

import click

from robocomp_yaml.api.values import Values, write_new
from robocomp_yaml.commands import _options
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.parameters.editing.show import Value
from robocomp_yaml.parameters.spelling.yaml import flow
from robocomp_yaml.source.tree import Node, Scalar


def check(ctx: click.Context, file: str, include: tuple[str, ...], format_: str) -> None:
    values = Values(file, include)
    _options.report(ctx, format_, values.diagnostics, values.documents_read)


def show(ctx: click.Context, file: str, include: tuple[str, ...], format_: str, *, reveal: bool) -> None:
    rows = Values(file, include).rows(reveal=reveal)
    if format_ == "json":
        terminal.data(dumps({"values": [_as_json(row) for row in rows]}), json=True)
        return
    width = max((min(len(_assignment(row)), 50) for row in rows), default=0)
    terminal.data("".join(f"{_assignment(row):<{width}}  # {_origin(row)}\n" for row in rows))


def _assignment(row: Value) -> str:
    return f"{row.path} = {row.text}" + (f" {row.unit}" if row.unit else "")


def _origin(row: Value) -> str:
    if row.node is None:
        where = f", {_place(row.default)}" if row.default is not None else ""
        return f"default{where}"
    overrode = "".join(f", overrides {_said(row, node)} ({_place(node)})" for node in row.overrode)
    return f"{_place(row.node)}{overrode}"


def _said(row: Value, node: Node) -> str:
    data = row.hide(node.data)
    text = node.lexeme if isinstance(node, Scalar) and data == node.data else flow(data)
    return text if len(text) <= 40 else text[:39] + "…"


def _place(node: Node) -> str:
    return f"{node.span.file}:{node.span.line}"


def _as_json(row: Value) -> dict[str, Any]:
    return {
        "path": row.path,
        "value": row.data,
        "unit": row.unit,
        "editable": row.editable,
        "default": row.node is None,
        **_json_place(row.node or row.default),
        "overrode": [{"value": row.hide(node.data), **_json_place(node)} for node in row.overrode],
    }


def _json_place(node: Node | None) -> dict[str, Any]:
    return {"file": node.span.file if node else None, "line": node.span.line if node else None}


def get(
    ctx: click.Context, file: str, path: str, include: tuple[str, ...], format_: str, *, reveal: bool
) -> None:  # fmt: skip
    data = Values(file, include).get(path, reveal=reveal)
    if data is None:
        terminal.say(f"{path} has no value", err=True)
        ctx.exit(1)
    if format_ == "json":
        terminal.data(dumps({"path": path, "value": data}), json=True)
        return
    terminal.data(f"{data if isinstance(data, str) else flow(data)}\n")


def set_value(ctx: click.Context, file: str, path: str, value: str, include: tuple[str, ...], format_: str) -> None:
    change = Values(file, include).set(path, value)
    change.apply()
    if format_ == "json":
        terminal.data(dumps({"path": path, "value": change.value, "was": change.was or None}), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(f"{path} = {change.value}" + (f" (was {change.was})" if change.was else ""))


def export(ctx: click.Context, file: str, form: str, include: tuple[str, ...], *, reveal: bool) -> None:
    """Programs get the values as they are; on a terminal secrets are hidden."""
    terminal.data(Values(file, include).export(form, reveal=reveal or not sys.stdout.isatty()))


def new(ctx: click.Context, file: str, include: tuple[str, ...]) -> None:
    target = write_new(file, include)
    if ctx.obj.verbosity >= 0:
        terminal.say(f"wrote {target}", f"next: {terminal.typed('rcyaml', 'config', 'check', str(target))}")
