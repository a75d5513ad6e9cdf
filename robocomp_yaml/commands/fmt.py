"""`rcyaml fmt`: documents in the one layout."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.formatting import Formatting

STDIN = "-"


@click.command(cls=LibraryCommand, short_help="Format documents; what they mean does not change.")
@click.argument("paths", nargs=-1, metavar="[PATH]...", type=click.Path(exists=True, allow_dash=True))
@click.option("--check", is_flag=True, help="Write nothing; exit with 1 if a document would change.")
@click.option("--diff", is_flag=True, help="Show what would change, and write nothing.")
@_options.text_or_json
@click.pass_context
def command(ctx: click.Context, paths: tuple[str, ...], check: bool, diff: bool, format_: str) -> None:
    """Lay out the documents at PATHs (by default, below this folder): indentation, blanks, quotes, blank lines.

    Comments, the order of keys, line breaks and the spelling of numbers stay, and so does what the documents mean.
    With "-", a document is read from standard input, and printed; with --check or --diff, as for files.
    """
    from robocomp_yaml.api.formatting import Formatting

    if STDIN in paths:
        if len(paths) > 1 or format_ != "text":
            raise click.UsageError(f"'{STDIN}' stands alone: it reads one document, and prints text")
        _filter(ctx, check=check, diff=diff)
    formatting = Formatting(paths or (".",))
    if not (check or diff):
        formatting.apply()
    _report(ctx, formatting, format_, check=check, diff=diff)


def _filter(ctx: click.Context, *, check: bool, diff: bool) -> None:
    from robocomp_yaml.api.formatting import layout
    from robocomp_yaml.source.formatting import Unformattable
    from robocomp_yaml.transactions.changes import unified

    raw = sys.stdin.buffer.read()
    after, faults = layout("<stdin>", raw)
    if isinstance(after, bytes):
        if diff and after != raw:
            changed = unified(raw.decode(), after.decode(), "a/<stdin>", "b/<stdin>")
            terminal.diff([changed], _options.colored(ctx))
        elif not check and not diff:
            terminal.data(after.decode())
        ctx.exit(1 if check and after != raw else 0)
    # there is no file whose line could be shown
    terminal.say(*(f"{one}; {one.hint}" if one.hint else str(one) for one in faults), err=True)
    if isinstance(after, Unformattable):
        terminal.say(f"left: {after}", err=True)
    ctx.exit(1)


def _report(ctx: click.Context, formatting: Formatting, format_: str, *, check: bool, diff: bool) -> None:
    from robocomp_yaml.diag.render import tell
    from robocomp_yaml.diag.render.json import dumps, run_as_data

    told, count = list(formatting.diagnostics), len(formatting.documents)
    changed = [one for one in formatting.written if not one.reason]
    if format_ == "json":
        diffs = formatting.diffs() if diff else None
        files = [
            {"path": one.path, "action": "left", "reason": one.reason} if one.reason
            else {"path": one.path, "action": "format" if check or diff else "formatted",
                  **({"diff": next(diffs)} if diffs else {})}
            for one in formatting.written
        ]  # fmt: skip
        terminal.data(dumps({**run_as_data(told, count), "files": files}), json=True)
    else:
        if diff:
            terminal.diff(formatting.diffs(), _options.colored(ctx))
        terminal.say(*_lines(formatting, ctx.obj.verbosity, would=check, listed=not diff))
        if told:
            tell("text", told, count, _options.colored(ctx))
        if ctx.obj.verbosity >= 0 and (count or not told):
            words = ("would be formatted" if check or diff else "formatted", "as they were")
            rest = count - len(formatting.written)
            terminal.say(f"{_documents(len(changed))} {words[0]}, {rest} {words[1]}", err=diff)
    ctx.exit(1 if formatting.has_errors or (check and changed) else 0)


def _lines(formatting: Formatting, verbosity: int, *, would: bool, listed: bool) -> Iterator[str]:
    for one in formatting.written:
        if one.reason:
            yield f"left       {one.path}: {one.reason}"
        elif listed and (verbosity >= 0 or would):
            yield f"{'would format' if would else 'formatted'}  {one.path}"


def _documents(count: int) -> str:
    return f"{count} document{'' if count == 1 else 's'}"
