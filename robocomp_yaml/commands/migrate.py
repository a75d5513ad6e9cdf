"""`rcyaml migrate`: converts legacy files to documents."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.render import tell
from robocomp_yaml.transactions import whole_file

if TYPE_CHECKING:
    from robocomp_yaml.legacy.result import MigrationRun
    from robocomp_yaml.legacy.sources import LegacyFile

LONG = 50
"""The number of files from which a progress bar is shown."""


@click.command(cls=LibraryCommand, short_help="Convert legacy files to YAML documents, without loss.")
@click.argument("paths", metavar="PATH...", nargs=-1, type=click.Path(exists=True))
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False),
              help="Write below DIR, in the folders of the sources; by default, beside each source.")  # fmt: skip
@click.option("--dry-run", is_flag=True, help="Print what would be written; write nothing.")
@click.option("--diff", "show_diff", is_flag=True, help="Show what changes, as a unified diff.")
@click.option("--report", metavar="FILE", type=click.Path(dir_okay=False, allow_dash=True),
              help="Write what happened to each line of each file, as JSON.")  # fmt: skip
@click.option("--strict", is_flag=True, help="Exit with 1 if a line of a source is lost.")
@click.option("--force", is_flag=True, help="Overwrite documents that were edited since; print the difference first.")
@click.option("--exact", is_flag=True, help="Keep the blanks around the separators of records and lists.")
@click.option("--names", multiple=True, metavar="KEY=a,b,c", help="The names of the columns of the rows KEY0, KEY1…")
@click.option("--rules", metavar="FILE", type=click.Path(exists=True, dir_okay=False),
              help="Corrections of guesses: `names:` and `types:` by key, "
                   "`text:` for keys that are no lists.")  # fmt: skip
@_options.reporting
def command(
    ctx: click.Context, paths: tuple[str, ...], output: str | None, dry_run: bool, show_diff: bool,
    report: str | None, strict: bool, force: bool, exact: bool, names: tuple[str, ...], rules: str | None,
    include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Write documents for the legacy files at PATHs: interfaces, components, their configs, and networks of them.

    A folder means all legacy files below it, and becomes a workspace. Comments are kept. Files that you wrote or edited
    are not overwritten, and the sources are not changed.
    """
    if not paths:
        raise click.UsageError("name legacy files or folders: `rcyaml migrate .` converts all below this folder", ctx)
    from robocomp_yaml.api.migrating import Migration
    from robocomp_yaml.legacy.ledger import as_json
    from robocomp_yaml.legacy.settings.corrections import CorrectionError, read_corrections

    try:
        guesses = read_corrections(names, rules)
    except (CorrectionError, OSError, UnicodeDecodeError) as error:
        raise click.UsageError(str(error)) from None
    if report is not None:
        _refuse_to_overwrite(report)
    migration = Migration(paths, output, include, force=force, progress=_progress, guesses=guesses, exact=exact)
    run = migration.run
    shown = run.changes() if show_diff else run.forced()
    for path, change in list(shown):
        terminal.data(change.diff(path), err=format_ != "text" or report == "-")
    if not dry_run:
        migration.apply()
    lost = migration.lost
    _print(ctx, run, format_, dry_run, err=report == "-")
    if report is not None:
        _save(report, as_json(run.entries))
    if strict and lost:
        terminal.say(f"{lost} line{'s are' if lost > 1 else ' is'} lost, which --strict does not allow", err=True)
    ctx.exit(1 if migration.has_errors or (strict and lost) else 0)


def _progress(files: Sequence[LegacyFile]) -> Iterator[LegacyFile]:
    if len(files) < LONG or not sys.stderr.isatty():
        yield from files
        return
    with click.progressbar(files, label="migrating", file=sys.stderr) as bar:
        yield from bar


def _refuse_to_overwrite(path: str) -> None:
    """Raises an error if a report would overwrite another file than an earlier report."""
    if not os.path.isfile(path):
        return
    with _options.writing(path), open(path, "rb") as file:
        words = file.read(40).split()
    if words and words[:2] != [b"{", b'"files":']:
        raise click.UsageError(f"--report does not overwrite {path}, which is not an earlier report")


def _save(path: str, text: str) -> None:
    if path == "-":
        terminal.data(text, json=True)
    else:
        with _options.writing(path):
            whole_file.replace(path, text.encode("utf-8", "backslashreplace"))


def _print(ctx: click.Context, run: MigrationRun, format_: str, dry_run: bool, *, err: bool) -> None:
    """Prints the diagnostics, each document if verbose, and a summary by format: on standard output, or on standard
    error if the report is written to standard output."""
    say = partial(terminal.say, err=err)
    diagnostics = run.diagnostics
    documents = sum(len(entry.outputs) for entry in run.entries)
    if format_ != "text" or diagnostics:
        tell(format_, diagnostics, documents, _options.colored(ctx, sys.stderr if err else None), err=err)
    if format_ != "text" or ctx.obj.verbosity < 0:
        return
    if ctx.obj.verbosity > 0:
        for root in run.roots.values():
            for output in root.outputs:
                say(f"{output.state:9} {root.root.shown(output.path)}")
    if run.entries:
        say(*_table(run))
    if dry_run:
        say("nothing was written (--dry-run)")


def _table(run: MigrationRun) -> list[terminal.Shown]:
    """The table of how many files of each format have which status."""
    from robocomp_yaml.legacy.ledger import STATUSES

    rows = [["", *STATUSES, "lines lost"]]
    formats = sorted({entry.format for entry in run.entries})
    for name in [*formats, *(["all"] if len(formats) > 1 else [])]:
        entries = [entry for entry in run.entries if name in ("all", entry.format)]
        counts = [sum(entry.status == status for entry in entries) for status in STATUSES]
        rows.append([name, *map(str, counts), str(sum(entry.lines()["lost"] for entry in entries))])
    return terminal.table(rows, right=range(1, len(rows[0])))
