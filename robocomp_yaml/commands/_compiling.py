"""What `rcyaml compile` does between the documents and the disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._outcome import File, Outcome
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.emit.fences import Fences
from robocomp_yaml.emit.build import Build, build
from robocomp_yaml.emit.layout import is_settings
from robocomp_yaml.emit.options import Options
from robocomp_yaml.emit.specific.review import Review, review
from robocomp_yaml.link import workspace_files
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.discover import documents_below
from robocomp_yaml.source.disk import NOTHING
from robocomp_yaml.source.regular import regular
from robocomp_yaml.transactions import stamp, writer
from robocomp_yaml.transactions.changes import Changes

if TYPE_CHECKING:
    from robocomp_yaml.emit.ports import Ports
    from robocomp_yaml.link.program import LinkedComponent


class Run(msgspec.Struct):
    """One compile. `look_only` writes nothing."""

    paths: tuple[str, ...]
    include: tuple[str, ...]
    output: str | None
    targets: tuple[str, ...]
    look_only: bool = False
    adopt: bool = False
    merge: bool = False
    _schemas: dict[str, bytes] = {}

    @property
    def fences(self) -> Fences:
        return Fences(self.paths, self.output)

    def carry_out(self, *, with_diff: bool = False) -> tuple[Outcome, stamp.Stamp | None]:
        """What it came to; with a stamp where the same run need not be made again while nothing changes."""
        with _options.progress("reading", self.paths) as on_read:
            analysis = analyse(self.paths, self.include, on_read)
        options = Options(
            self.output, analysis.found.folders, frozenset(self.targets), analysis.linker.workspace_of, _ports(analysis)
        )
        built = build(analysis.program, analysis.diagnostics, options)
        self.fences.keep_inside(built)
        others = self._other_roots(analysis)
        recovered = [] if self.look_only else writer.recover(built.plans, others)
        own = review(built.plans, merge=self.merge)
        changes = writer.prepare(built.plans, adopt=self.adopt, others=others, merges=own.merges)
        if not self.look_only:
            changes = writer.commit(changes)
            self._refresh_schemas(analysis)
        lasting = analysis.with_more([*built.diagnostics, *own.diagnostics])
        told = [*lasting, *recovered, *changes.diagnostics]
        outcome = _outcome_of(analysis, built, changes, in_order(told), with_diff=with_diff)
        outcome.planned = self.look_only
        passing = [one for one in told if one not in lasting]
        if self.look_only or has_errors(passing) or self.merge:
            return outcome, None
        return outcome, self._stamp(analysis, own, changes, outcome.settled(lasting, changes))

    def _other_roots(self, analysis: Analysis) -> list[str]:
        """The folders in which a document that is gone may have left something."""
        others = list(analysis.found.roots)
        if self.output is not None and analysis.found.folders and os.path.isdir(self.output):
            for _ in documents_below(self.output, others):
                pass
        return others

    def _refresh_schemas(self, analysis: Analysis) -> None:
        """Brings the schemas up to date that editors read. A workspace that cannot be written to has compiled all the
        same."""
        fences = Fences(self.paths, None)
        for workspace in analysis.linker.workspaces.values():
            if not fences.hold(workspace.root):
                continue
            try:
                workspace_files.install(Path(workspace.root))
            except OSError:
                continue
            for kind in workspace_files.GLOBS:
                path = os.path.normpath(os.path.join(workspace.root, workspace_files.schema_path(kind)))
                with open(path, "rb", opener=regular) as file:
                    self._schemas[path] = file.read()

    def _stamp(self, analysis: Analysis, own: Review, changes: Changes, again: Outcome) -> stamp.Stamp | None:
        """What the same run made again would come to, errors too; None where something could not be read: that may
        change without any trace."""
        disk = analysis.disk
        walked = {folder: stamp.walked(folder) for folder in disk.walked}  # there may be new roots since this run
        if disk.unreadable or any(walked[folder][: len(found)] != found for folder, found in disk.walked.items()):
            return None
        settled, once = changes.settled, changes.once
        ours = {os.path.normpath(path) for path in settled}
        there = ours | {os.path.normpath(path) for path in once}  # since this run
        there |= {folder for path in there for folder in _above(path)}
        states = disk.states | dict.fromkeys((*own.absent, *changes.journals), NOTHING)
        return stamp.take(
            inputs={path: raw for path, raw in {**disk.contents, **own.contents}.items() if path not in ours},
            states={path: state for path, state in states.items() if os.path.normpath(path) not in there},
            listed=disk.listed,
            names={**disk.seen, **own.names},
            walked=walked,
            outputs=settled | self._schemas,
            present=once,
            replay=again.as_data(),
        )


def _above(path: str) -> Iterator[str]:
    while (path := os.path.dirname(path)) not in ("", "/"):
        yield path


def _outcome_of(
    analysis: Analysis, built: Build, changes: Changes, told: list[Diagnostic], *, with_diff: bool
) -> Outcome:
    hidden = analysis.hidden() if with_diff else Hidden()
    files = [
        File(
            root.root, change.path, change.action, change.orig,
            hidden.without(change.diff(properties=is_settings(change.path))) if with_diff else "",
        )  # fmt: skip
        for root in changes.roots
        for change in root.changes
    ]
    files = list({file.path: file for file in files}.values())  # of roots in each other, both may have one
    program, read = analysis.program, analysis.linker.documents.read
    faulty = {os.path.realpath(one.span.file) for one in told if one.severity == ERROR}
    left_out = {read[real].path: real in faulty for real in built.left_out & program.asked}
    return Outcome(told, files, program.documents, len(program.asked), dict(sorted(left_out.items())))


def _ports(analysis: Analysis) -> Callable[[LinkedComponent], Ports]:
    """Where the ports of a component's workspace come from, once some are asked for."""

    @cache
    def table() -> Callable[[LinkedComponent], Ports]:
        from robocomp_yaml.commands._neighbours import ports

        return ports(analysis)

    return lambda linked: table()(linked)
