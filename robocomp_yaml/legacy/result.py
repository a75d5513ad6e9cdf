"""The result of a run of `migrate`: what is planned and reported, and the writing of it."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.outputs import CHANGED, EDITED, FAILED, TAKEN, Output, OutputRoot
from robocomp_yaml.link import workspace_files


class MigrationRun(msgspec.Struct):
    """A run as data. `general` are the diagnostics that are not about a single legacy file."""

    entries: list[LedgerEntry] = []
    roots: dict[str, OutputRoot] = {}
    general: list[Diagnostic] = []
    homes: dict[str, list[Output]] = {}
    """The documents of each workspace; the first line of each names a schema of the workspace."""
    upgrades: list[tuple[str, Output]] = []
    """Documents of an earlier version, with their paths."""
    _documents: list[tuple[LedgerEntry, OutputRoot, Output]] = []

    @property
    def diagnostics(self) -> list[Diagnostic]:
        diagnostics = [diagnostic for entry in self.entries for diagnostic in entry.diagnostics]
        return in_order([*self.general, *diagnostics])

    @property
    def failed(self) -> bool:
        """Whether a file was rejected, or could not be written."""
        return any(d.severity == "error" for d in self.diagnostics) or any(e.status == "refused" for e in self.entries)

    def root(self, path: str) -> OutputRoot:
        """Return the output root at a path, with the state of the disk at its first use."""
        if path not in self.roots:
            self.roots[path] = OutputRoot.at(path)
        return self.roots[path]

    def was_written(self, entry: LedgerEntry, path: str) -> bool:
        """Whether an earlier run wrote the document at a path."""
        root = entry.legacy.root
        return os.path.relpath(path, root) in self.root(root).memory

    def changes(self) -> Iterator[tuple[str, Output]]:
        """Yield each file on which the disk and this run differ, with the path to show."""
        for root in self.roots.values():
            yield from ((root.root.shown(output.path), output) for output in root.outputs if output.differs)

    def forced(self) -> Iterator[tuple[str, Output]]:
        """Yield the files that a user edited and `--force` overwrites, with the path to show."""
        for root in self.roots.values():
            for output in root.outputs:
                if output.state == CHANGED and not root.is_unchanged(output.path):
                    yield root.root.shown(output.path), output

    def add(self, entry: LedgerEntry, root: OutputRoot, output: Output) -> None:
        """Add a document to an entry, and report its state where the user needs to know it."""
        shown = root.root.shown(output.path)
        at = Span(entry.file.path)
        self._documents.append((entry, root, output))
        if output.state == TAKEN:
            entry.diagnostics.append(codes.TAKEN.at(at, path=shown))
            return
        entry.outputs.append(shown)
        if output.state == EDITED:
            entry.skipped = True
            if root.differs_from_last(output):
                entry.diagnostics.append(codes.EDITED.at(at, path=shown, hint="--diff shows the difference"))

    def write(self) -> None:
        """Write all documents, and the schemas of their workspaces; report files that cannot be written."""
        for root in self.roots.values():
            root.write()
        self.report_failures()
        for path, output in self.upgrades:
            if output.state == FAILED:
                self.general.append(codes.NOT_WRITTEN.at(Span(path), path=path, reason=output.problem))
        for home, outputs in sorted(self.homes.items()):
            if any(output.state not in (FAILED, TAKEN) for output in outputs):
                with contextlib.suppress(OSError):  # the documents are written; the files for editors are optional
                    workspace_files.install(home)

    def report_failures(self) -> None:
        """Report files that could not be written: one diagnostic for the files of a folder with the same reason."""
        causes: dict[tuple[str, str], list[tuple[LedgerEntry, str]]] = {}
        for entry, root, output in self._documents:
            if output.state == FAILED and not entry.blocked:
                entry.blocked = True
                entry.outputs.clear()
                shown = root.root.shown(output.path)
                folder = root.root.path if root.problem else os.path.dirname(shown)
                causes.setdefault((folder, output.problem), []).append((entry, shown))
        for (folder, reason), entries in causes.items():
            if len(entries) == 1:
                entry, shown = entries[0]
                entry.diagnostics.append(codes.NOT_WRITTEN.at(Span(entry.file.path), path=shown, reason=reason))
            else:
                what = f"{len(entries)} files below {folder}"
                self.general.append(codes.NOT_WRITTEN.at(Span(folder), path=what, reason=reason))
