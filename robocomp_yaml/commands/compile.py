"""`rcyaml compile`: documents to Slice and components; writes only what changed."""

from __future__ import annotations

import click

from robocomp_yaml.commands import _options


@click.command(short_help="Write Slice and components; only what changed.")
@_options.paths
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR.")
@click.option("--target", "targets", multiple=True, type=click.Choice(["slice", "python", "cpp", "config"]),
              help="Write only this; may be repeated.")
@click.option("--dry-run", is_flag=True, help="Say what would be written, and write nothing.")
@click.option("--diff", is_flag=True, help="Show what would change in each file, and write nothing.")
@click.option("--check", is_flag=True, help="Write nothing; exit with 1 if anything would change (for CI).")
@click.option("--adopt", is_flag=True, help="Take over files that rcyaml did not write; keep them as .orig.")
@_options.include
@_options.format_
@click.pass_context
def command(
    ctx: click.Context, paths: tuple[str, ...], output: str | None, targets: tuple[str, ...], dry_run: bool,
    diff: bool, check: bool, adopt: bool, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Compile the documents at PATHS (by default, below this folder).

    An interface becomes Slice, in the workspace's slice folder. A component becomes a runnable program in its own
    folder: generated/ is always rewritten, src/ is yours and written only once.
    """
    from robocomp_yaml.commands import _compiling
    from robocomp_yaml.emit import writer

    paths = paths or (".",)
    with _options.progress("reading", paths) as on_read:
        from robocomp_yaml.pipeline import analyse

        analysis = analyse(paths, include, on_read)
    built = _compiling.build(analysis, output, targets)
    only_look = dry_run or diff or check
    recovered = [] if only_look else writer.recover(built.plans, built.others)
    changes = writer.prepare(built.plans, adopt=adopt, others=built.others)
    told = [*analysis.diagnostics, *built.diagnostics, *recovered, *changes.diagnostics]
    if not only_look:
        told += writer.commit(changes)
        told += _compiling.refresh_schemas(analysis)
    _compiling.report(ctx, changes, told, analysis, format_, dry_run=only_look, diff=diff, check=check)
