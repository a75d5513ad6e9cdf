"""`rcyaml compile`: documents to Slice and components; writes only what changed."""

from __future__ import annotations

import os

import click

from robocomp_yaml import languages
from robocomp_yaml.commands import _fail_on, _options


@click.command(short_help="Write Slice and components; only what changed.")
@_options.paths
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR.")
@click.option("--target", "targets", multiple=True, type=click.Choice(["slice", *languages.table(), "config", "docs"]),
              help="Write only this; may be repeated.")
@click.option("--dry-run", is_flag=True, help="Say what would be written, and write nothing.")
@click.option("--diff", is_flag=True, help="Show what would change in each file, and write nothing.")
@click.option("--check", is_flag=True, help="Write nothing; exit with 1 if anything would change (for CI).")
@click.option("--adopt", is_flag=True, help="Take over files that rcyaml did not write; keep them as .orig.")
@click.option("--merge", is_flag=True, help="Bring your files in src/ up to date, by a three-way merge.")
@_fail_on.fail_on
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, paths: tuple[str, ...], output: str | None, targets: tuple[str, ...], dry_run: bool,
    diff: bool, check: bool, adopt: bool, merge: bool, fail_on: _fail_on.FailOn, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Compile the documents at PATHS (by default, below this folder).

    An interface becomes Slice, in the workspace's slice folder. A component becomes a runnable program in its own
    folder: generated/ is always rewritten, src/ is yours and written only once. What your class lacks after an
    interface changed is named, with the text to paste; --merge puts it in.
    """
    from robocomp_yaml.commands import _outcome
    from robocomp_yaml.emit import stamp

    paths = paths or (".",)
    look_only = dry_run or diff or check
    # A run that was made already, of which nothing changed since, is not made again: only told of.
    name = stamp.key([*paths, "-o", output or "", "-I", *include, "-t", *targets])
    folder = output or (paths[0] if os.path.isdir(paths[0]) else os.path.dirname(paths[0])) or "."
    made = None if diff or merge or ctx.obj.verbosity > 0 else stamp.load(folder, name)
    if made is not None and stamp.is_current(made, _options.find_below):
        outcome = _outcome.Outcome.of_data(made.replay)
        outcome.planned = look_only
    else:
        from robocomp_yaml.commands import _compiling

        run = _compiling.Run(paths, include, output, targets, look_only=look_only, adopt=adopt, merge=merge)
        outcome, made = run.carry_out(with_diff=diff)
        if made is not None:
            stamp.save(folder, name, made)
    _outcome.report(ctx, outcome, format_, diff=diff, check=check, fail_on=fail_on)
