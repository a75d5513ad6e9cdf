"""`rcyaml compile`: documents to Slice and components; writes only what changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _fail_on, _options
from robocomp_yaml.commands._command import Command
from robocomp_yaml.commands._plugged import Plugged

if TYPE_CHECKING:
    from robocomp_yaml.plugins import Plugins


def _targets(plugins: Plugins) -> list[str]:
    from robocomp_yaml import languages

    return ["slice", *languages.table(), *(one.name for one in plugins.languages), "config", "docs"]


@click.command(cls=Command, short_help="Write Slice and components; only what changed.")
@_options.paths
@click.option("-o", "--output", metavar="DIR", type=click.Path(file_okay=False), help="Write below DIR.")
@click.option("--standalone", is_flag=True, help="Give each component all that it needs, in its own folder.")
@click.option("--target", "targets", multiple=True, type=Plugged(_targets), help="Write only this; may be repeated.")
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
    ctx: click.Context, paths: tuple[str, ...], output: str | None, standalone: bool, targets: tuple[str, ...],
    dry_run: bool, diff: bool, check: bool, adopt: bool, merge: bool, fail_on: _fail_on.FailOn,
    include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Compile the documents at PATHS (by default, below this folder).

    An interface becomes Slice, in the workspace's slice folder. A component becomes a runnable program in its own
    folder: generated/ is always rewritten, src/ is yours and written only once. What your class lacks after an
    interface changed is named, with the text to paste; --merge puts it in.
    """
    from robocomp_yaml.api import made_already
    from robocomp_yaml.commands import _outcome

    paths = paths or (".",)
    look_only = dry_run or diff or check
    outcome = None
    if not (diff or merge or ctx.obj.verbosity > 0):
        outcome = made_already.outcome(paths, include, output, targets, standalone=standalone, planned=look_only)
    if outcome is None:
        from robocomp_yaml import api

        with _options.progress("reading", paths) as on_read:
            workspace = api.load(*paths, include=include, on_read=on_read)
        plan = workspace.compile(output=output, targets=targets, adopt=adopt, merge=merge, standalone=standalone)
        outcome = plan.look(with_diff=diff) if look_only else plan.apply()
    _outcome.report(ctx, outcome, format_, diff=diff, check=check, fail_on=fail_on)
