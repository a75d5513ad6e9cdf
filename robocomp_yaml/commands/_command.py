"""Commands as click runs them, for whom the library answers: what it refuses is wrong usage (2), and documents with
errors end a command (1)."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import click

from robocomp_yaml.diag.errors import Faulty, Refused


class Command(click.Command):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        with _answers(ctx):
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> object:
        with _answers(ctx):
            return super().invoke(ctx)


class Group(click.Group):
    """Its subcommands are such commands."""

    command_class = Command


@contextmanager
def _answers(ctx: click.Context) -> Iterator[None]:
    try:
        yield
    except Refused as refused:
        raise click.UsageError(str(refused), ctx) from None
    except Faulty as faulty:
        _tell(ctx, faulty)


def _tell(ctx: click.Context, faulty: Faulty) -> None:
    """What is wrong: on standard error, where standard output is for values; as JSON in their stead."""
    from robocomp_yaml.commands import _options
    from robocomp_yaml.diag.render import tell

    is_json = ctx.params.get("format_") == "json"
    color = _options.colored(ctx, sys.stderr)
    tell("json" if is_json else "text", faulty.diagnostics, faulty.documents, color, err=not is_json)
    ctx.exit(1)
