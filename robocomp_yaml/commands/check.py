"""`rcyaml check`: every diagnostic of the documents."""

from __future__ import annotations

import click

from robocomp_yaml.commands import _options


@click.command(short_help="Report everything that is wrong with the documents.")
@_options.paths
@_options.include
@_options.format_
@click.pass_context
def command(ctx: click.Context, paths: tuple[str, ...], include: tuple[str, ...], format_: str) -> None:
    """Report everything that is wrong with the documents at PATHS (by default, below this folder).

    A folder means all documents below it. Documents that they import are looked at too.
    """
    from robocomp_yaml.pipeline import analyse

    paths = paths or (".",)
    with _options.progress("reading", paths) as on_read:
        analysis = analyse(paths, include, on_read)
    told = analysis.diagnostics
    if analysis.program.components:
        from robocomp_yaml.emit import ports

        told = analysis.with_more(ports.clashes(analysis.program.components.values()))
    _options.report(ctx, format_, told, analysis.program.documents)
