"""A compile: what it would write, as data, and the writing of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from functools import cache, cached_property
from typing import TYPE_CHECKING

from msgspec.structs import replace

from robocomp_yaml.api import made_already
from robocomp_yaml.api.outcome import File, Outcome
from robocomp_yaml.diag.codes.files import PLUGIN_FAILED
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.emit.allowed_folders import AllowedFolders
from robocomp_yaml.emit.build import Build, build
from robocomp_yaml.emit.layout import is_settings
from robocomp_yaml.emit.options import EmitOptions
from robocomp_yaml.emit.specific.review import Review, review
from robocomp_yaml.link import workspace_files
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import documents_below
from robocomp_yaml.source.disk import NOTHING
from robocomp_yaml.source.regular import whole
from robocomp_yaml.transactions import stamp, writer
from robocomp_yaml.transactions.changes import Changes

if TYPE_CHECKING:
    from robocomp_yaml.emit.ports import PortTable
    from robocomp_yaml.link.program import LinkedComponent


class Compilation:
    """What compiling the documents of a workspace comes to. Nothing is written before `apply`.

    `diagnostics`, `files` (each with its `action`) and `dirty` (whether a file that a user sees would change) say what
    `apply` would do; it writes what the documents were when they were loaded.
    """

    def __init__(
        self, analysis: Analysis, paths: Sequence[str], include: Sequence[str], output: str | None,
        targets: Sequence[str], *, adopt: bool, merge: bool, standalone: bool = False,
    ) -> None:  # fmt: skip
        self._analysis, self._adopt, self._merge, self._standalone = analysis, adopt, merge, standalone
        self._paths, self._include, self._output, self._targets = tuple(paths), tuple(include), output, tuple(targets)
        options = EmitOptions(
            output,
            analysis.found.folders,
            frozenset(targets),
            analysis.linker.workspace_of,
            _ports(analysis),
            standalone=standalone,
        )
        self._built = build(analysis.program, analysis.diagnostics, options)
        AllowedFolders(self._paths, output).restrict(self._built)

    @cached_property
    def outcome(self) -> Outcome:
        """What would be done, without diffs."""
        return self.look()

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        return self.outcome.diagnostics

    @property
    def files(self) -> tuple[File, ...]:
        return self.outcome.files

    @property
    def dirty(self) -> bool:
        return self.outcome.dirty

    @property
    def has_errors(self) -> bool:
        """Whether a diagnostic is an error: documents without one are compiled all the same."""
        return has_errors(self.diagnostics)

    def look(self, *, with_diff: bool = False) -> Outcome:
        """What `apply` would do now; each file with its unified diff where that is asked for."""
        own = review(self._built.plans, merge=self._merge)
        changes = self._prepare(own, self._other_roots())
        told = in_order([*self._lasting(own), *changes.diagnostics])
        return replace(_outcome_of(self._analysis, self._built, changes, told, with_diff=with_diff), planned=True)

    def apply(self) -> Outcome:
        """Writes all or nothing, and says what was done. Where something cannot be written, the diagnostics say so,
        and the files that it concerns are `refused`."""
        others = self._other_roots()
        recovered = writer.recover(self._built.plans, others)
        own = review(self._built.plans, merge=self._merge)
        changes = writer.commit(self._prepare(own, others))
        schemas = self._refresh_schemas()
        lasting = self._lasting(own)
        told = [*lasting, *recovered, *changes.diagnostics]
        outcome = _outcome_of(self._analysis, self._built, changes, in_order(told), with_diff=False)
        if not self._merge and not has_errors(one for one in told if one not in lasting):
            taken = self._stamp(own, changes, schemas, outcome.settled(lasting, changes))
            if taken is not None:
                made_already.keep(
                    taken, self._paths, self._include, self._output, self._targets, standalone=self._standalone
                )
        return replace(outcome, to_build=self._to_build()) if outcome.dirty and self._output is None else outcome

    def _to_build(self) -> tuple[str, ...]:
        from robocomp_yaml.api.building import to_build  # a compile with nothing to write does not need it

        return tuple(to_build(self._analysis))

    def _prepare(self, own: Review, others: Sequence[str]) -> Changes:
        return writer.prepare(self._built.plans, adopt=self._adopt, others=others, merges=own.merges)

    def _lasting(self, own: Review) -> list[Diagnostic]:
        """What the same run made again would say again."""
        return self._analysis.with_more([*self._built.diagnostics, *own.diagnostics])

    def _other_roots(self) -> list[str]:
        """The folders in which a document that is gone may have left something."""
        found = self._analysis.found
        others = list(found.roots)
        if self._output is not None and found.folders and os.path.isdir(self._output):
            for _ in documents_below(self._output, others):
                pass
        return others

    def _refresh_schemas(self) -> dict[str, bytes]:
        """Brings the schemas up to date that editors read; their contents by path. A workspace that cannot be written
        to has compiled all the same."""
        found: dict[str, bytes] = {}
        fences = AllowedFolders(self._paths, None)
        for workspace in self._analysis.linker.workspaces.values():
            if not fences.contain(workspace.root):
                continue
            try:
                workspace_files.install(workspace.root, workspace.plugins)
            except OSError:
                continue
            for kind in workspace_files.GLOBS:
                path = os.path.normpath(os.path.join(workspace.root, workspace_files.schema_path(kind)))
                if os.path.lexists(path):  # it may wait for a plug-in
                    found[path] = whole(path)[0]
        return found

    def _stamp(
        self, own: Review, changes: Changes, schemas: dict[str, bytes], again: Outcome
    ) -> stamp.RunStamp | None:  # fmt: skip
        """What the same run made again would come to, errors too; None where something could not be read: that may
        change without any trace."""
        disk = self._analysis.disk
        walked = {folder: stamp.walked(folder) for folder in disk.walked}  # there may be new roots since this run
        plugins = [workspace.plugins for workspace in self._analysis.linker.workspaces.values()]
        if any(one.broken for one in plugins) or any(one.code == PLUGIN_FAILED.id for one in again.diagnostics):
            return None  # it may lack what nobody looks at here
        if disk.unreadable or any(walked[folder][: len(found)] != found for folder, found in disk.walked.items()):
            return None
        settled, once = changes.settled, changes.once
        ours = {os.path.normpath(path) for path in settled}
        there = ours | {os.path.normpath(path) for path in once}  # since this run
        there |= {folder for path in there for folder in _above(path)}
        states = disk.states | dict.fromkeys((*own.absent, *changes.journals), NOTHING)
        return stamp.create(
            inputs={path: raw for path, raw in {**disk.contents, **own.contents}.items() if path not in ours},
            states={path: state for path, state in states.items() if os.path.normpath(path) not in there},
            listed=disk.listed,
            names={**disk.seen, **own.names},
            walked=walked,
            outputs=settled | schemas,
            present=once,
            replay=again.as_data(),
            plugins=sorted({name for one in plugins for name in one.named}),
        )


def _above(path: str) -> Iterator[str]:
    while (path := os.path.dirname(path)) not in ("", "/"):
        yield path


def _outcome_of(
    analysis: Analysis, built: Build, changes: Changes, told: list[Diagnostic], *, with_diff: bool
) -> Outcome:
    hidden = analysis.hidden() if with_diff else Hidden()
    files = (
        File(
            root.root,
            change.path,
            change.action,
            change.orig,
            hidden.without(change.diff(properties=is_settings(change.path))) if with_diff else "",
        )
        for root in changes.roots
        for change in root.changes
    )
    by_path = {file.path: file for file in files}  # of roots in each other, both may have one
    program, read = analysis.program, analysis.linker.documents.read
    faulty = {os.path.realpath(one.span.file) for one in told if one.severity == ERROR}
    left_out = {read[real].path: real in faulty for real in built.skipped & program.asked}
    return Outcome(
        tuple(told), tuple(by_path.values()), program.documents, len(program.asked), dict(sorted(left_out.items()))
    )


def _ports(analysis: Analysis) -> Callable[[LinkedComponent], PortTable]:
    """Where the ports of a component's workspace come from, once some are asked for."""

    @cache
    def table() -> Callable[[LinkedComponent], PortTable]:
        from robocomp_yaml.api.neighbours import ports

        return ports(analysis)

    return lambda linked: table()(linked)
