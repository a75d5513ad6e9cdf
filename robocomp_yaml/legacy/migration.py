"""A run of `rcyaml migrate`: files found, converted, linked, named, and written."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy import document as yaml
from robocomp_yaml.legacy import workspaces
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.ledger import Entry
from robocomp_yaml.legacy.linking import INTERFACES, Neighbours, name_imports, resolve_references
from robocomp_yaml.legacy.outputs import CHANGED, EDITED, FAILED, TAKEN, Output, OutputRoot
from robocomp_yaml.legacy.sources import LegacyFile, find, names
from robocomp_yaml.link.workspace import Search
from robocomp_yaml.source import workspace_files
from robocomp_yaml.source.discover import WORKSPACE_FILE

Progress = Callable[[Sequence[LegacyFile]], Iterator[LegacyFile]]


@dataclass(slots=True)
class Migration:
    """What a run found out and decided; `write` carries it out."""

    entries: list[Entry] = field(default_factory=list)
    roots: dict[str, OutputRoot] = field(default_factory=dict)
    general: list[Diagnostic] = field(default_factory=list)
    homes: dict[str, list[Output]] = field(default_factory=dict)
    """The documents of each workspace, whose first line names a schema there."""
    _documents: list[tuple[Entry, OutputRoot, Output]] = field(default_factory=list)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        told = [diagnostic for entry in self.entries for diagnostic in entry.diagnostics]
        return in_order([*self.general, *told])

    def changes(self) -> Iterator[tuple[str, Output]]:
        """Every file that is not as this run would have it, with the path to show."""
        for root in self.roots.values():
            for output in root.outputs:
                if output.differs:
                    yield root.root.shown(output.path), output

    def write(self) -> None:
        for root in self.roots.values():
            root.write()
        for entry, root, output in self._documents:
            if output.state == FAILED and not any(d.code == codes.NOT_WRITTEN.id for d in entry.diagnostics):
                entry.diagnostics.append(_not_written(entry.file.path, root, output))
                entry.outputs.clear()
        for root in self.roots.values():
            for output in root.outputs:
                if output.path == WORKSPACE_FILE and output.state == FAILED and not root.problem:
                    self.general.append(_not_written(root.root.shown(output.path), root, output))
        for home, outputs in sorted(self.homes.items()):
            if any(output.state not in (FAILED, TAKEN) for output in outputs):
                with contextlib.suppress(OSError):  # a workspace that cannot be written to has migrated all the same
                    workspace_files.install(Path(home))

    def add(self, entry: Entry, root: OutputRoot, output: Output) -> None:
        """An entry's document, with what its state means to the user."""
        shown = root.root.shown(output.path)
        at = Span(entry.file.path)
        entry.outputs.append(shown)
        self._documents.append((entry, root, output))
        if output.state == TAKEN:
            entry.diagnostics.append(codes.TAKEN.at(at, path=shown))
            entry.outputs.clear()
        elif output.state == FAILED:
            entry.diagnostics.append(_not_written(entry.file.path, root, output))
            entry.outputs.clear()
        elif output.state == EDITED:
            entry.skipped = True
            if root.has_news(output):
                entry.diagnostics.append(codes.EDITED.at(at, path=shown, hint="--diff shows the difference"))


def _not_written(path: str, root: OutputRoot, output: Output) -> Diagnostic:
    return codes.NOT_WRITTEN.at(Span(path), path=root.root.shown(output.path), reason=output.problem)


def migrate(
    paths: Sequence[str], output: str | None, extra: Sequence[str], *, force: bool, progress: Progress = iter
) -> Migration:
    """Everything but the writing."""
    found = find(paths, output)
    run = Migration(general=found.diagnostics)
    by_file: list[tuple[LegacyFile, Entry]] = []
    for file in progress(found.files):
        entry = Entry(convert(file.path), skipped=bool(file.preferred))
        entry.diagnostics = entry.file.diagnostics
        if file.preferred:
            entry.diagnostics = [codes.PREFERRED.at(Span(file.path), other=file.preferred)]
        by_file.append((file, entry))
    run.entries = [entry for _, entry in by_file]
    good = [(file, entry) for file, entry in by_file if not entry.skipped and not entry.file.refused]

    known = workspaces.Workspaces()
    for folder in found.folders:
        root = run.roots.setdefault(folder, OutputRoot.at(folder))
        if workspaces.wants_file(root) and good:
            known.new.append(folder)
    chosen, said = names([(file, entry.file.rules) for file, entry in good if entry.file.rules is not None])
    _tell(run, said)
    _link(run, good, chosen, known, extra)
    _plan(run, good, chosen, known, force)
    return run


def _tell(run: Migration, said: Sequence[Diagnostic]) -> None:
    """Each diagnostic to the entry of its file."""
    by_path = {entry.file.path: entry for entry in run.entries}
    for diagnostic in said:
        by_path[diagnostic.span.file].diagnostics.append(diagnostic)


def _link(
    run: Migration, good: Sequence[tuple[LegacyFile, Entry]], chosen: dict[str, str], known: workspaces.Workspaces,
    extra: Sequence[str],
) -> None:  # fmt: skip
    neighbours = Neighbours.of((entry.file for entry in run.entries if not entry.skipped), Search(tuple(extra)))
    for file, entry in good:
        document = chosen[file.path]
        entry.diagnostics += name_imports(entry.file, document, known.of(document), neighbours)
    for _, entry in good:
        entry.diagnostics += resolve_references(entry.file, neighbours)


def _plan(
    run: Migration, good: Sequence[tuple[LegacyFile, Entry]], chosen: dict[str, str], known: workspaces.Workspaces,
    force: bool,
) -> None:  # fmt: skip
    interfaces: dict[str, list[str]] = {folder: [] for folder in known.new}
    for file, entry in good:
        document, rules, draft = chosen[file.path], entry.file.rules, entry.file.draft
        assert rules is not None and draft is not None
        home = known.of(document).root
        body = yaml.text(draft.document, draft.around)
        gap = "\n" if draft.around.head else ""
        root = run.roots.setdefault(file.root, OutputRoot.at(file.root))
        output = root.add(
            os.path.relpath(document, file.root), workspaces.modeline(document, home, rules.kind) + gap + body,
            force=force,
        )
        run.homes.setdefault(home, []).append(output)
        run.add(entry, root, output)
        if rules.kind == INTERFACES and home in interfaces:
            interfaces[home].append(document)
    for folder in known.new:
        run.roots[folder].add(WORKSPACE_FILE, workspaces.file_text(folder, interfaces[folder]), force=force)


def forced(run: Migration) -> Iterator[tuple[str, Output]]:
    """The outputs that a user edited and `--force` overwrites."""
    for root in run.roots.values():
        for output in root.outputs:
            if output.state == CHANGED and not root.is_ours(output.path):
                yield root.root.shown(output.path), output
