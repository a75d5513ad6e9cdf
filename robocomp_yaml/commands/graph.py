"""`rcyaml graph`: a picture of a deployment, or of the components of a folder."""

from __future__ import annotations

import sys

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.diag import terminal
from robocomp_yaml.emit.graphs.forms import forms
from robocomp_yaml.transactions import whole_file


@click.command(cls=LibraryCommand, short_help="A picture of a deployment, or of components.")
@click.argument("path", metavar="[DDSL]", default=".", type=click.Path(exists=True))
@click.option("--as", "form", type=PluginChoice(forms), default="text", show_default=True, help="How to draw it.")
@click.option("-o", "--output", metavar="FILE", type=click.Path(dir_okay=False), help="Write it there.")
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, path: str, form: str, output: str | None, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Show hosts, what runs on them, and what is connected to what; problems are red.

    DDSL is a deployment document, or a folder. Of a folder without a deployment the components are shown, and which
    of them implement what others require.
    """
    from robocomp_yaml import api
    from robocomp_yaml.diag.diagnostic import has_errors
    from robocomp_yaml.diag.render import tell

    workspace = api.load(path, include=include)
    told = workspace.analysis.diagnostics
    try:
        text = workspace.draw(form, path)
    except api.Faulty as faulty:
        if all(one in told for one in faulty.diagnostics):
            _options.report(ctx, format_, told, workspace.documents_read)
        raise
    if output is None:
        terminal.data(text, json=form == "json")
    else:
        with _options.writing(output):
            whole_file.replace(output, terminal.as_bytes(text))
    if told and not (output is None and form in ("text", "json")):  # which tell them themselves
        tell(format_, told, workspace.documents_read, _options.colored(ctx, sys.stderr), err=True)
    ctx.exit(1 if has_errors(told) else 0)
