"""The command line: a table of commands, each imported when it is called.

This module imports little but click, so that `rcyaml --help` is fast.
"""

from __future__ import annotations

import atexit
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
    "init": "Make a folder a workspace.",
    "new": "Write a new document of any kind.",
    "check": "Report everything that is wrong with the documents.",
    "fmt": "Format documents; what they mean does not change.",
    "compile": "Generate Slice and components; write only what changed.",
    "build": "Build the components that are not up to date.",
    "run": "Run one component in the foreground, with what it needs.",
    "call": "Call a method of a running component.",
    "param": "Parameters of a running component: list, get, set, watch.",
    "topic": "The topics of a running network: list, echo, hz, pub.",
    "top": "Show what the processes of a deployment do, live.",
    "record": "Record topics to MCAP files, and play them.",
    "mock": "Serve interfaces and publish topics in place of components.",
    "migrate": "Convert legacy files to YAML documents, without loss.",
    "config": "Check, show, change and export the values of parameters.",
    "edit": "Change a deployment or a component; comments and layout stay.",
    "rename": "Rename an interface, method, parameter, host … everywhere.",
    "graph": "Draw a deployment, or the components of a folder.",
    "deploy": "Run a network of components: plan, up, status, logs, down.",
    "manager": "Serve a network to browsers and programs: see it, and change it.",
    "lsp": "Serve editors: diagnostics as you type, fixes, formatting.",
    "schema": "Print the JSON Schema of a kind of document.",
    "explain": "Explain a diagnostic, with examples.",
}


EPILOG = "`rcyaml COMMAND --help` describes each. Documentation: https://github.com/robocomp/rcyaml/tree/main/docs"


class _ReaderGone(Exception):
    """The reader of standard output closed the pipe. click would treat a BrokenPipeError as a failure."""


class LazyGroup(CommandGroup):
    """A group whose commands live in `robocomp_yaml.commands.NAME.command`."""

    def main(self, *args: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Runs a command line and reports what is wrong with it. Returns the exit code, or exits with it."""
        code = self._code(*args, **extra)
        if standalone_mode:
            sys.exit(code)
        return code

    def _code(self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any) -> int:
        try:
            code = super().main(args, prog_name, standalone_mode=False, **extra)
            return code if isinstance(code, int) else 0
        except click.ClickException as error:
            _report(error)
            return error.exit_code
        except click.Abort as error:
            cause = error.__cause__ or error.__context__
            if isinstance(cause, EOFError):
                terminal.say("Error: no answer to a question: the input has ended", err=True)
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
                raise click.UsageError(
                    f"'{name}' is an option of rcyaml: write it before the command, rcyaml {name} …", error.ctx
                ) from None
            raise


@click.group(
    cls=LazyGroup, epilog=EPILOG, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.version_option(__version__, "-V", "--version", prog_name="rcyaml")
@click.option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", help="Colour the output.")
@click.option("-q", "--quiet", is_flag=True, help="Print only what is wrong.")
@click.option("-v", "--verbose", is_flag=True, help="Print what is done to each file.")
@click.pass_context
def group(ctx: click.Context, color: str, quiet: bool, verbose: bool) -> None:
    """The configuration compiler for component-based robotics.

    Interfaces and components are YAML documents. rcyaml checks them, and compiles them to Ice Slice and to runnable
    components.
    """
    ctx.color = {"always": True, "never": False}.get(color, False if os.environ.get("NO_COLOR") else None)
    ctx.obj = SimpleNamespace(verbosity=-1 if quiet else int(verbose))


def _report(error: click.ClickException) -> None:
    """Prints what is wrong with a command line. The message quotes the command line, and is escaped as a document's."""
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        terminal.say_text(error.format_message(), err=True)
        return
    ctx = error.ctx if isinstance(error, click.UsageError) else None
    if ctx is not None:
        terminal.say_text(ctx.get_usage(), err=True)
        if ctx.command.get_help_option(ctx) is not None:
            terminal.say(f"Try '{ctx.command_path} {max(ctx.help_option_names, key=len)}' for help.", err=True)
        terminal.say("", err=True)
    if isinstance(error, click.BadParameter) and isinstance(error.param, click.Argument) and not error.param_hint:
        error.param_hint = f"'{error.param.human_readable_name.strip('[].')}'"  # [PATH]... is one PATH
    message = f"Error: {error.format_message()}"
    if isinstance(error, click.MissingParameter):  # a message of click, with several lines
        terminal.say_text(message, err=True)
    else:
        terminal.say(message, err=True)


def main() -> None:
    """Runs rcyaml and exits: with 0 (success), 1 (errors), 2 (wrong usage), or 128 plus the number of a signal."""
    end = _ProcessEnd()
    atexit.register(end.at_once)  # registered first, called last
    _make_streams_usable()
    try:
        with _signals.handled():
            end.code = group(prog_name="rcyaml", standalone_mode=False)
    except KeyboardInterrupt as error:  # while the command line returns
        end.code = _signals.code_of(error)
    except OSError as error:  # commands report the errors of files: this one is of standard output
        end.code = _output_failed(error)
    sys.exit(end.code)


def _forget_output() -> None:
    """Discards the buffered output, which nobody reads or which cannot be written. Otherwise Python writes it again at
    the end of the process, fails, and changes the exit code."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _output_failed(error: OSError) -> int:
    from robocomp_yaml.diag.errors import reason_of

    _forget_output()
    reason = reason_of(error)
    with suppress(OSError):
        terminal.say(f"Error: cannot write to standard output: {reason}", err=True)
    return 1


class _ProcessEnd:
    """The end of the process. `code` is the exit code, None until it is known."""

    code: int | None = None

    def at_once(self) -> None:
        """Ends the process without freeing its objects one by one, which takes as long as a small run."""
        with suppress(OSError, ValueError):  # Python reports what cannot be written; a server has closed its stream
            sys.stdout.flush()
            sys.stderr.flush()
            if self.code is not None:
                os._exit(self.code)


def _make_streams_usable() -> None:
    """Makes writing to the standard streams always possible: a closed stream discards its text, and a character that
    the encoding lacks becomes a question mark."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 (for the whole run)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
