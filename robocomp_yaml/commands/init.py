"""`rcyaml init`: makes a folder a workspace."""

from __future__ import annotations

import os

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.diag import terminal


@click.command(short_help="Make a folder a workspace.")
@click.argument("folder", metavar="[DIR]", default=".", type=click.Path(file_okay=False))
@click.option("--bare", is_flag=True, help="Do not write the example interface and component.")
@click.pass_context
def command(ctx: click.Context, folder: str, bare: bool) -> None:
    """Make DIR (by default, this folder) a workspace that checks and compiles.

    Existing files are kept. A folder without documents gets an example interface and component.
    """
    from robocomp_yaml.api.new import workspace
    from robocomp_yaml.source.discover import documents_below

    with _options.writing():
        workspace.init(folder, _options.report_file, bare=bare)
    if ctx.obj.verbosity >= 0:
        is_here = os.path.realpath(folder) == os.getcwd()
        there = "" if is_here else f"{terminal.typed('cd', os.path.normpath(folder))}, then "
        if list(documents_below(folder)):
            then = "rcyaml check, rcyaml compile and rcyaml run; to start several together, rcyaml new deployment NAME"
        else:
            then = "rcyaml new interface NAME, rcyaml new component NAME, and rcyaml new deployment NAME"
        terminal.say(f"next: {there}{then}")
