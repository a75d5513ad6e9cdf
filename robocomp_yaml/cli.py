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
from collections.abc import Sequence
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import click

from robocomp_yaml import __version__
from robocomp_yaml.commands import _signals
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.diag import terminal

COMMANDS = {
    "init": "Make a folder a workspace that already checks.",
    "new": "Write a new document of any kind, which already checks.",
    "check": "Report everything that is wrong with the documents.",
    "compile": "Write Slice and components; only what changed.",
    "build": "Build components; only what is not what it is made of.",
    "migrate": "Carry legacy files over to YAML, losing nothing.",
    "config": "Values of parameters: check, show, change, export.",
    "graph": "A picture of a deployment, or of components.",
    "deploy": "A network of components: plan, up, status, logs, down.",
    "schema": "Print the JSON Schema of a kind of document.",
    "explain": "Say what a diagnostic means, with examples.",
}


class _ReaderGone(Exception):
    """Whoever reads what is printed has had enough, which click takes for a failure."""


class LazyGroup(CommandGroup):
    """A group whose commands live in `robocomp_yaml.commands.NAME.command`."""

    def main(self, *args: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Runs a command line, and tells what is wrong with it; returns the exit code, or ends with it."""
        code = self._code(*args, **extra)
        if standalone_mode:
            sys.exit(code)
        return code

    def _code(self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any) -> int:
        try:
            code = super().main(args, prog_name, standalone_mode=False, **extra)
            return code if isinstance(code, int) else 0
        except click.ClickException as error:
            _tell(error)
            return error.exit_code
        except click.Abort as error:
            cause = error.__cause__ or error.__context__
            if isinstance(cause, EOFError):
                terminal.say("Error: there was a question, and no answer", err=True)
                return 1
            return _signals.code_of(cause)
        except _ReaderGone:
            _forget_output()
            return _signals.READER_GONE

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = importlib.import_module(f"robocomp_yaml.commands.{cmd_name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def make_context(self, *args: Any, **extra: Any) -> click.Context:
        try:
            return super().make_context(*args, **extra)
        except BrokenPipeError as error:
            raise _ReaderGone from error

    def invoke(self, ctx: click.Context) -> object:
        try:
            return super().invoke(ctx)
        except BrokenPipeError as error:
            raise _ReaderGone from error
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
    ctx.obj = SimpleNamespace(verbosity=-1 if quiet else int(verbose))


def _tell(error: click.ClickException) -> None:
    """What is wrong with a command line. It quotes what was typed, which is no more to be trusted than a document."""
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        terminal.say_text(error.format_message(), err=True)
        return
    ctx = error.ctx if isinstance(error, click.UsageError) else None
    if ctx is not None:
        terminal.say_text(ctx.get_usage(), err=True)
        if ctx.command.get_help_option(ctx) is not None:
            terminal.say(f"Try '{ctx.command_path} {max(ctx.help_option_names, key=len)}' for help.", err=True)
        terminal.say("", err=True)
    message = f"Error: {error.format_message()}"
    if isinstance(error, click.MissingParameter):  # a text of click's own, of several lines
        terminal.say_text(message, err=True)
    else:
        terminal.say(message, err=True)


def main() -> None:
    """Run rcyaml; the exit code is 0 (fine), 1 (the documents have errors), 2 (wrong usage), or what signals give."""
    gc.set_threshold(200_000, 20, 100)  # a run is short, and most of what it makes lives to its end
    end = _ProcessEnd()
    atexit.register(end.at_once)  # the first to be registered is the last to be called
    _make_streams_usable()
    try:
        with _signals.handled():
            end.code = group(prog_name="rcyaml", standalone_mode=False)
    except KeyboardInterrupt as error:  # on the way out
        end.code = _signals.code_of(error)
    except OSError as error:  # commands tell of files that fail them: this is the output itself
        end.code = _output_failed(error)
    sys.exit(end.code)


def _forget_output() -> None:
    """What is not written yet goes nowhere, where nobody reads it or it cannot be written: Python tries again at the
    end of the process, and would give that an exit code of its own."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _output_failed(error: OSError) -> int:
    _forget_output()
    reason = (error.strerror or str(error)).lower()
    with suppress(OSError):
        terminal.say(f"Error: cannot write what there is to say: {reason}", err=True)
    return 1


class _ProcessEnd:
    """The end of the process, with the exit code once it is known."""

    code: int | None = None

    def at_once(self) -> None:
        """To give back piece by piece what a run made takes as long as a small run: the system takes all of it."""
        with suppress(OSError):  # what cannot be written, Python tells of
            sys.stdout.flush()
            sys.stderr.flush()
            if self.code is not None:
                os._exit(self.code)


def _make_streams_usable() -> None:
    """Standard streams that are closed swallow what they are given, and no character is refused: what an old encoding
    lacks leaves as a question mark."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 (for the whole run)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
