"""`rcyaml build`: builds components, and shows the progress."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TypeVar

import click
import msgspec

from robocomp_yaml.api import building, which
from robocomp_yaml.building.job import BUILT, CURRENT, FAILED, RELEASE, TYPES, BuildEvent, BuildResult, BuildStep
from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.commands._progress import LiveLines
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.render import text
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.pipeline import analyse

T = TypeVar("T")
_COLORS = {BUILT: "32", FAILED: "31", CURRENT: "2"}


@click.command(cls=LibraryCommand, short_help="Build the components that are not up to date.")
@click.argument("components", nargs=-1, metavar="[COMPONENT]...")
@click.option(
    "--type", "type_", type=click.Choice(TYPES, case_sensitive=False), help="The build type; default: Release."
)
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="The number of parallel steps; by default one per CPU.")
@click.option("-D", "defines", multiple=True, metavar="NAME=VALUE", help="A variable for CMake; may be repeated.")
@click.option("--clean", is_flag=True, help="Remove the build trees, and build nothing.")
@_options.reading
def command(
    ctx: click.Context, components: tuple[str, ...], type_: str | None, jobs: int | None, defines: tuple[str, ...],
    clean: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Build COMPONENTs (by name, folder or document; by default, all below this folder) as they were compiled last. The
    document of a deployment stands for the components that it starts.

    C++ is built with CMake and Ninja, with one build tree for all components of a workspace, build/TYPE/; Java with the
    JDK; Python is compiled to bytecode and imported once. If a component fails, the others are built all the same.
    """
    documents = building.documents(components)
    analysis = analyse(documents, include)
    if clean:
        gone = building.clean(analysis, documents, type_, everything=not components)
        if format_ == "json":
            terminal.data(dumps({"removed": gone}), json=True)
        elif ctx.obj.verbosity >= 0:
            terminal.say(*(f"removed  {folder}/" for folder in gone) if gone else ["no build tree exists"])
        return
    built = run(ctx, format_, lambda report: building.build(
        analysis, documents, build_type=type_ or RELEASE, jobs=jobs, defines=defines, report=report,
    ), "interrupted: the next build continues with the components that are not built yet")  # fmt: skip
    if format_ == "json":
        data = msgspec.to_builtins({"type": built.type, "components": built.components, "cpu": built.cpu})
        terminal.data(dumps({**data, "diagnostics": [as_data(one) for one in built.diagnostics]}), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(_summary(built))
    ctx.exit(1 if built.has_errors else 0)


def run(ctx: click.Context, format_: str, work: Callable[[Callable[[BuildEvent], None]], T], on_interrupt: str) -> T:
    """Runs a build and shows its progress. Ctrl-C ends the command."""
    try:
        with _View(ctx, format_) as view:
            return work(view.report)
    except KeyboardInterrupt as error:
        terminal.say(on_interrupt, err=True)
        ctx.exit(_signals.code_of(error))


def _summary(built: building.Built) -> str:
    counts = Counter(one.state for one in built.components)
    states = ", ".join(f"{counts[state]} {state}" for state in (BUILT, CURRENT, FAILED) if counts[state])
    total = len(built.components)
    return f"{total} component{'' if total == 1 else 's'}: {states}" if total else which.no_component()


class _View(LiveLines):
    """On a terminal, the current step; a line for each component that is built or fails; and the diagnostics, as soon
    as they are reported."""

    def __init__(self, ctx: click.Context, format_: str) -> None:
        self._is_text, self._verbosity = format_ == "text", ctx.obj.verbosity
        self._color = _options.colored(ctx)
        super().__init__(self._is_text and self._verbosity >= 0)

    def report(self, event: BuildEvent) -> None:
        if not self._is_text:
            return
        self.pause()
        if isinstance(event, BuildStep):
            self.draw([f"[{event.done}/{event.total}] {event.what}" if event.total else event.what])
        elif isinstance(event, Diagnostic):
            terminal.say(*text.each([event], self._color)[0], "")
        elif self._verbosity >= (1 if event.state == CURRENT else 0):
            terminal.say(_line(event, self._color))


def _line(result: BuildResult, color: bool) -> terminal.Shown:
    word = terminal.paint(terminal.pad(result.state, len(CURRENT)), _COLORS[result.state], color)
    return terminal.line(word, "  ", result.program if result.state != FAILED else result.name)
