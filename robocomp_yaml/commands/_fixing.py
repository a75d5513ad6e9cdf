"""`rcyaml check --fix`: the fixes that documents get, and how it is told what was fixed, and what remains."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._fail_on import FailOn
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import SEVERITIES, Diagnostic
from robocomp_yaml.diag.render import tell
from robocomp_yaml.diag.render.json import dumps, fix_as_data, run_as_data
from robocomp_yaml.fixing.files import Written, write
from robocomp_yaml.fixing.rounds import MISSHAPEN, UNDERSTOOD, UNREADABLE, Done, Look, Mended, mend

if TYPE_CHECKING:
    from robocomp_yaml.pipeline import Analysis

Analyse = Callable[[Mapping[str, bytes]], "Analysis"]


class Fixing:
    """One run: `analyse` looks at the documents at `paths` with an overlay, `more` adds what other files say."""

    def __init__(
        self, paths: tuple[str, ...], analyse: Analyse, more: Callable[[Analysis], list[Diagnostic]], *, unsafe: bool,
        look_only: bool,
    ) -> None:  # fmt: skip
        self.analyse, self.more, self.look_only = analyse, more, look_only
        before = analyse({})
        self.before = before
        self.mended = mend(self._look, _asked(before), unsafe=unsafe)
        changed = ((path, before.contents[path], after) for path, after in sorted(self.mended.changed.items()))
        self.written = write(paths, changed, look_only=look_only)
        kept = {one.path for one in self.written if one.reason}
        self.mended.fixed, kept_back = (
            [one for one in self.mended.fixed if (one.diagnostic.span.file in kept) == is_kept]
            for is_kept in (False, True)
        )
        reasons = {one.path: one.reason for one in self.written}
        self.mended.left += [Done(one.diagnostic, one.fix, reasons[one.diagnostic.span.file]) for one in kept_back]

    def _look(self, changed: Mapping[str, bytes]) -> Look:
        analysis = self.before if not changed else self.analyse(_by_real_path(changed))
        levels = {
            document.path: UNREADABLE if document.tree is None else MISSHAPEN if document.model is None else UNDERSTOOD
            for document in analysis.linker.documents.read.values()
        }
        # Whether a comment allows something in vain is known once all is checked.
        told = self.more(analysis) if analysis.allowed.by_file else analysis.diagnostics
        return Look(told, analysis.contents, levels)

    def remaining(self) -> tuple[Analysis, list[Diagnostic]]:
        """What is found now, or would be."""
        after = self.mended.changed if self.look_only else {}
        changed = {path: content for path, content in after.items() if path not in self._refused}
        analysis = self.analyse(_by_real_path(changed))
        return analysis, self.more(analysis)

    @property
    def _refused(self) -> set[str]:
        return {one.path for one in self.written if one.reason}

    def diffs(self) -> Iterator[str]:
        from robocomp_yaml.emit.changes import unified

        hidden = self.before.hidden()
        for one in self.written:
            if not one.reason:
                yield hidden.without(unified(_text(one.before), _text(one.after), f"a/{one.path}", f"b/{one.path}"))


def _asked(analysis: Analysis) -> set[str]:
    """The documents that the user named, or that are below the folders that were named, with their state machines."""
    program, read = analysis.program, analysis.linker.documents.read
    machines = {
        path for real, linked in program.components.items() if real in program.asked for path in linked.machine_files
    }
    return {read[real].path for real in program.asked if real in read} | machines


def _by_real_path(changed: Mapping[str, bytes]) -> dict[str, bytes]:
    return {os.path.realpath(path): content for path, content in changed.items()}


def _text(content: bytes) -> str:
    return content.decode("utf-8", "surrogateescape")


def report(ctx: click.Context, fixing: Fixing, format_: str, fail_on: FailOn) -> None:
    """Prints what was fixed and what remains, and ends the command: with 1 too where a document could not be
    written."""
    analysis, told = fixing.remaining()
    documents, color = analysis.program.documents, _options.colored(ctx)
    refused = [one for one in fixing.written if one.reason]
    if format_ == "json":
        terminal.data(dumps(_as_data(fixing, told, documents)), json=True)
    elif format_ == "sarif":
        tell(format_, told, documents)
    elif fixing.look_only:
        terminal.diff(fixing.diffs(), color)
        terminal.say(*_left(fixing.mended, refused), _would(fixing.mended, told), err=True)
    else:
        if ctx.obj.verbosity >= 0:
            terminal.say(*(f"fixed  {_said(one)}" for one in fixing.mended.fixed))
        terminal.say(*_left(fixing.mended, refused))
        if ctx.obj.verbosity >= 0 or told:
            tell(format_, told, documents, color)
        fail_on.explain(told)
    ctx.exit(1 if refused else fail_on.code(told))


def _left(mended: Mended, refused: Iterable[Written]) -> Iterator[str]:
    files = {one.path for one in refused}
    yield from (f"left   {_said(one)}: {one.reason}" for one in mended.left if one.diagnostic.span.file not in files)
    yield from (f"left   {one.path}: {one.reason}" for one in refused)


def _said(one: Done) -> str:
    span = one.diagnostic.span
    return f"{span.file}:{span.line}:{span.column}: {one.fix.title} ({one.diagnostic.code})"


def _would(mended: Mended, told: list[Diagnostic]) -> str:
    counts = [
        f"{n} {severity}{'' if n == 1 else 's'}"
        for severity in SEVERITIES if (n := sum(one.severity == severity for one in told))
    ]  # fmt: skip
    count = len(mended.fixed)
    return f"{count} fix{'' if count == 1 else 'es'} to apply: {', '.join(counts) or 'nothing'} would remain"


def _as_data(fixing: Fixing, told: list[Diagnostic], documents: int) -> dict[str, Any]:
    mended = fixing.mended
    diffs = iter(fixing.diffs()) if fixing.look_only else None
    files = []
    for one in fixing.written:
        files.append({
            "path": one.path, "action": "refused" if one.reason else "fix" if fixing.look_only else "fixed",
            **({"reason": one.reason} if one.reason else {"diff": next(diffs)} if diffs is not None else {}),
        })  # fmt: skip
    return {
        **run_as_data(told, documents),
        "fixed": [_done_as_data(one) for one in mended.fixed],
        "not_fixed": [{**_done_as_data(one), "reason": one.reason} for one in mended.left],
        "files": files,
    }


def _done_as_data(one: Done) -> dict[str, Any]:
    span = one.diagnostic.span
    return {
        "code": one.diagnostic.code, "file": span.file, "line": span.line, "column": span.column,
        **fix_as_data(one.fix),
    }  # fmt: skip
