"""How builds are run, shown while they go on, and told of."""

from __future__ import annotations

import shutil
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TypeVar

import click
import msgspec

from robocomp_yaml.api import building
from robocomp_yaml.building.job import BUILT, CURRENT, FAILED, Event, Result, Step
from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.render import text
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.pipeline import Analysis, analyse

T = TypeVar("T")
_COLORS = {BUILT: "32", FAILED: "31", CURRENT: "2"}


def build(
    ctx: click.Context, components: Sequence[str], include: tuple[str, ...], type_: str, jobs: int | None,
    defines: Sequence[str], format_: str,
) -> None:  # fmt: skip
    analysis, documents = _read(components, include)
    built = run(ctx, format_, lambda report: building.build(
        analysis, documents, build_type=type_, jobs=jobs, defines=defines, report=report,
    ), "interrupted: what was built stays, and the next build goes on from there")  # fmt: skip
    if format_ == "json":
        terminal.data(dumps(data(built)), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(summary(built))
    ctx.exit(1 if built.has_errors else 0)


def clean(
    ctx: click.Context, components: Sequence[str], include: tuple[str, ...], type_: str | None, format_: str
) -> None:  # fmt: skip
    analysis, documents = _read(components, include)
    gone = building.clean(analysis, documents, type_, everything=not components)
    if format_ == "json":
        terminal.data(dumps({"removed": gone}), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(*(f"removed  {folder}/" for folder in gone) if gone else ["there is no build tree"])
    ctx.exit(0)


def run(ctx: click.Context, format_: str, work: Callable[[Callable[[Event], None]], T], on_interrupt: str) -> T:
    """A build that is shown; Ctrl-C ends the command."""
    try:
        with _View(ctx, format_) as view:
            return work(view.report)
    except KeyboardInterrupt as error:
        terminal.say(on_interrupt, err=True)
        ctx.exit(_signals.code_of(error))
        raise


def data(built: building.Built) -> dict[str, object]:
    return {
        "type": built.type,
        "components": msgspec.to_builtins(built.components),
        "cpu": built.cpu,
        "diagnostics": [as_data(one) for one in built.diagnostics],
    }


def summary(built: building.Built) -> str:
    counts = Counter(one.state for one in built.components)
    told = ", ".join(f"{counts[state]} {state}" for state in (BUILT, CURRENT, FAILED) if counts[state])
    total = len(built.components)
    return f"{total} component{'' if total == 1 else 's'}: {told}" if total else "there is no component"


def _read(components: Sequence[str], include: tuple[str, ...]) -> tuple[Analysis, list[str]]:
    documents = building.documents(components)
    return analyse(documents, include), documents


class _View:
    """On a terminal the step that is being taken; a line for each component that is built or fails, and what compilers
    say, as soon as they say it."""

    def __init__(self, ctx: click.Context, format_: str) -> None:
        self._is_text, self._verbosity = format_ == "text", ctx.obj.verbosity
        self._is_live = self._is_text and self._verbosity >= 0 and sys.stdout.isatty()
        self._color, self._drawn = _options.colored(ctx), False

    def __enter__(self) -> _View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._take_away()

    def report(self, event: Event) -> None:
        if not self._is_text:
            return
        self._take_away()
        if isinstance(event, Step):
            if self._is_live:
                count = f"[{event.done}/{event.total}] " if event.total else ""
                terminal.say(terminal.cut(f"{count}{event.what}", shutil.get_terminal_size().columns - 1))
                self._drawn = True
        elif isinstance(event, Diagnostic):
            terminal.say(*text.each([event], self._color)[0], "")
        elif event.state != CURRENT or self._verbosity > 0:
            if self._verbosity >= 0:
                terminal.say(_line(event, self._color))

    def _take_away(self) -> None:
        if self._drawn:
            terminal.erase(1)
            self._drawn = False


def _line(result: Result, color: bool) -> terminal.Shown:
    word = terminal.paint(terminal.pad(result.state, len(CURRENT)), _COLORS[result.state], color)
    return terminal.line(word, "  ", result.program if result.state != FAILED else result.name)
