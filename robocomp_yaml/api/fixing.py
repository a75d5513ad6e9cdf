"""Applying the fixes of diagnostics, and what remains."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.api.edited import EditedDocument, write
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.fixing import MISSHAPEN, UNDERSTOOD, UNREADABLE, AttemptedFix, CheckedDocuments, apply_fixes
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.inside import stays_inside

if TYPE_CHECKING:
    from robocomp_yaml.api.workspace import Workspace


class Fixing:
    """The fixes of the documents of a workspace. Nothing is written before `apply`.

    `fixed` are the fixes that are applied, each with its diagnostic; `left` those that are not, with the reason;
    `written` the documents that change.
    """

    def __init__(
        self, before: Workspace, load: Callable[[Mapping[str, bytes]], Workspace], paths: Sequence[str],
        *, unsafe: bool, environment: bool, code: bool = False,
    ) -> None:  # fmt: skip
        self._before, self._load, self._paths = before, load, tuple(paths)
        self._environment, self._code = environment, code
        in_code = set(_fixable_code(before, environment))
        # Which comments suppress nothing, and what is wrong with code, is known only after a complete check.
        self._is_complete = bool(before.analysis.allowed.by_file or in_code)
        result = apply_fixes(self._look, _requested(before.analysis) | in_code, unsafe=unsafe)
        self._changed, self._fixed, self._left = result.changed, result.fixed, result.left
        self.written: tuple[EditedDocument, ...] = self._write(look_only=True)
        self._remaining: Workspace | None = None

    @property
    def fixed(self) -> list[AttemptedFix]:
        refused = self.refused
        return [one for one in self._fixed if one.diagnostic.span.file not in refused]

    @property
    def left(self) -> list[AttemptedFix]:
        reasons = {one.path: one.reason for one in self.written if one.reason}
        kept = [AttemptedFix(one.diagnostic, one.fix, reasons[one.diagnostic.span.file])
                for one in self._fixed if one.diagnostic.span.file in reasons]  # fmt: skip
        return [*self._left, *kept]

    @property
    def refused(self) -> set[str]:
        """The paths of the documents that cannot be written."""
        return {one.path for one in self.written if one.reason}

    @property
    def remaining(self) -> Workspace:
        """The workspace after all fixes are applied."""
        if self._remaining is None:
            refused = self.refused
            self._remaining = self._load({path: to for path, to in self._changed.items() if path not in refused})
        return self._remaining

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The diagnostics that remain."""
        return self.remaining.check(environment=self._environment, code=self._code)

    def diffs(self) -> Iterator[str]:
        """A unified diff of each document that changes, without secrets."""
        hidden = self._before.analysis.hidden()
        return (one.diff(hidden) for one in self.written if not one.reason)

    def apply(self) -> None:
        """Writes the documents, each completely or not at all. A document that has changed since it was read, or cannot
        be written, is kept."""
        self.written = self._write(look_only=False)
        self._remaining = None

    def _write(self, *, look_only: bool) -> tuple[EditedDocument, ...]:
        contents = self._before.analysis.disk.contents
        changed = ((path, contents[path], after) for path, after in sorted(self._changed.items()))
        return tuple(write(self._paths, changed, look_only=look_only))

    def _look(self, changed: Mapping[str, bytes]) -> CheckedDocuments:
        workspace = self._load(changed) if changed else self._before
        analysis = workspace.analysis
        levels = {
            document.path: UNREADABLE if document.tree is None else MISSHAPEN if document.model is None else UNDERSTOOD
            for document in analysis.documents.values()
        }
        found = workspace.check(environment=self._environment) if self._is_complete else analysis.diagnostics
        return CheckedDocuments(list(found), analysis.disk.contents, levels)


def _fixable_code(workspace: Workspace, environment: bool) -> Iterator[str]:
    """The paths of the user's code for whose diagnostics there are fixes."""
    documents = {document.path for document in workspace.analysis.documents.values()}
    for diagnostic in workspace.check(environment=environment):
        for fix in diagnostic.fixes:
            yield from (edit.span.file for edit in fix.edits if fix.is_spelled and edit.span.file not in documents)


def _requested(analysis: Analysis) -> set[str]:
    """The paths of the requested documents, of those below requested folders, and of their state machines and workspace
    files."""
    program, read = analysis.program, analysis.documents
    machines = {
        path
        for real, linked in program.components.items()
        if real in program.requested
        for path in linked.machine_files
    }
    settings = {
        path for each in analysis.workspaces.declared
        if any(stays_inside(folder, os.path.abspath(each.root)) for folder in analysis.discovered.folders)
        and (path := os.path.normpath(os.path.join(each.root, WORKSPACE_FILE))) in analysis.disk.contents
    }  # fmt: skip
    return {read[real].path for real in program.requested if real in read} | machines | settings
