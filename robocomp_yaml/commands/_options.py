"""Options that several commands share, and how they report."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import Any

import click

from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.render import FORMATS, render

Function = Callable[..., Any]

paths = click.argument("paths", nargs=-1, type=click.Path(exists=True))
include = click.option(
    "-I", "--include", "include", multiple=True, metavar="DIR", type=click.Path(exists=True, file_okay=False),
    help="Look for imports here too; may be repeated.",
)
format_ = click.option(
    "--format", "format_", type=click.Choice(FORMATS), default="text", help="How to print diagnostics."
)


def colored(ctx: click.Context, stream: Any = None) -> bool:
    """Whether to colour what goes to a stream (standard output unless another is given)."""
    if ctx.color is not None:
        return ctx.color
    return bool((stream or sys.stdout).isatty())


def report(ctx: click.Context, format_: str, diagnostics: Iterable[Diagnostic], documents: int) -> None:
    """Prints the diagnostics and ends the command: with 1 where one is an error, else with 0."""
    told = list(diagnostics)
    if ctx.obj.verbosity >= 0 or told:
        click.echo(render(format_, told, documents, format_ == "text" and colored(ctx)), nl=False, color=ctx.color)
    ctx.exit(1 if has_errors(told) else 0)
