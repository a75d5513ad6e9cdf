"""`rcyaml compile`: generates Slice and components, and writes only what changed."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NoReturn

import click

from robocomp_yaml.api.outcome import CHANGED, WRITTEN, File, Outcome
from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.render import tell
from robocomp_yaml.diag.render.json import dumps, run_as_data

if TYPE_CHECKING:
    from robocomp_yaml.api.workspace import Workspace
    from robocomp_yaml.plugins import Plugins

SHOWN = 6  # files of a folder with the same action that are listed; if there are more, their number is printed

_WORDS = {  # what was done, and what would be done
    "create": ("wrote", "would write"), "update": ("updated", "would update"), "edited": ("rewrote", "would rewrite"),
    "adopt": ("adopted", "would adopt"), "remove": ("removed", "would remove"), "left": ("left", "would leave"),
    "merge": ("merged", "would merge"), "kept": ("kept", "would keep"), "unchanged": ("unchanged", "unchanged"),
}  # fmt: skip


def _targets(plugins: Plugins) -> list[str]:
    from robocomp_yaml import languages

    return ["slice", *languages.table(), *(one.name for one in plugins.languages), "config", "docs"]


@click.command(cls=LibraryCommand, short_help="Generate Slice and components; write only what changed.")
@_options.paths
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR.")
@click.option("--standalone", is_flag=True, help="Put all that a component needs into its own folder.")
@click.option(
    "--target", "targets", multiple=True, type=PluginChoice(_targets), help="Write only this; may be repeated."
)
@click.option("--dry-run", is_flag=True, help="Print what would be written; write nothing.")
@click.option("--diff", is_flag=True, help="Show what would change in each file; write nothing.")
@click.option("--check", is_flag=True, help="Write nothing; exit with 1 if anything would change (for CI).")
@click.option("--adopt", is_flag=True, help="Overwrite files that rcyaml did not write; keep them as .orig.")
@click.option("--watch", is_flag=True, help="Compile again after each change, until Ctrl-C.")
@click.option("--merge", is_flag=True, help="Update your files in src/ by a three-way merge.")
@_options.fail_on
@_options.reporting
def command(
    ctx: click.Context, paths: tuple[str, ...], output: str | None, standalone: bool, targets: tuple[str, ...],
    dry_run: bool, diff: bool, check: bool, adopt: bool, merge: bool, watch: bool, fail_on: _options.FailOn,
    include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Compile the documents at PATHs (by default, below this folder).

    An interface is compiled to Slice, in the slice folder of the workspace. A component is compiled to a program in its
    own folder: generated/ is always rewritten; src/ is yours, and is written only once. If an interface changes, rcyaml
    reports the methods that your class lacks, with the text to paste; --merge adds them.
    """
    from robocomp_yaml.api import compile_stamps

    paths = paths or (".",)
    look_only = dry_run or diff or check
    if watch:
        if look_only or format_ != "text":
            raise click.UsageError(
                "--watch writes files and prints text: it needs no --dry-run, --diff, --check, --format"
            )
        _watch(
            ctx,
            paths,
            include,
            fail_on,
            output=output,
            targets=targets,
            adopt=adopt,
            merge=merge,
            standalone=standalone,
        )
    outcome = None
    if not (diff or merge or ctx.obj.verbosity > 0):
        arguments = compile_stamps.CompileArguments(paths, include, output, targets, standalone)
        outcome = compile_stamps.earlier_outcome(arguments, planned=look_only)
    if outcome is None:
        from robocomp_yaml import api

        with _options.progress("reading", paths) as on_read:
            workspace = api.load(*paths, include=include, on_read=on_read)
        plan = workspace.compile(output=output, targets=targets, adopt=adopt, merge=merge, standalone=standalone)
        outcome = plan.look(with_diff=diff) if look_only else plan.apply()
    _report(ctx, outcome, format_, fail_on, diff=diff, check=check)


def _watch(
    ctx: click.Context, paths: tuple[str, ...], include: tuple[str, ...], fail_on: _options.FailOn, **how: Any
) -> NoReturn:
    from robocomp_yaml.commands import _watching

    def run(workspace: Workspace) -> list[str]:
        outcome = workspace.compile(**how).apply()
        _tell(ctx, outcome, "text", fail_on)
        return [file.path for file in outcome.files if file.action in WRITTEN]

    _watching.watch(ctx, paths, include, run)


def _report(
    ctx: click.Context, outcome: Outcome, format_: str, fail_on: _options.FailOn, *, diff: bool, check: bool
) -> None:  # fmt: skip
    """Prints what was done, and ends the command."""
    _tell(ctx, outcome, format_, fail_on, diff=diff, check=check)
    ctx.exit(1 if check and outcome.dirty else fail_on.code(outcome.diagnostics))


def _tell(
    ctx: click.Context, outcome: Outcome, format_: str, fail_on: _options.FailOn, *, diff: bool = False,
    check: bool = False,
) -> None:  # fmt: skip
    """Prints what was done to the files and the diagnostics."""
    diagnostics, color = outcome.diagnostics, _options.colored(ctx)
    if format_ == "json":
        files = [
            {"path": file.path, "action": file.action, **({"orig": file.orig} if file.orig else {})}
            for file in outcome.files
        ]
        to_build = {"build": list(outcome.to_build)} if outcome.to_build else {}
        terminal.data(dumps({**run_as_data(diagnostics, outcome.documents), "files": files, **to_build}), json=True)
    elif format_ == "sarif":
        tell("sarif", diagnostics, outcome.documents)
    else:
        if diff:
            terminal.diff((file.diff for file in outcome.files), color)
        elif ctx.obj.verbosity >= 0 or check:
            terminal.say(*_listed(outcome, verbose=ctx.obj.verbosity > 0))
        if diagnostics:
            tell("text", diagnostics, outcome.documents, color)
        if ctx.obj.verbosity >= 0 and not diff:
            # without documents, the summary of the diagnostics says it
            summary = [_summary(outcome)] if outcome.asked or not diagnostics else []
            terminal.say(*_skipped(outcome), *summary, *_to_build(outcome))
        fail_on.explain(diagnostics)


def _listed(outcome: Outcome, verbose: bool) -> Iterator[str]:
    """One line for each file, or for many files with the same action in one folder. Unchanged files are listed only if
    `verbose`, and so are the user's files of a component without changes."""
    words = {action: pair[outcome.planned] for action, pair in _WORDS.items()}
    changed = {file.root for file in outcome.files if file.action in CHANGED}
    listed = [file for file in outcome.files if _is_listed(file, changed, verbose=verbose)]
    if not listed:
        return
    from robocomp_yaml.emit.layout import GENERATED  # unused if nothing is written
    from robocomp_yaml.source.relative import relative

    tops = {file: relative(file.path, file.root).partition("/") for file in listed}
    parted = {file.root for file, (top, _, _) in tops.items() if top == GENERATED}
    groups: dict[tuple[str, str, str], list[File]] = {}
    for file, (top, slash, _) in tops.items():
        folder = os.path.normpath(os.path.join(file.root, top)) if slash and file.root in parted else file.root
        groups.setdefault((file.root, file.action, folder), []).append(file)
    width = max(11 if outcome.planned else 7, *(len(words[action]) for _, action, _ in groups), 0)
    for (_, action, folder), group in groups.items():
        if len(group) > SHOWN and not verbose:
            yield f"{words[action]:<{width}}  {folder}/ ({len(group)} files)"
            continue
        for file in group:
            kept = f" (yours is {file.orig})" if file.orig else " (yours)" if action == "kept" else ""
            yield f"{words[action]:<{width}}  {file.path}{kept}"


def _is_listed(file: File, changed: set[str], *, verbose: bool) -> bool:
    idle = file.action == "unchanged" or (file.action == "kept" and file.root not in changed)
    return file.action != "refused" and (verbose or not idle)


def _summary(outcome: Outcome) -> str:
    counts = Counter(file.action for file in outcome.files)
    written = sum(counts[action] for action in WRITTEN)
    parts = [f"{written} file{'' if written == 1 else 's'} {'to write' if outcome.planned else 'written'}"]
    for action, words in (("remove", "removed"), ("unchanged", "unchanged"), ("kept", "yours")):
        if counts[action]:
            parts.append(f"{counts[action]} {words}")
    compiled = outcome.asked - len(outcome.left_out)
    skipped = f", {len(outcome.left_out)} skipped" if outcome.left_out else ""
    return f"{compiled} document{'' if compiled == 1 else 's'} compiled{skipped}: {', '.join(parts)}"


def _to_build(outcome: Outcome) -> Iterator[str]:
    names = outcome.to_build
    if names:
        command = terminal.typed("rcyaml", "build", *(names if len(names) == 1 else ()))
        yield f"build again: {some(names, SHOWN)}: `{command}`"


def _skipped(outcome: Outcome) -> Iterator[str]:
    """The documents that were skipped, and why."""
    for is_faulty, why in ((True, "it has errors"), (False, "a document that it depends on has errors")):
        paths = [path for path, itself in outcome.left_out.items() if itself == is_faulty]
        for path in paths[:SHOWN]:
            yield f"skipped: {path} ({why})"
        if len(paths) > SHOWN:
            yield f"skipped: {len(paths) - SHOWN} more"
