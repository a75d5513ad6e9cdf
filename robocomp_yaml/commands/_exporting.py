"""What `rcyaml deploy export` writes."""

from __future__ import annotations

import os

import click

from robocomp_yaml.commands._deploying import Opened
from robocomp_yaml.deploy import folder
from robocomp_yaml.diag.render.json import dumps


def export(ctx: click.Context, opened: Opened, form: str, output: str | None) -> None:
    """Prints the files, or writes them below `output`. They may hold what a configuration holds: only their owner can
    read those that are written."""
    from robocomp_yaml.emit import exports

    files = exports.export(opened.network, form)
    if output is None:
        _show(files, opened.format_)
        return
    for path, text in files.items():
        try:
            folder.write(output, path, text)
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise click.UsageError(f"cannot write {os.path.join(output, path)}: {reason}") from error
        if ctx.obj.verbosity >= 0:
            click.echo(f"wrote {os.path.join(output, path)}")


def _show(files: dict[str, str], format_: str) -> None:
    if format_ == "json":
        click.echo(dumps({"files": files}), nl=False)
        return
    for path, text in files.items():
        if len(files) > 1:
            click.echo(f"# {path}")
        click.echo(text, nl=not text.endswith("\n"))
