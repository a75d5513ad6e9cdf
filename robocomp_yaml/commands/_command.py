"""Commands as click runs them, for whom the library answers: what it refuses is wrong usage (2), and documents with
errors end a command (1)."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _plugin_choices

if TYPE_CHECKING:
    from robocomp_yaml.diag.errors import Faulty


class LibraryCommand(click.Command):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        _plugin_choices.remember(ctx, args)
        with _answers(ctx):
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> object:
        with _answers(ctx):
            return super().invoke(ctx)


class CommandGroup(click.Group):
    """Its subcommands are such commands; that a word is none of them it says in one way, at every level."""

    command_class = LibraryCommand

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            if args[0].startswith("-"):  # an option that there is not
                raise
            meant = " or ".join(f"'{one}'" for one in self._meant(ctx, args[0]))
            said = f"there is no command '{' '.join([*ctx.command_path.split()[1:], args[0]])}'"
            raise click.UsageError(said + (f"; did you mean {meant}?" if meant else ""), ctx) from error

    def _meant(self, ctx: click.Context, word: str) -> list[str]:
        """A command of this group whose name is like the word, or those of its groups that are called so."""
        from robocomp_yaml.diag.suggest import suggest

        path = ctx.command_path.split()[1:]
        own = self.list_commands(ctx)
        groups = {name: found for name in own if isinstance(found := self.get_command(ctx, name), click.Group)}
        below = [f"{name} {word}" for name, group in groups.items() if word in group.commands]
        if below:
            return below
        meant = suggest(word, own)
        return [" ".join([*path, meant])] if meant else []


@contextmanager
def _answers(ctx: click.Context) -> Iterator[None]:
    try:
        yield
    except Exception as error:
        from robocomp_yaml.diag.errors import Faulty, Refused  # `rcyaml --help` needs neither

        if isinstance(error, Refused):
            raise click.UsageError(str(error), ctx) from None
        if not isinstance(error, Faulty):
            raise
        _tell(ctx, error)


def _tell(ctx: click.Context, faulty: Faulty) -> None:
    """What is wrong: on standard error, where standard output is for values; as JSON in their stead."""
    from robocomp_yaml.commands import _options
    from robocomp_yaml.diag.render import tell

    is_json = ctx.params.get("format_") == "json"
    color = _options.colored(ctx, sys.stderr)
    tell("json" if is_json else "text", faulty.diagnostics, faulty.documents, color, err=not is_json)
    ctx.exit(1)
