"""Commands of click that call the library: Refused becomes wrong usage (exit code 2), Faulty prints its diagnostics and
ends the command (exit code 1), NoAnswer its message."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _plugin_choices

if TYPE_CHECKING:
    from robocomp_yaml.diag.errors import Faulty


class _WithExamples(click.Command):
    """A command whose `--help` ends with examples."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        if lines := examples().get(ctx.command_path):
            with formatter.section("Examples"):
                for line in lines:
                    formatter.write(f"{'':>{formatter.current_indent}}{line}\n")
        super().format_epilog(ctx, formatter)


def examples() -> dict[str, list[str]]:
    """The examples of `--help`, as lines for a shell, by commands such as `rcyaml deploy up`. All are about the robot
    of the tutorial."""
    from robocomp_yaml import resources  # unused but for `--help`

    paragraphs = (one.splitlines() for one in resources.text("templates/help/examples.txt").split("\n\n"))
    return {command: [line.strip() for line in lines] for command, *lines in paragraphs}


class LibraryCommand(_WithExamples):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        _plugin_choices.remember(ctx, args)
        with _library_errors(ctx):
            return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> object:
        with _library_errors(ctx):
            return super().invoke(ctx)


class CommandGroup(_WithExamples, click.Group):
    """A group of such commands, which reports unknown commands in the same way at every level."""

    command_class = LibraryCommand

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order in which they are used, not by name

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            if args[0].startswith("-"):  # an unknown option
                raise
            meant = " or ".join(f"'{one}'" for one in self._suggestions(ctx, args[0]))
            path = ctx.command_path.split()[1:]
            known = f"; known are {', '.join(self.list_commands(ctx))}" if path else ""  # not all of rcyaml's
            message = f"unknown command '{' '.join([*path, args[0]])}'"
            raise click.UsageError(message + (f"; did you mean {meant}?" if meant else known), ctx) from error

    def _suggestions(self, ctx: click.Context, word: str) -> list[str]:
        """The commands that were probably meant: a similar name of this group, or the same name in a subgroup."""
        from robocomp_yaml.diag.suggest import suggest

        path = ctx.command_path.split()[1:]
        own = self.list_commands(ctx)
        groups = {name: group for name in own if isinstance(group := self.get_command(ctx, name), click.Group)}
        below = [f"{name} {word}" for name, group in groups.items() if word in group.commands]
        if below:
            return below
        meant = suggest(word, own)
        return [" ".join([*path, meant])] if meant else []


@contextmanager
def _library_errors(ctx: click.Context) -> Iterator[None]:
    try:
        yield
    except Exception as error:
        from robocomp_yaml.diag.errors import Faulty, NoAnswer, Refused  # unused by `rcyaml --help`

        if isinstance(error, Refused):
            raise click.UsageError(str(error), ctx) from None
        if isinstance(error, NoAnswer):
            if ctx.params.get("format_") == "json":
                from robocomp_yaml.diag import terminal
                from robocomp_yaml.diag.render.json import dumps

                terminal.data(dumps({"error": error.message, "hint": error.hint}), json=True)
            raise click.ClickException(str(error)) from None
        if not isinstance(error, Faulty):
            raise
        _report(ctx, error)


def _report(ctx: click.Context, faulty: Faulty) -> None:
    """Prints the diagnostics: on standard error, because standard output is for values; as JSON on standard output."""
    from robocomp_yaml.commands import _options
    from robocomp_yaml.diag.render import tell

    is_json = ctx.params.get("format_") == "json"
    color = _options.colored(ctx, sys.stderr)
    format_ = "json" if is_json else "text"
    tell(format_, faulty.diagnostics, faulty.documents, color, err=not is_json, texts=faulty.texts)
    ctx.exit(1)
