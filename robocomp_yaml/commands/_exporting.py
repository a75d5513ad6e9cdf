"""How `rcyaml deploy export` shows files, or says where they were written."""

from __future__ import annotations

import sys

import click

from robocomp_yaml.commands._deploying import Opened, carried_out, end, show
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render.json import dumps


def export(ctx: click.Context, opened: Opened, form: str, output: str | None) -> None:
    """Prints the files, or writes them below `output`. They may hold what a configuration holds: on a terminal secrets
    are hidden."""
    deployment = opened.deployment
    if output is None:
        before = len(deployment.diagnostics)
        files = carried_out(ctx, opened, lambda: deployment.export(form, reveal=not sys.stdout.isatty()))
        _show(files, opened.format_)
        show(ctx, opened, deployment.diagnostics[before:])
        return
    written = carried_out(ctx, opened, lambda: deployment.write_export(form, output))
    if opened.format_ == "json":
        end(ctx, opened, {"written": written})
    for path in written if ctx.obj.verbosity >= 0 else ():
        terminal.say(f"wrote {path}")
    end(ctx, opened)


def _show(files: dict[str, str], format_: str) -> None:
    if format_ == "json":
        terminal.data(dumps({"files": files}), json=True)
        return
    for path, text in files.items():
        if len(files) > 1:
            terminal.data(f"# {path}\n")
        terminal.data(text if text.endswith("\n") else f"{text}\n")
