"""Options and output that several commands share."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

import click
import msgspec

from robocomp_yaml.commands import _plugin_choices
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import ERROR, SEVERITIES, Diagnostic
from robocomp_yaml.diag.errors import Refused, reason_of
from robocomp_yaml.diag.render import FORMATS, tell

MANY = 300  # documents: fewer are read too fast for a progress bar

paths = click.argument("paths", metavar="[PATH]...", nargs=-1, type=click.Path(exists=True))


def _folders(ctx: click.Context, param: click.Parameter, folders: tuple[str, ...]) -> tuple[str, ...]:
    if folders:
        from robocomp_yaml.api.refusals import include_folders

        try:
            return include_folders(folders)
        except Refused as error:
            raise click.BadParameter(str(error)) from None
    return folders


include = click.option(
    "-I", "--include", multiple=True, metavar="DIR", type=click.Path(file_okay=False), callback=_folders,
    help="Also search DIR for imports; may be repeated.",
)  # fmt: skip


def format_of(choices: Sequence[str], meaning: str = "The output format.") -> Callable[[Any], Any]:
    return click.option("--format", "format_", type=click.Choice(choices), default="text", help=meaning)


format_, text_or_json = format_of(FORMATS), format_of(["text", "json"])


def together(*options: Callable[[Any], Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Options, in this order, as one decorator."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


# What most commands about documents have. The context is the first argument of their functions.
reporting = together(include, format_, click.pass_context)
reading = together(include, text_or_json, click.pass_context)


class FailOn(msgspec.Struct, frozen=True):
    """`--fail-on`: which diagnostics besides errors make a run fail: those of a severity that is at least `severity`,
    and those with one of the `codes`. `text` is as typed."""

    severity: str = ERROR
    codes: frozenset[str] = frozenset()
    text: str = ""

    def code(self, diagnostics: Iterable[Diagnostic]) -> int:
        """The exit code of a run with these diagnostics."""
        return 1 if any(self._counts(one) for one in diagnostics) else 0

    def explain(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Prints why a run without errors fails."""
        counting = [one for one in diagnostics if self._counts(one)]
        if counting and all(one.severity != ERROR for one in counting):
            codes = ", ".join(sorted({one.code for one in counting}))
            terminal.say(f"exit code 1 because of {codes} (--fail-on {self.text})", err=True)

    def _counts(self, one: Diagnostic) -> bool:
        worst = SEVERITIES.index(one.severity)  # sorted, the worst first
        return worst <= SEVERITIES.index(self.severity) or one.code in self.codes


def _fail_on(ctx: click.Context, param: click.Parameter, values: tuple[str, ...]) -> FailOn:
    words = [word.strip() for text in values for word in text.split(",")]
    severities = [word.lower() for word in words if word.lower() in SEVERITIES]
    codes = {word.upper(): word for word in words if word.lower() not in SEVERITIES}
    if codes:
        from robocomp_yaml.diag.codes import table
        from robocomp_yaml.diag.suggest import suggest

        known = dict(table())
        if not codes.keys() <= known.keys():
            known |= _plugin_choices.codes(ctx)
        for code, word in codes.items():
            if code not in known:
                meant = suggest(code.lower(), SEVERITIES) or suggest(code, known)
                hint = f"did you mean '{meant}'?" if meant else "`rcyaml explain` lists the codes"
                severity = f"{', '.join(SEVERITIES[:-1])} or {SEVERITIES[-1]}"
                raise click.BadParameter(f"'{word}' is neither {severity} nor the code of a diagnostic; {hint}")
    least = max(severities, key=SEVERITIES.index, default=ERROR)
    return FailOn(least, frozenset(codes), ",".join(words))


fail_on = click.option(
    "--fail-on", "fail_on", multiple=True, metavar="WHAT", callback=_fail_on,
    help="Also exit with 1 for these: warning, note, or codes such as RC2007,RC3107; may be repeated.",
)  # fmt: skip


def pairs(given: Iterable[str], form: str, *, can_be_empty: bool = False) -> dict[str, str]:
    """Arguments as names with values, which may be empty texts or not. `form` is shown to who writes something else."""
    found = {}
    for text in given:
        name, _, value = text.partition("=")
        if not name or not (value or (can_be_empty and "=" in text)):
            raise click.UsageError(f"'{text}' is not {form}")
        found[name] = value
    return found


def colored(ctx: click.Context, stream: Any = None) -> bool:
    """Whether output to a stream is coloured; by default, to standard output."""
    if ctx.color is not None:
        return ctx.color
    return bool((stream or sys.stdout).isatty())


@contextmanager
def progress(label: str, paths: Iterable[str]) -> Iterator[Callable[[str], None] | None]:
    """A progress bar on standard error that counts documents, if it is a terminal and there are many documents. Yields
    the function to call for each document, or None."""
    if sys.stderr.isatty():
        from robocomp_yaml.source.discover import documents_below

        total = sum(1 for path in paths if os.path.isdir(path) for _ in documents_below(path))
        if total >= MANY:
            with click.progressbar(length=total, label=label, file=sys.stderr, update_min_steps=50) as bar:
                yield lambda path: bar.update(1)
            return
    yield None


@contextmanager
def writing(path: str = "") -> Iterator[None]:
    """Ends the command with exit code 1 if a file cannot be written: this one, or the one of the error."""
    try:
        yield
    except OSError as error:
        named = path or error.filename or ""
        reason = reason_of(error)
        raise click.ClickException(f"cannot write {named}: {reason}" if named else f"cannot write: {reason}") from error


class FileReport:
    """What `init` or `new` does with files, as text or as JSON. It is printed when all is done: `| head -1` must not
    end a command that has written half of its files."""

    def __init__(self, ctx: click.Context, format_: str) -> None:
        self._is_json = format_ == "json"
        self._is_quiet = ctx.obj.verbosity < 0
        self._files: list[dict[str, str]] = []
        self._notes: list[str] = []

    @contextmanager
    def writing(self) -> Iterator[None]:
        """While files are written; afterwards, what was done is printed."""
        try:
            with writing():
                yield
        finally:
            if not self._is_json and not self._is_quiet:
                terminal.say(*(f"{one['done']:<5} {one['path']}" for one in self._files))

    def add(self, done: str, what: str) -> None:
        """What was done with a file, such as `wrote`; or `note`, with a text."""
        if done == "note":
            self._notes.append(what)
            terminal.say(f"note: {what}", err=True)
        else:
            self._files.append({"done": done, "path": what})

    def end(self, *following: str) -> None:
        """The commands that one types next."""
        if self._is_json:
            from robocomp_yaml.diag.render.json import dumps

            terminal.data(dumps({"files": self._files, "notes": self._notes, "next": list(following)}), json=True)
        elif not self._is_quiet:
            terminal.say(*(f"{'next:' if one is following[0] else '':<5} {one}" for one in following))


def print_value(ctx: click.Context, format_: str, path: str, data: Any, as_json: Callable[[object], str]) -> None:
    """Prints the value of a parameter. Without one, ends the command with 1."""
    from robocomp_yaml.source.yaml_text import flow

    if data is None:
        terminal.say(f"{path} has no value", err=True)
        ctx.exit(1)
    if format_ == "json":
        terminal.data(as_json({"path": path, "value": data}), json=True)
    else:
        terminal.data(f"{data if isinstance(data, str) else flow(data)}\n")


async def ask(text: str, answers: tuple[str, ...]) -> str:
    """The answer of the user; the first one is the default. It is read in a daemon thread, so that Ctrl-C also ends the
    question."""
    import asyncio
    import threading

    loop, first = asyncio.get_running_loop(), answers[0]
    answered: asyncio.Future[str] = loop.create_future()

    def settle(answer: str) -> None:
        if not answered.done():
            answered.set_result(answer)

    def wait() -> None:
        try:
            answer: str = click.prompt(text, type=click.Choice(answers), default=first)
        except click.Abort:  # the input has ended
            answer = first
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(settle, answer)

    threading.Thread(target=wait, daemon=True).start()
    return await answered


def report(
    ctx: click.Context, format_: str, diagnostics: Iterable[Diagnostic], documents: int, fail_on: FailOn = FailOn()
) -> NoReturn:  # fmt: skip
    """Prints the diagnostics and ends the command: with 1 if one is an error or counts for `fail_on`, else with 0."""
    shown = list(diagnostics)
    if ctx.obj.verbosity >= 0 or shown or format_ != "text":
        tell(format_, shown, documents, colored(ctx))
    if format_ == "text":
        fail_on.explain(shown)
    ctx.exit(fail_on.code(shown))
