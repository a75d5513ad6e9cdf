"""`rcyaml check`: every diagnostic of the documents."""

from __future__ import annotations

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import Command


@click.command(cls=Command, short_help="Report everything that is wrong with the documents.")
@_options.paths
@click.option("--environment", is_flag=True, help="Also say which of the libraries they name are not installed.")
@click.option("--fix", is_flag=True, help="Apply the fixes that leave only one possible meaning.")
@click.option("--unsafe-fixes", is_flag=True, help="Apply the others, too: what was probably meant.")
@click.option("--diff", is_flag=True, help="Show what the fixes would change, and write nothing.")
@_options.fail_on
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, paths: tuple[str, ...], environment: bool, fix: bool, unsafe_fixes: bool, diff: bool,
    fail_on: _options.FailOn, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Report everything that is wrong with the documents at PATHS (by default, below this folder).

    A folder means all documents below it. Documents that they import are looked at too.
    """
    from robocomp_yaml import api

    paths = paths or (".",)
    if fix or unsafe_fixes or diff:
        from robocomp_yaml.commands import _fixing

        fixing = api.load(*paths, include=include).fix(unsafe=unsafe_fixes, environment=environment)
        _fixing.report(ctx, fixing, format_, fail_on, look_only=diff)
    with _options.progress("reading", paths) as on_read:
        workspace = api.load(*paths, include=include, on_read=on_read)
    told = workspace.check(environment=environment)
    _options.report(ctx, format_, told, workspace.documents_read, fail_on)
