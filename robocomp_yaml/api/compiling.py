"""A compile: what it would write, as data, and how that is applied."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cached_property, partial

from msgspec.structs import replace

from robocomp_yaml.api.compile_stamps import CompileArguments, keep
from robocomp_yaml.api.outcome import File, Outcome
from robocomp_yaml.diag.codes.emitting import CHANGED_CONFIG
from robocomp_yaml.diag.codes.files import PLUGIN_FAILED
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.emit.allowed_folders import AllowedFolders
from robocomp_yaml.emit.build import Build, build
from robocomp_yaml.emit.layout import is_settings
from robocomp_yaml.emit.options import EmitOptions
from robocomp_yaml.emit.specific.review import Review, review
from robocomp_yaml.link.documents import read_tree
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import documents_below
from robocomp_yaml.source.disk import NOTHING
from robocomp_yaml.source.schema_names import OfferedNames
from robocomp_yaml.source.tree import Node
from robocomp_yaml.transactions import stamp, writer
from robocomp_yaml.transactions.changes import Changes


class Compilation:
    """A compile of the documents of a workspace. Nothing is written before `apply`.

    `diagnostics`, `files` (each with its `action`) and `dirty` (whether a file that users see would change) are what
    `apply` would do. It writes what follows from the documents as they were when they were loaded.
    """

    def __init__(self, analysis: Analysis, arguments: CompileArguments, *, adopt: bool, merge: bool) -> None:
        self._analysis, self._arguments, self._adopt, self._merge = analysis, arguments, adopt, merge
        self._output = arguments.output
        options = EmitOptions(
            self._output, analysis.discovered.folders, frozenset(arguments.targets), analysis.workspaces.of,
            analysis.addresses.table, standalone=arguments.standalone,
        )  # fmt: skip
        self._built = build(analysis.program, analysis.diagnostics, options)
        AllowedFolders(arguments.paths, self._output).restrict(self._built)

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
        """Whether a diagnostic is an error. Documents without errors are compiled all the same."""
        return has_errors(self.diagnostics)

    def look(self, *, with_diff: bool = False) -> Outcome:
        """What `apply` would do now; with a unified diff of each file if `with_diff`."""
        own = review(self._built, self._analysis.disk, merge=self._merge)
        changes = self._prepare(own, self._other_roots())
        diagnostics = in_order([*self._lasting(own), *changes.diagnostics])
        outcome = _outcome_of(self._analysis, self._built, changes, diagnostics, with_diff=with_diff)
        return replace(outcome, planned=True)

    def apply(self) -> Outcome:
        """Writes all files or none, and returns what was done. If a file cannot be written, a diagnostic reports it,
        and the action of the file is `refused`."""
        others = self._other_roots()
        recovered = writer.recover(self._built.plans, others)
        own = review(self._built, self._analysis.disk, merge=self._merge)
        changes = writer.commit(self._prepare(own, others))
        schemas = self._refresh_schemas()
        lasting = self._lasting(own)
        diagnostics = [*lasting, *recovered, *changes.diagnostics]
        outcome = _outcome_of(self._analysis, self._built, changes, in_order(diagnostics), with_diff=False)
        # A property file of the user is compared with its values document in every run.
        is_settled = not any(one.severity == ERROR or one.code == CHANGED_CONFIG.id for one in changes.diagnostics)
        if not self._merge and is_settled and not has_errors(recovered):
            new_stamp = self._stamp(own, changes, schemas, outcome.settled(lasting, changes))
            if new_stamp is not None:
                keep(new_stamp, self._arguments)
        return replace(outcome, to_build=self._to_build()) if outcome.dirty and self._output is None else outcome

    def _to_build(self) -> tuple[str, ...]:
        """The names of the requested components with a stale program."""
        program, of = self._analysis.program, self._analysis.workspaces.of
        requested = (program.components[real] for real in program.requested_components())
        built = [linked for linked in requested if linked.component.language.target.build]
        if not built:
            return ()
        from robocomp_yaml.building.stamps import stale  # unused by languages without a build
        from robocomp_yaml.building.unit import unit_of

        built.sort(key=lambda linked: linked.component.path)
        return tuple(unit.name for unit in stale(unit_of(one, of(one.component.path)) for one in built))

    def _prepare(self, own: Review, others: Sequence[str]) -> Changes:
        return writer.prepare(self._built.plans, adopt=self._adopt, others=others, merges=own.merges)

    def _lasting(self, own: Review) -> list[Diagnostic]:
        """The diagnostics that the same compile would report again."""
        return self._analysis.with_more([*self._built.diagnostics, *own.diagnostics])

    def _other_roots(self) -> list[str]:
        """The folders that may contain files of a document that was deleted."""
        discovered = self._analysis.discovered
        others = list(discovered.roots)
        if self._output is not None and discovered.folders and os.path.isdir(self._output):
            for _ in documents_below(self._output, others):
                pass
        return others

    def _refresh_schemas(self) -> dict[str, str]:
        """Updates the schemas that editors use. Returns their digests by path. A workspace whose folder cannot be
        written is compiled all the same."""
        schemas: dict[str, str] = {}
        fences = AllowedFolders(self._arguments.paths, None)
        for workspace in self._analysis.workspaces.declared:
            if not fences.contain(workspace.root):
                continue
            from robocomp_yaml.link import workspace_files  # a compile elsewhere (-o) has none

            try:
                names = self._names_below(workspace.root)
                schemas |= workspace_files.install(workspace.root, workspace.plugins, names).schemas
            except OSError:
                continue
        return schemas

    def _names_below(self, root: str) -> OfferedNames:
        """The names of a workspace, also those of documents that are no part of this run."""
        from robocomp_yaml.link.workspace_names import documents_of, names_in

        documents, disk = self._analysis.documents, self._analysis.disk

        def tree_of(path: str) -> Node | None:
            document = documents.get(disk.real(path))
            return document.tree if document is not None else read_tree(path, disk)[0]

        trees = [(path, tree_of(path)) for path in documents_of(root, disk)]
        make = partial(names_in, root, trees, disk)
        return self._analysis.program.memory.result(("workspace names", root), tuple(trees), make)

    def _walked(self, changes: Changes) -> dict[str, list[str]]:
        """What `stamp.walked` returns now for the folders in which documents were searched."""
        discovered, known = self._analysis.discovered, self._analysis.disk.walked
        if len(discovered.folders) == 1 and not changes.has_other_roots:
            folder = discovered.folders[0]
            return {
                each: [*found, *discovered.roots] if each == folder else stamp.walked(each)
                for each, found in known.items()
            }
        return {folder: stamp.walked(folder) for folder in known}

    def _stamp(
        self, own: Review, changes: Changes, schemas: dict[str, str], again: Outcome
    ) -> stamp.RunStamp | None:  # fmt: skip
        """The stamp of this compile, also if it has errors; None if something could not be read: a change of that would
        be unnoticed."""
        disk = self._analysis.disk
        walked = self._walked(changes)
        plugins = [workspace.plugins for workspace in self._analysis.workspaces.declared]
        if any(one.broken for one in plugins) or any(one.code == PLUGIN_FAILED.id for one in again.diagnostics):
            return None  # what is missing is not part of the stamp
        if disk.unreadable or any(walked[folder][: len(found)] != found for folder, found in disk.walked.items()):
            return None
        settled, once = changes.settled, changes.once
        generated = {os.path.normpath(path) for path in settled}
        created = generated | {os.path.normpath(path) for path in once}
        for path in tuple(created):
            while (path := path.rpartition("/")[0]) and path not in created:
                created.add(path)
        states = disk.states | dict.fromkeys((*own.absent, *changes.journals), NOTHING)
        return stamp.create(
            inputs={path: raw for path, raw in {**disk.contents, **own.contents}.items() if path not in generated},
            real=disk.real,
            states={path: state for path, state in states.items() if os.path.normpath(path) not in created},
            listed=disk.listed,
            names={**disk.seen, **own.names},
            walked=walked,
            outputs=settled | schemas,
            present=once,
            replay=again.as_data(),
            plugins=sorted({name for one in plugins for name in one.named}),
        )


def _outcome_of(
    analysis: Analysis, built: Build, changes: Changes, diagnostics: list[Diagnostic], *, with_diff: bool
) -> Outcome:
    hidden = analysis.hidden() if with_diff else Hidden()
    by_path: dict[str, File] = {}  # nested roots may both have a file
    for root in changes.roots:
        for change in root.changes:
            diff = hidden.without(change.diff(properties=is_settings(change.path))) if with_diff else ""
            by_path[change.path] = File(root.root, change.path, change.action, change.orig, diff)
    program, read = analysis.program, analysis.documents
    faulty = {os.path.realpath(one.span.file) for one in diagnostics if one.severity == ERROR}
    left_out = {read[real].path: real in faulty for real in built.skipped & program.requested}
    files, skipped = tuple(by_path.values()), dict(sorted(left_out.items()))
    return Outcome(tuple(diagnostics), files, program.documents, len(program.requested), skipped)
