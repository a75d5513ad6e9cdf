"""What a workspace consists of, besides documents: written by `init`, and by `new` where there is none yet."""

from __future__ import annotations

import os
from collections.abc import Iterator

import click
import msgspec

from robocomp_yaml.diag import terminal
from robocomp_yaml.transactions import whole_file


class WorkspaceView(msgspec.Struct, frozen=True):
    modeline: str


def make(ctx: click.Context, folder: str) -> None:
    """Writes what a workspace consists of, besides documents; raises OSError where that cannot be."""
    from robocomp_yaml.link import workspace_files

    for path, text in _files(folder):
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        try:
            whole_file.create(path, text)
            tell(ctx, "wrote", path)
        except FileExistsError:
            tell(ctx, "kept", path)
    for name in ("interfaces", "components"):
        os.makedirs(os.path.join(folder, name), exist_ok=True)
    for path in workspace_files.install(folder):
        tell(ctx, "wrote", path)
    problem = workspace_files.settings_problem(folder)
    if problem:
        terminal.say(f"note: {problem}", err=True)


def tell(ctx: click.Context, done: str, path: str) -> None:
    if ctx.obj.verbosity >= 0:
        terminal.say(f"{done:<5} {path}")


def unwritable(error: OSError) -> click.ClickException:
    where = f" {error.filename}" if error.filename else ""
    return click.ClickException(f"cannot write{where}: {error.strerror or error}")


def _files(folder: str) -> Iterator[tuple[str, str]]:
    from robocomp_yaml import resources
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.link.workspace_files import modeline
    from robocomp_yaml.source.discover import WORKSPACE_FILE

    path = os.path.normpath(os.path.join(folder, WORKSPACE_FILE))
    yield path, render("new/workspace.yaml.j2", WorkspaceView(modeline("workspace", path, folder)))
    yield os.path.normpath(os.path.join(folder, ".gitignore")), resources.text("templates/new/gitignore")
