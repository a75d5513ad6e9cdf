"""`rcyaml graph`: a picture of a deployment, or of the components of a folder."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import click

from robocomp_yaml.api.deployments import deployments_of, one_of
from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import Command
from robocomp_yaml.commands._plugged import Plugged
from robocomp_yaml.diag import terminal
from robocomp_yaml.emit.graphs.forms import forms
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.transactions import whole_file

if TYPE_CHECKING:
    from robocomp_yaml.emit.graphs.picture import Picture
    from robocomp_yaml.pipeline import Analysis


@click.command(cls=Command, short_help="A picture of a deployment, or of components.")
@click.argument("path", metavar="[DDSL]", default=".", type=click.Path(exists=True))
@click.option("--as", "form", type=Plugged(forms), default="text", show_default=True, help="How to draw it.")
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
    from robocomp_yaml.diag.diagnostic import has_errors
    from robocomp_yaml.diag.render import tell
    from robocomp_yaml.emit.graphs.forms import draw
    from robocomp_yaml.pipeline import analyse

    analysis = analyse([path], include)
    made = _picture(path, analysis)
    if made is None:
        _options.report(ctx, format_, analysis.diagnostics, analysis.program.documents)
        return
    text = draw(made, form, analysis.linker.workspace_of(_inside(path)).plugins)
    if output is None:
        terminal.data(text, json=form == "json")
    else:
        _save(output, text)
    told = analysis.diagnostics
    if told and not (output is None and form in ("text", "json")):  # which tell them themselves
        tell(format_, told, analysis.program.documents, _options.colored(ctx, sys.stderr), err=True)
    ctx.exit(1 if has_errors(told) else 0)


def _picture(path: str, analysis: Analysis) -> Picture | None:
    """None where the document, or everything in the folder, is too broken to show."""
    from robocomp_yaml.emit.graphs import of_components, of_network

    deployments = list(analysis.program.deployments)
    if not os.path.isdir(path):
        real = os.path.realpath(path)
        network = analysis.networks.get(real)
        if network is None and kind_of(path) != "ddsl":
            raise click.UsageError(f"'{path}' is no deployment document (NAME.ddsl.yaml), and no folder")
        return of_network.picture_of(network, analysis.diagnostics) if network is not None else None
    readable = [one for one in deployments_of(path, analysis=analysis) if os.path.realpath(one) in analysis.networks]
    if readable:
        return of_network.picture_of(analysis.networks[os.path.realpath(one_of(readable))], analysis.diagnostics)
    if deployments or not analysis.program.components:
        return None
    name = os.path.basename(os.path.abspath(path))
    return of_components.picture_of(name, analysis.program.components.values())


def _inside(path: str) -> str:
    """A document, or what stands for one in a folder: its workspace is that of the picture."""
    return os.path.join(path, "") if os.path.isdir(path) else path


def _save(path: str, text: str) -> None:
    try:
        whole_file.replace(path, terminal.as_bytes(text))
    except OSError as error:
        raise click.ClickException(f"{path} cannot be written: {(error.strerror or str(error)).lower()}") from error
