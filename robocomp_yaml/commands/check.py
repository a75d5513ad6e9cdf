"""`rcyaml check`: every diagnostic of the documents."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _fail_on, _options

if TYPE_CHECKING:
    from robocomp_yaml.commands._fail_on import FailOn
    from robocomp_yaml.diag.diagnostic import Diagnostic
    from robocomp_yaml.pipeline import Analysis


@click.command(short_help="Report everything that is wrong with the documents.")
@_options.paths
@click.option("--environment", is_flag=True, help="Also say which of the libraries they name are not installed.")
@_fail_on.fail_on
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, paths: tuple[str, ...], environment: bool, fail_on: FailOn, include: tuple[str, ...],
    format_: str,
) -> None:  # fmt: skip
    """Report everything that is wrong with the documents at PATHS (by default, below this folder).

    A folder means all documents below it. Documents that they import are looked at too.
    """
    from robocomp_yaml.pipeline import analyse

    paths = paths or (".",)
    with _options.progress("reading", paths) as on_read:
        analysis = analyse(paths, include, on_read)
    on_disk = _on_disk(analysis, paths, include, environment)
    told = analysis.with_more([*on_disk, *(_missing(analysis) if environment else ())])
    _options.report(ctx, format_, told, analysis.program.documents, fail_on)


def _on_disk(
    analysis: Analysis, paths: tuple[str, ...], include: tuple[str, ...], environment: bool
) -> Iterator[Diagnostic]:
    """What files say that are no documents: each component's `etc/config` and code, and the executables of
    deployments."""
    if analysis.program.components:
        from robocomp_yaml.emit import ports
        from robocomp_yaml.emit.specific import written

        yield from ports.clashes(analysis.program.components.values(), analysis.disk)
        if written.has_code(analysis.program):
            from robocomp_yaml.commands import _made_already

            told = _made_already.told_of_code(paths, include)
            if told is None:
                told = written.of_written(analysis.program, analysis.diagnostics, analysis.linker)
            yield from told
    if analysis.networks:
        from robocomp_yaml.check.networks import of_environment

        yield from of_environment(analysis.networks, analysis.program, environment=environment)


def _missing(analysis: Analysis) -> Iterator[Diagnostic]:
    from robocomp_yaml.emit.environment import missing

    return missing(analysis.program.components.values(), analysis.linker.workspace_of)
