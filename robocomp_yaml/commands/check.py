"""`rcyaml check`: every diagnostic of the documents."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _fail_on, _options
from robocomp_yaml.diag.diagnostic import in_order

if TYPE_CHECKING:
    from robocomp_yaml.commands._fail_on import FailOn
    from robocomp_yaml.diag.diagnostic import Diagnostic
    from robocomp_yaml.pipeline import Analysis


@click.command(short_help="Report everything that is wrong with the documents.")
@_options.paths
@click.option("--environment", is_flag=True, help="Also say which of the libraries they name are not installed.")
@click.option("--fix", is_flag=True, help="Apply the fixes that leave only one possible meaning.")
@click.option("--unsafe-fixes", is_flag=True, help="Apply the others, too: what was probably meant.")
@click.option("--diff", is_flag=True, help="Show what the fixes would change, and write nothing.")
@_fail_on.fail_on
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, paths: tuple[str, ...], environment: bool, fix: bool, unsafe_fixes: bool, diff: bool,
    fail_on: FailOn, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Report everything that is wrong with the documents at PATHS (by default, below this folder).

    A folder means all documents below it. Documents that they import are looked at too.
    """
    from robocomp_yaml.pipeline import analyse

    paths = paths or (".",)
    if fix or unsafe_fixes or diff:
        from robocomp_yaml.commands import _fixing

        fixing = _fixing.Fixing(
            paths, lambda overlay: analyse(paths, include, overlay=overlay), lambda found: _told(found, environment),
            unsafe=unsafe_fixes, look_only=diff,
        )
        _fixing.report(ctx, fixing, format_, fail_on)
    with _options.progress("reading", paths) as on_read:
        analysis = analyse(paths, include, on_read)
    _options.report(ctx, format_, _told(analysis, environment), analysis.program.documents, fail_on)


def _told(analysis: Analysis, environment: bool) -> list[Diagnostic]:
    told = analysis.with_more([*_on_disk(analysis, environment), *(_missing(analysis) if environment else ())])
    return in_order([*told, *analysis.allowed_in_vain(environment=environment)])


def _on_disk(analysis: Analysis, environment: bool) -> Iterator[Diagnostic]:
    """What files say that are no documents: each component's `etc/config` and code, and the executables of
    deployments."""
    if analysis.program.components:
        from robocomp_yaml.emit import ports
        from robocomp_yaml.emit.specific.written import of_written

        yield from ports.clashes(analysis.program.components.values())
        yield from of_written(analysis.program, analysis.diagnostics, analysis.linker)
    if analysis.networks:
        from robocomp_yaml.check.networks import of_environment

        yield from of_environment(analysis.networks, analysis.program, environment=environment)


def _missing(analysis: Analysis) -> Iterator[Diagnostic]:
    from robocomp_yaml.emit.environment import missing

    return missing(analysis.program.components.values(), analysis.linker.workspace_of)
