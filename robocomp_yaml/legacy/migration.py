"""A run of `rcyaml migrate`: discover, convert, link and name files, and plan the documents to write."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import cdsl, idsl, machines, pdsl
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.grouping import grouped
from robocomp_yaml.legacy import document as yaml
from robocomp_yaml.legacy import workspaces
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.copies import from_search_path, note_pulled, skip_copies
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import ConfigDraft, DeploymentDraft, MachineDraft
from robocomp_yaml.legacy.foreign import skip_foreign
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.linking import (
    InterfaceFiles,
    is_copy,
    name_imports,
    name_machine,
    not_searched,
)
from robocomp_yaml.legacy.networks.deployment import build_deployments
from robocomp_yaml.legacy.references import add_imports_of_interfaces, resolve_references
from robocomp_yaml.legacy.result import MigrationRun
from robocomp_yaml.legacy.rules import Formats, with_plugins
from robocomp_yaml.legacy.settings.components import InferredParameters, build_config_documents
from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.legacy.sources import LegacyFile, assign_documents, discover
from robocomp_yaml.legacy.upgrade import upgrade
from robocomp_yaml.link import workspace_files
from robocomp_yaml.link.workspace import ImportSearch, above
from robocomp_yaml.model.build_interface import build
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.migrated import HEADING

_IMPORTS = (idsl.UNRESOLVED_IMPORT.id, cdsl.UNRESOLVED_IMPORT.id)
_SAME_FAULT = {
    codes.UNKNOWN_TYPE.id: (idsl.UNKNOWN_TYPE.id,),
    codes.IMPORT_UNKNOWN.id: _IMPORTS,
    codes.NOT_SEARCHED.id: _IMPORTS,
    codes.STATE_MACHINE.id: (machines.UNREADABLE.id,),
    codes.NO_PDSL.id: (pdsl.NO_COMPONENT.id,),
}  # by a code of `migrate` for something missing, the codes of `check` for the same

Progress = Callable[[Sequence[LegacyFile]], Iterator[LegacyFile]]


def migrate(
    paths: Sequence[str], output: str | None, extra: Sequence[str], *, force: bool, progress: Progress = iter,
    guesses: Corrections = Corrections(), exact: bool = False,
) -> MigrationRun:  # fmt: skip
    """Return the run with all that it would write. Nothing is written but, in a folder where an earlier run was
    interrupted, its rollback. Raises Faulty where a plug-in's format is not valid."""
    formats, diagnostics = _formats(paths)
    discovered = discover(paths, output, formats)
    run = MigrationRun(general=[*diagnostics, *discovered.diagnostics])
    for file in progress(discovered.files):
        entry = LedgerEntry(file, convert(file.path, formats), skipped=bool(file.preferred))
        entry.diagnostics = [*entry.file.diagnostics]
        if file.preferred:
            entry.diagnostics = [codes.PREFERRED.at(Span(file.path), other=file.preferred)]
        run.entries.append(entry)
    run.general += skip_foreign(run.entries, formats)
    known = workspaces.Workspaces()
    is_empty = all(entry.skipped or entry.file.refused for entry in run.entries)
    known.new.extend(
        folder for folder in discovered.workspaces() if not is_empty and workspaces.needs_file(run.root(folder))
    )
    search = ImportSearch((*extra, *discovered.interfaces))
    run.entries += from_search_path([*run.entries], search, formats, known)
    run.general += note_pulled(run.entries)
    interfaces = InterfaceFiles.of((entry.file for entry in run.entries if not entry.skipped), search)
    run.general += skip_copies(run.entries, interfaces, known)
    accepted = [entry for entry in run.entries if not entry.skipped and not entry.file.refused]
    known_formats = [(entry.legacy, entry.file.rules) for entry in accepted if entry.file.rules is not None]
    documents, diagnostics = assign_documents(known_formats)
    by_path = {entry.file.path: entry for entry in accepted}
    for diagnostic in diagnostics:
        by_path[diagnostic.span.file].diagnostics.append(diagnostic)
    _link(accepted, documents, known, interfaces)
    networks, owners = build_deployments(accepted, documents, known)
    configs, inferred = build_config_documents(accepted, documents, owners, run.was_written, guesses, exact=exact)
    _plan(run, accepted, documents, known, networks | configs, inferred, interfaces, force)
    upgrade(run, paths)
    return run


def _formats(paths: Sequence[str]) -> tuple[Formats, list[Diagnostic]]:
    """Return the built-in formats and those of the plug-ins of the paths' workspaces; and why plug-ins are missing."""
    by_root = {os.path.realpath(workspace.root): (workspace, found) for workspace, found in map(above, paths)}
    active = {plugin.name: plugin for workspace, _ in by_root.values() for plugin in workspace.plugins.active}
    diagnostics = [each for workspace, found in by_root.values() if not workspace.plugins.whole for each in found]
    return with_plugins(Plugins(tuple(active.values()))), diagnostics


def check_written(run: MigrationRun, extra: Sequence[str]) -> None:
    """Check the written documents as `rcyaml check` does, and report their errors at the legacy files."""
    documents = [(path, entry) for entry in run.entries if not entry.skipped for path in entry.outputs
                 if path.endswith(".yaml")]  # fmt: skip
    if not documents:
        return
    from robocomp_yaml.pipeline import analyse

    reported = analyse([path for path, _ in documents], extra).diagnostics
    by_file = grouped((os.path.realpath(one.span.file), one) for one in reported if one.severity == ERROR)
    for path, entry in documents:
        found = by_file.get(os.path.realpath(path), [])
        errors = [error for error in found if not _is_reported(error, entry.diagnostics)]
        if errors:
            first, more = errors[0], f" (and {len(errors) - 1} more)" if errors[1:] else ""
            at, reason = Span(entry.file.path), first.message + more
            diagnostic = codes.NOT_ACCEPTED.at(at, path=path, line=first.span.line, reason=reason, hint=first.hint)
            entry.diagnostics.append(diagnostic)


def _is_reported(error: Diagnostic, diagnostics: Sequence[Diagnostic]) -> bool:
    """Whether `migrate` has reported an error of `check` already: the same thing is missing."""
    for diagnostic in diagnostics:
        if error.code in _SAME_FAULT.get(diagnostic.code, ()):
            name = re.escape(_missing_name(diagnostic).rpartition("::")[2])
            if re.search(rf"(?<!\w){name}(?!\w)", _missing_name(error)):
                return True
    return False


def _missing_name(diagnostic: Diagnostic) -> str:
    """Return the name or path that is missing."""
    return str(diagnostic.fact("path") if diagnostic.fact("name") is None else diagnostic.fact("name"))


def _link(
    accepted: Sequence[LedgerEntry], documents: dict[str, str], known: workspaces.Workspaces,
    interfaces: InterfaceFiles,
) -> None:  # fmt: skip
    for entry in accepted:
        workspace = known.of(documents[entry.file.path])
        entry.diagnostics += name_imports(entry.file, documents, workspace, interfaces)
        entry.diagnostics += name_machine(entry.file, documents)
    reported: set[tuple[str, str]] = set()
    for entry in accepted:
        entry.diagnostics += resolve_references(entry.file, interfaces)
        document = documents[entry.file.path]
        workspace = known.of(document)
        entry.diagnostics += add_imports_of_interfaces(entry.file, document, workspace, interfaces)
        if workspace.root in known.new:
            continue
        for folder, diagnostic in not_searched(entry.file, workspace, documents, interfaces):
            if (workspace.root, folder) not in reported:  # once for a folder
                reported.add((workspace.root, folder))
                entry.diagnostics.append(diagnostic)


def _plan(
    run: MigrationRun, accepted: Sequence[LedgerEntry], documents: dict[str, str], known: workspaces.Workspaces,
    settled: Mapping[str, yaml.Map], inferred: Sequence[InferredParameters], interfaces: InterfaceFiles, force: bool,
) -> None:  # fmt: skip
    """Plan the documents of all files. `settled` are the documents that depend on several files, by the path of
    each."""
    written: dict[str, list[tuple[str, str, yaml.Map]]] = {folder: [] for folder in known.new}
    planned: list[tuple[LedgerEntry, str, str, yaml.Map, Notes, str]] = []
    for entry in accepted:
        rules, draft = entry.file.rules, entry.file.draft
        assert rules is not None and draft is not None
        path, document = entry.file.path, documents[entry.file.path]
        if isinstance(draft, MachineDraft):
            planned.append((entry, rules.kind, document, yaml.Map(), Notes(), draft.text))
        else:
            content = settled[path] if isinstance(draft, (ConfigDraft, DeploymentDraft)) else draft.document
            planned.append((entry, rules.kind, document, content, draft.around, ""))
    planned += [(each.entry, "pdsl", each.path, each.document, Notes(), "") for each in inferred]
    for entry, kind, document, content, around, raw in planned:
        home = known.of(document).root
        gap = "\n" if around.head else ""
        root = run.root(entry.legacy.root)
        heading = HEADING if kind == "idsl" and _has_reserved_names(content) else ""
        text = raw or f"{_modeline(document, home, kind, content)}\n{heading}{gap}{yaml.text(content, around)}"
        output = root.add(os.path.relpath(document, entry.legacy.root), text, force=force, sources=(entry.file.path,))
        run.homes.setdefault(home, []).append(output)
        run.add(entry, root, output)
        if home in written and not raw and not is_copy(entry.file):
            written[home].append((kind, document, content))
    run.report_failures()
    for folder in known.new:
        text = workspaces.file_text(folder, written[folder], interfaces.folders_used(folder))
        run.roots[folder].add(WORKSPACE_FILE, text, force=force)


def _has_reserved_names(content: yaml.Map) -> bool:
    """Whether a document of interfaces has names that are reserved in a target language."""
    tree = yaml.tree(content)
    if schema.validate("idsl", tree):
        return False
    module = build(tree, "")
    return any(one.part("checks").has_taken(module) for one in languages.table().values() if one.warns_others)


def _modeline(document: str, home: str, kind: str, content: yaml.Map) -> str:
    """Return the first line of a document, which names its schema. Values have the schema that `compile` generates for
    their component."""
    component = str(content.get("component"))
    if kind == "config" and component.endswith(".cdsl.yaml"):
        folder = os.path.join(os.path.dirname(document), os.path.dirname(component))
        return workspaces.values_modeline(document, folder)
    return workspace_files.modeline(kind, document, home)
