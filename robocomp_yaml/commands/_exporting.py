"""What `rcyaml deploy export` writes."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands._deploying import Opened, end, show
from robocomp_yaml.deploy import exported
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import emitting
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from robocomp_yaml.emit.exports import Unwritable


def export(ctx: click.Context, opened: Opened, form: str, output: str | None) -> None:
    """Prints the files, or writes them below `output`. They may hold what a configuration holds: only their owner can
    read those that are written, and on a terminal secrets are hidden."""
    from robocomp_yaml.emit import exports
    from robocomp_yaml.network.hidden import hidden

    is_hidden = output is None and sys.stdout.isatty()
    network = hidden(opened.network) if is_hidden else opened.network
    try:
        with exports.noted() as notes:
            files = exports.export(network, form, opened.analysis.program.plugins_of(opened.path))
    except exports.Unwritable as refused:
        opened.told.append(_told(refused, form).as_severity(ERROR))
        end(ctx, opened)
        return
    found = list(dict.fromkeys(_told(note, form) for note in notes))
    opened.told += found
    if output is None:
        _show(files, opened.format_)
        show(ctx, opened, found)
        return
    try:
        for path in exported.in_the_way(output, files):
            opened.told.append(
                emitting.NOT_OURS.at(
                    Span(os.path.join(output, path)),
                    path=path,
                    hint="or it was edited since; move it away, or export to another folder",
                )
            )
        if not has_errors(opened.told):
            exported.write(output, files)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise click.UsageError(f"cannot write {error.filename or output}: {reason}") from error
    written = [] if has_errors(opened.told) else [os.path.normpath(os.path.join(output, path)) for path in files]
    if opened.format_ == "json":
        end(ctx, opened, {"written": written})
    for path in written if ctx.obj.verbosity >= 0 else ():
        terminal.say(f"wrote {path}")
    end(ctx, opened)


def _told(found: Unwritable, form: str) -> Diagnostic:
    return codes.NOT_IN_THIS_FORM.at(found.span, name=found.name, form=form, reason=found)


def _show(files: dict[str, str], format_: str) -> None:
    if format_ == "json":
        terminal.data(dumps({"files": files}), json=True)
        return
    for path, text in files.items():
        if len(files) > 1:
            terminal.data(f"# {path}\n")
        terminal.data(text if text.endswith("\n") else f"{text}\n")
