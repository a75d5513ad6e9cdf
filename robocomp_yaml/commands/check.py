"""`rcyaml check`: reports all diagnostics of documents, and applies fixes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NoReturn

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import SEVERITIES, Diagnostic
from robocomp_yaml.diag.render import tell
from robocomp_yaml.diag.render.json import dumps, fix_as_data, run_as_data

if TYPE_CHECKING:
    from robocomp_yaml.api.fixing import Fixing
    from robocomp_yaml.api.workspace import Workspace
    from robocomp_yaml.fixing import AttemptedFix


@click.command(cls=LibraryCommand, short_help="Report everything that is wrong with the documents.")
@_options.paths
@click.option("--environment", is_flag=True, help="Also report libraries, programs and hosts that are missing.")
@click.option("--code", is_flag=True, help="Also run a type checker over the components' code in Python.")
@click.option("--fix", is_flag=True, help="Apply the fixes that leave only one possible meaning.")
@click.option("--unsafe-fixes", is_flag=True, help="Apply the other fixes too, which are guesses.")
@click.option("--diff", is_flag=True, help="Show what the fixes would change; write nothing.")
@click.option("--watch", is_flag=True, help="Check again after each change, until Ctrl-C.")
@_options.fail_on
@_options.reporting
def command(
    ctx: click.Context, paths: tuple[str, ...], environment: bool, code: bool, fix: bool, unsafe_fixes: bool,
    diff: bool, watch: bool, fail_on: _options.FailOn, include: tuple[str, ...], format_: str,
) -> None:  # fmt: skip
    """Report everything that is wrong with the documents at PATHs (by default, below this folder).

    A folder means all documents below it. Documents that they import are checked too.
    """
    from robocomp_yaml import api

    paths = paths or (".",)
    if watch:
        if fix or unsafe_fixes or diff or format_ != "text":
            raise click.UsageError("--watch prints text, and applies no fixes", ctx)
        _watch(ctx, paths, include, fail_on, environment=environment)
    if fix or unsafe_fixes or diff:
        fixing = api.load(*paths, include=include).fix(unsafe=unsafe_fixes, environment=environment, code=code)
        _fix(ctx, fixing, format_, fail_on, look_only=diff)
    with _options.progress("reading", paths) as on_read:
        workspace = api.load(*paths, include=include, on_read=on_read)
    diagnostics = workspace.check(environment=environment, code=code)
    _options.report(ctx, format_, diagnostics, workspace.documents_read, fail_on)


def _watch(
    ctx: click.Context, paths: tuple[str, ...], include: tuple[str, ...], fail_on: _options.FailOn, *, environment: bool
) -> NoReturn:
    from robocomp_yaml.commands import _watching

    def run(workspace: Workspace) -> tuple[()]:
        diagnostics = workspace.check(environment=environment)
        if ctx.obj.verbosity >= 0 or diagnostics:
            tell("text", diagnostics, workspace.documents_read, _options.colored(ctx))
        fail_on.explain(diagnostics)
        return ()

    _watching.watch(ctx, paths, include, run)


def _fix(ctx: click.Context, fixing: Fixing, format_: str, fail_on: _options.FailOn, *, look_only: bool) -> None:
    """Applies the fixes unless `look_only`, prints them and what remains, and ends the command: also with 1 if a
    document cannot be written."""
    if not look_only:
        fixing.apply()
    diagnostics, documents, color = fixing.diagnostics, fixing.remaining.documents_read, _options.colored(ctx)
    if format_ == "json":
        terminal.data(dumps(_as_data(fixing, diagnostics, documents, look_only)), json=True)
    elif format_ == "sarif":
        tell(format_, diagnostics, documents)
    elif look_only:
        terminal.diff(fixing.diffs(), color)
        terminal.say(*_not_applied(fixing), _summary(fixing, diagnostics), err=True)
    else:
        if ctx.obj.verbosity >= 0:
            terminal.say(*(f"fixed  {_described(one)}" for one in fixing.fixed))
        terminal.say(*_not_applied(fixing))
        if ctx.obj.verbosity >= 0 or diagnostics:
            tell(format_, diagnostics, documents, color)
        fail_on.explain(diagnostics)
    ctx.exit(1 if fixing.refused else fail_on.code(diagnostics))


def _not_applied(fixing: Fixing) -> Iterator[str]:
    files = fixing.refused
    left = [one for one in fixing.left if one.diagnostic.span.file not in files]
    yield from (f"left   {_described(one)}: {one.reason}" for one in left)
    yield from (f"left   {one.path}: {one.reason}" for one in fixing.written if one.reason)


def _described(one: AttemptedFix) -> str:
    span = one.diagnostic.span
    return f"{span.file}:{span.line}:{span.column}: {one.fix.title} ({one.diagnostic.code})"


def _summary(fixing: Fixing, diagnostics: list[Diagnostic]) -> str:
    counts = [
        f"{n} {severity}{'' if n == 1 else 's'}"
        for severity in SEVERITIES if (n := sum(one.severity == severity for one in diagnostics))
    ]  # fmt: skip
    count = len(fixing.fixed)
    return f"{count} fix{'' if count == 1 else 'es'} to apply: {', '.join(counts) or 'nothing'} would remain"


def _as_data(fixing: Fixing, diagnostics: list[Diagnostic], documents: int, look_only: bool) -> dict[str, Any]:
    diffs = iter(fixing.diffs()) if look_only else None
    files = []
    for one in fixing.written:
        files.append({
            "path": one.path, "action": "refused" if one.reason else "fix" if look_only else "fixed",
            **({"reason": one.reason} if one.reason else {"diff": next(diffs)} if diffs is not None else {}),
        })  # fmt: skip
    return {
        **run_as_data(diagnostics, documents),
        "fixed": [_fix_as_data(one) for one in fixing.fixed],
        "not_fixed": [{**_fix_as_data(one), "reason": one.reason} for one in fixing.left],
        "files": files,
    }


def _fix_as_data(one: AttemptedFix) -> dict[str, Any]:
    span = one.diagnostic.span
    return {
        "code": one.diagnostic.code, "file": span.file, "line": span.line, "column": span.column,
        **fix_as_data(one.fix),
    }  # fmt: skip
