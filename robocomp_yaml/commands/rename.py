"""`rcyaml rename`: one name, in all documents and in the user's code."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.renaming import Renaming


@click.command(cls=LibraryCommand, short_help="Rename an interface, method, parameter, host … everywhere.")
@click.argument("name")
@click.argument("new")
@click.option("--diff", "only_diff", is_flag=True, help="Show what would change, and write nothing.")
@_options.reading
def command(
    ctx: click.Context, name: str, new: str, only_diff: bool, include: tuple[str, ...], format_: str
) -> None:  # fmt: skip
    """Rename NAME to NEW in all documents of the workspace, in configurations, mock scripts and your code.

    NAME is a name (Speech, Speech.say, camera.width), with its kind if several have it (host:left), or its location,
    FILE:LINE:COLUMN. Nothing is written if something would be wrong, or mean something else. Compile afterwards:
    generated code follows the documents.
    """
    from robocomp_yaml import api
    from robocomp_yaml.diag.errors import NotRenamed
    from robocomp_yaml.link.workspace import root_above

    workspace = api.load(root_above("") or ".", include=include)
    try:
        renaming = workspace.rename(name, new)
        if not only_diff:
            renaming.apply()
    except NotRenamed as refused:
        if format_ == "json":
            from robocomp_yaml.diag.render.json import dumps

            terminal.data(dumps({"error": str(refused)}), json=True)
        raise click.ClickException(f"'{name}' is not renamed: {refused}") from None
    _report(ctx, renaming, format_, only_diff=only_diff)


def _report(ctx: click.Context, renaming: Renaming, format_: str, *, only_diff: bool) -> None:
    if format_ == "json":
        from robocomp_yaml.diag.render.json import dumps

        terminal.data(dumps({
            "name": renaming.what, "new": renaming.name, "written": bool(renaming.written) and not only_diff,
            "files": [
                {"path": one.path, "edits": sum(edit.span.file == one.path for edit in renaming.edits), "diff": diff}
                for one, diff in zip(renaming.written, renaming.diffs(), strict=True)
            ],
            "left": [{"file": one.file, "line": one.line, "column": one.column} for one in renaming.left],
        }), json=True)  # fmt: skip
        return
    if only_diff:
        terminal.diff(renaming.diffs(), _options.colored(ctx))
    elif ctx.obj.verbosity >= 0:
        for one in renaming.written:
            terminal.say(f"wrote {one.path}")
    if ctx.obj.verbosity >= 0:
        for span in renaming.left:
            terminal.say(
                f"left  {span.file}:{span.line}:{span.column}: the same word, with another meaning", err=only_diff
            )
        terminal.say(_words(renaming, would=only_diff), err=only_diff)


def _words(renaming: Renaming, *, would: bool) -> str:
    count, files = len(renaming.edits), len(renaming.written)
    done = f"{'would be renamed' if would else 'renamed'} to {renaming.name}"
    places = f"{count} place{'' if count == 1 else 's'} in {files} file{'' if files == 1 else 's'}"
    return f"{renaming.what} {done}: {places}" if count else f"{renaming.what} has this name already"
