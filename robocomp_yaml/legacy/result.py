"""What a run of `migrate` found out and decided, and the carrying out of it."""

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
    """`general` are diagnostics that belong to no legacy file alone."""

    entries: list[LedgerEntry] = []
    roots: dict[str, OutputRoot] = {}
    general: list[Diagnostic] = []
    homes: dict[str, list[Output]] = {}
    """The documents of each workspace, whose first line names a schema there."""
    upgrades: list[tuple[str, Output]] = []
    """Older documents of ours, by their paths."""
    _documents: list[tuple[LedgerEntry, OutputRoot, Output]] = []

    @property
    def diagnostics(self) -> list[Diagnostic]:
        told = [diagnostic for entry in self.entries for diagnostic in entry.diagnostics]
        return in_order([*self.general, *told])

    @property
    def failed(self) -> bool:
        """Whether a file was refused, or could not be written."""
        return any(d.severity == "error" for d in self.diagnostics) or any(e.status == "refused" for e in self.entries)

    def root(self, path: str) -> OutputRoot:
        """The output root at a path, as it was found on the disk."""
        if path not in self.roots:
            self.roots[path] = OutputRoot.at(path)
        return self.roots[path]

    def was_written(self, entry: LedgerEntry, path: str) -> bool:
        """Whether an earlier run wrote the document at a path."""
        root = entry.legacy.root
        return os.path.relpath(path, root) in self.root(root).memory

    def changes(self) -> Iterator[tuple[str, Output]]:
        """Every file that is not as this run would have it, with the path to show."""
        for root in self.roots.values():
            yield from ((root.root.shown(output.path), output) for output in root.outputs if output.differs)

    def forced(self) -> Iterator[tuple[str, Output]]:
        """The files that a user edited and `--force` overwrites."""
        for root in self.roots.values():
            for output in root.outputs:
                if output.state == CHANGED and not root.is_unchanged(output.path):
                    yield root.root.shown(output.path), output

    def add(self, entry: LedgerEntry, root: OutputRoot, output: Output) -> None:
        """An entry's document, with what its state means to the user."""
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
        for root in self.roots.values():
            root.write()
        self.report_failures()
        for path, output in self.upgrades:
            if output.state == FAILED:
                self.general.append(codes.NOT_WRITTEN.at(Span(path), path=path, reason=output.problem))
        for home, outputs in sorted(self.homes.items()):
            if any(output.state not in (FAILED, TAKEN) for output in outputs):
                with contextlib.suppress(OSError):  # a workspace that cannot be written to has migrated all the same
                    workspace_files.install(home)

    def report_failures(self) -> None:
        """What could not be written: one diagnostic for the files of one folder that share a reason."""
        causes: dict[tuple[str, str], list[tuple[LedgerEntry, str]]] = {}
        for entry, root, output in self._documents:
            if output.state == FAILED and not entry.blocked:
                entry.blocked = True
                entry.outputs.clear()
                shown = root.root.shown(output.path)
                where = root.root.path if root.problem else os.path.dirname(shown)
                causes.setdefault((where, output.problem), []).append((entry, shown))
        for (where, reason), entries in causes.items():
            if len(entries) == 1:
                entry, shown = entries[0]
                entry.diagnostics.append(codes.NOT_WRITTEN.at(Span(entry.file.path), path=shown, reason=reason))
            else:
                what = f"{len(entries)} files below {where}"
                self.general.append(codes.NOT_WRITTEN.at(Span(where), path=what, reason=reason))
