"""The command line: a table of commands, each imported only when it is called.

Only click is imported here, so that `rcyaml --help` answers at once.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import io
import os
import sys
from contextlib import suppress

import click

from robocomp_yaml import __version__

COMMANDS = {
    "init": "Make a folder a workspace that already checks.",
    "new": "Write a new document of any kind, which already checks.",
    "check": "Report everything that is wrong with the documents.",
    "compile": "Write Slice and components; only what changed.",
    "migrate": "Carry legacy files over to YAML, losing nothing.",
    "config": "Values of parameters: check, show, change, export.",
    "graph": "A picture of a deployment, or of components.",
    "deploy": "A network of components: plan, up, status, logs, down.",
    "schema": "Print the JSON Schema of a kind of document.",
    "explain": "Say what a diagnostic means, with examples.",
}


class Options:
    """What holds for every command. `verbosity`: -1 quiet, 0, 1 verbose; `color`: None = as the terminal wants."""

    def __init__(self, color: bool | None, verbosity: int) -> None:
        self.color, self.verbosity = color, verbosity


class LazyGroup(click.Group):
    """A group whose commands live in `robocomp_yaml.commands.NAME.command`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        return importlib.import_module(f"robocomp_yaml.commands.{cmd_name}").command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            from robocomp_yaml.diag.suggest import suggest

            meant = suggest(args[0], COMMANDS)
            error.message = f"there is no command '{args[0]}'" + (f"; did you mean '{meant}'?" if meant else "")
            raise


    def invoke(self, ctx: click.Context) -> object:
        try:
            return super().invoke(ctx)
        except click.NoSuchOption as error:
            name = error.option_name
            if any(name in option.opts for option in self.params):
                raise click.UsageError(f"'{name}' stands before the command: rcyaml {name} …", error.ctx) from None
            raise


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, "-V", "--version", prog_name="rcyaml")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", help="Colour the output.")
@click.option("-q", "--quiet", is_flag=True, help="Say only what is wrong.")
@click.option("-v", "--verbose", is_flag=True, help="Say what is done to each file.")
@click.pass_context
def group(ctx: click.Context, color: str, quiet: bool, verbose: bool) -> None:
    """The configuration compiler for component-based robotics.

    Interfaces and components are YAML documents; rcyaml checks them and compiles them to Ice Slice and to components
    that run.
    """
    wanted = {"always": True, "never": False}.get(color)
    if wanted is None and os.environ.get("NO_COLOR"):
        wanted = False
    ctx.color = wanted
    ctx.obj = Options(wanted, -1 if quiet else int(verbose))


def main() -> None:
    """Run rcyaml; the exit code is 0 (fine), 1 (the documents have errors) or 2 (wrong usage)."""
    gc.set_threshold(200_000, 20, 100)  # a run is short, and most of what it makes lives to its end
    end = _End()
    atexit.register(end.at_once)  # the first to be registered is the last to be called
    _make_streams_usable()
    try:
        group(prog_name="rcyaml")
    except SystemExit as error:
        end.code = error.code or 0
        raise
    except OSError as error:  # commands tell of files that fail them: this is the output itself
        reason = (error.strerror or str(error)).lower()
        print(f"Error: cannot write what there is to say: {reason}", file=sys.stderr)
        sys.exit(1)


class _End:
    """The end of the process, with the exit code once it is known."""

    code: int | str | None = None

    def at_once(self) -> None:
        """To give back piece by piece what a run made takes as long as a small run: the system takes all of it."""
        with suppress(OSError):  # what cannot be written, Python tells of
            sys.stdout.flush()
            sys.stderr.flush()
            if isinstance(self.code, int):
                os._exit(self.code)


def _make_streams_usable() -> None:
    """Standard streams that are closed swallow what they are given, and no character is refused: a name that is not
    text leaves as the bytes that it has on the disk, and what an old encoding lacks as a question mark."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (for the whole run)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    if isinstance(sys.stdout, io.TextIOWrapper):
        is_utf8 = sys.stdout.encoding.lower().replace("-", "") == "utf8"
        sys.stdout.reconfigure(errors="surrogateescape" if is_utf8 else "replace")
