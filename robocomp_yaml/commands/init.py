"""`rcyaml init`: makes a folder a workspace."""

from __future__ import annotations

import os

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal

_WITH_DOCUMENTS = ("rcyaml check", "rcyaml compile", "rcyaml run")
_EMPTY = ("rcyaml new interface NAME", "rcyaml new component NAME", "rcyaml new deployment NAME")


@click.command(cls=LibraryCommand, short_help="Make a folder a workspace.")
@click.argument("folder", metavar="[DIR]", default=".", type=click.Path(file_okay=False))
@click.option("--bare", is_flag=True, help="Do not write the example interface and component.")
@_options.text_or_json
@click.pass_context
def command(ctx: click.Context, folder: str, bare: bool, format_: str) -> None:
    """Make DIR (by default, this folder) a workspace that checks and compiles.

    Existing files are kept. A folder without documents gets an example interface and component.
    """
    from robocomp_yaml.api.new import workspace
    from robocomp_yaml.source.discover import documents_below

    report = _options.FileReport(ctx, format_)
    with report.writing():
        workspace.init(folder, report.add, bare=bare)
    is_here = os.path.realpath(folder) == os.getcwd()
    there = [] if is_here else [terminal.typed("cd", os.path.normpath(folder))]
    report.end(*there, *(_WITH_DOCUMENTS if list(documents_below(folder)) else _EMPTY))
