"""`rcyaml graph`: draws a deployment, or the components of a folder."""

from __future__ import annotations

import sys

import click
from click.core import ParameterSource

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render import FORMATS
from robocomp_yaml.emit.graphs.forms import forms
from robocomp_yaml.transactions import whole_file


@click.command(cls=LibraryCommand, short_help="Draw a deployment, or the components of a folder.")
@click.argument("path", metavar="[DDSL]", default=".", type=click.Path(exists=True))
@click.option("--as", "form", type=PluginChoice(forms), default="text", show_default=True,
              help="The form of the drawing.")  # fmt: skip
@click.option("-o", "--output", metavar="FILE", type=click.Path(dir_okay=False), help="Write to FILE.")
@_options.include
@_options.format_of(FORMATS, "How diagnostics are printed; json: the drawing, too.")
@click.pass_context
def command(
    ctx: click.Context, path: str, form: str, output: str | None, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Draw hosts, their processes and the connections. Problems are red.

    DDSL is a deployment document, or a folder. If a folder has no deployment, its components are drawn, and which of
    them implement what others require.
    """
    from robocomp_yaml import api
    from robocomp_yaml.diag.diagnostic import has_errors
    from robocomp_yaml.diag.render import tell

    if format_ == "json" and ctx.get_parameter_source("form") is ParameterSource.DEFAULT:
        form = "json"  # all that is printed
    workspace = api.load(path, include=include)
    diagnostics = workspace.analysis.diagnostics
    try:
        text = workspace.draw(form, path)
    except api.Faulty as faulty:
        if all(one in diagnostics for one in faulty.diagnostics):
            _options.report(ctx, format_, diagnostics, workspace.documents_read)
        raise
    if output is None:
        terminal.data(text, json=form == "json")
    else:
        with _options.writing(output):
            whole_file.replace(output, terminal.as_bytes(text))
    if diagnostics and not (output is None and form in ("text", "json")):  # which contain the diagnostics
        tell(format_, diagnostics, workspace.documents_read, _options.colored(ctx, sys.stderr), err=True)
    ctx.exit(1 if has_errors(diagnostics) else 0)
