"""Options that several commands share, and how they report."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import click

from robocomp_yaml.commands._fail_on import ERRORS, FailOn
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.render import FORMATS, tell

MANY = 300  # documents: fewer are read before a bar could be seen

paths = click.argument("paths", nargs=-1, type=click.Path(exists=True))
include = click.option(
    "-I",
    "--include",
    "include",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
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


@contextmanager
def progress(label: str, paths: Iterable[str]) -> Iterator[Callable[[str], None]]:
    """A bar on standard error that counts documents, where someone watches and there are many."""
    if not sys.stderr.isatty():
        yield lambda path: None
        return
    from robocomp_yaml.source.discover import documents_below

    total = sum(1 for path in paths if os.path.isdir(path) for _ in documents_below(path))
    if total < MANY:
        yield lambda path: None
        return
    with click.progressbar(length=total, label=label, file=sys.stderr, update_min_steps=50) as bar:
        yield lambda path: bar.update(1)


async def ask(text: str, answers: tuple[str, ...]) -> str:
    """The user's answer, of which the first is the default. A thread waits for it that nobody waits for: Ctrl-C ends
    the question, too."""
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
        except click.Abort:  # there is nobody to answer
            answer = first
        with suppress(RuntimeError):  # the question was withdrawn
            loop.call_soon_threadsafe(settle, answer)

    threading.Thread(target=wait, daemon=True).start()
    return await answered


def report(
    ctx: click.Context, format_: str, diagnostics: Iterable[Diagnostic], documents: int, fail_on: FailOn = ERRORS
) -> None:  # fmt: skip
    """Prints the diagnostics and ends the command: with 1 where one is an error, or what `fail_on` says, else with
    0."""
    told = list(diagnostics)
    if ctx.obj.verbosity >= 0 or told:
        tell(format_, told, documents, colored(ctx))
    if format_ == "text":
        fail_on.explain(told)
    ctx.exit(fail_on.code(told))
