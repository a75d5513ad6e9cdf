"""A run of `rcyaml migrate`: files found, converted, linked, named, and written."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import cdsl, idsl, machines, pdsl
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy import document as yaml
from robocomp_yaml.legacy import workspaces
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import ConfigDraft, DeploymentDraft, MachineDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.linking import InterfaceFiles, name_imports, name_machine, not_searched, resolve_references
from robocomp_yaml.legacy.networks.deployment import build_deployments
from robocomp_yaml.legacy.result import MigrationRun
from robocomp_yaml.legacy.rules import Formats, with_plugins
from robocomp_yaml.legacy.settings.components import InferredParameters, build_config_documents
from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.legacy.sources import LegacyFile, assign_documents, discover
from robocomp_yaml.legacy.upgrade import upgrade
from robocomp_yaml.link import workspace_files
from robocomp_yaml.link.workspace import Search, above
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
}  # what `migrate` says of what is not there, and what `check` says of it

Progress = Callable[[Sequence[LegacyFile]], Iterator[LegacyFile]]


def migrate(
    paths: Sequence[str], output: str | None, extra: Sequence[str], *, force: bool, progress: Progress = iter,
    guesses: Corrections = Corrections(), exact: bool = False,
) -> MigrationRun:  # fmt: skip
    """Everything but the writing."""
    formats, said = _formats(paths)
    found = discover(paths, output, formats)
    run = MigrationRun(general=[*said, *found.diagnostics])
    for file in progress(found.files):
        entry = LedgerEntry(file, convert(file.path, formats), skipped=bool(file.preferred))
        entry.diagnostics = [*entry.file.diagnostics]
        if file.preferred:
            entry.diagnostics = [codes.PREFERRED.at(Span(file.path), other=file.preferred)]
        run.entries.append(entry)
    good = [entry for entry in run.entries if not entry.skipped and not entry.file.refused]

    known = workspaces.Workspaces()
    for folder in found.workspaces():
        root = run.root(folder)
        if workspaces.needs_file(root) and good:
            known.new.append(folder)
    chosen, said = assign_documents(
        [(entry.legacy, entry.file.rules) for entry in good if entry.file.rules is not None]
    )
    by_path = {entry.file.path: entry for entry in good}
    for diagnostic in said:
        by_path[diagnostic.span.file].diagnostics.append(diagnostic)
    _link(run, good, chosen, known, extra)
    networks = build_deployments(good, chosen, known)
    configs, inferred = build_config_documents(good, chosen, run.was_written, guesses, exact=exact)
    _plan(run, good, chosen, known, networks | configs, inferred, force)
    upgrade(run, paths)
    return run


def _formats(paths: Sequence[str]) -> tuple[Formats, list[Diagnostic]]:
    """The built-in formats, and those of the plug-ins that the workspaces of these paths name."""
    workspaces_ = {os.path.realpath(made.root): (made, said) for made, said in map(above, paths)}
    active = {one.name: one for made, _ in workspaces_.values() for one in made.plugins.active}
    told = [one for made, said in workspaces_.values() if not made.plugins.whole for one in said]
    return with_plugins(Plugins(tuple(active.values()))), told


def check_written(run: MigrationRun, extra: Sequence[str]) -> None:
    """Says of each document that was written what `check` says against it, at the legacy file that it comes from."""
    documents = [(path, entry) for entry in run.entries if not entry.skipped for path in entry.outputs
                 if path.endswith(".yaml")]  # fmt: skip
    if not documents:
        return
    from robocomp_yaml.pipeline import analyse

    found: dict[str, list[Diagnostic]] = {}
    for told in analyse([path for path, _ in documents], extra).diagnostics:
        if told.severity == ERROR:
            found.setdefault(os.path.realpath(told.span.file), []).append(told)
    for path, entry in documents:
        errors = [told for told in found.get(os.path.realpath(path), []) if not _is_reported(told, entry.diagnostics)]
        if errors:
            first, more = errors[0], f" (and {len(errors) - 1} more)" if errors[1:] else ""
            entry.diagnostics.append(
                codes.NOT_ACCEPTED.at(
                    Span(entry.file.path), path=path, line=first.span.line, reason=first.message + more, hint=first.hint
                )
            )


def _is_reported(error: Diagnostic, said: Sequence[Diagnostic]) -> bool:
    """Whether an error of `check` is of what migrating has told already: the same thing that is not there."""
    for told in said:
        if error.code in _SAME_FAULT.get(told.code, ()):
            name = re.escape(_missing_name(told).rpartition("::")[2])
            if re.search(rf"(?<!\w){name}(?!\w)", _missing_name(error)):
                return True
    return False


def _missing_name(told: Diagnostic) -> str:
    """The name or path that is not there."""
    return str(told.fact("path") if told.fact("name") is None else told.fact("name"))


def _link(
    run: MigrationRun, good: Sequence[LedgerEntry], chosen: dict[str, str], known: workspaces.Workspaces,
    extra: Sequence[str],
) -> None:  # fmt: skip
    interfaces = InterfaceFiles.of((entry.file for entry in run.entries if not entry.skipped), Search(tuple(extra)))
    for entry in good:
        document = chosen[entry.file.path]
        entry.diagnostics += name_imports(entry.file, document, known.of(document), interfaces)
        entry.diagnostics += name_machine(entry.file, chosen)
    told: set[tuple[str, str]] = set()
    for entry in good:
        entry.diagnostics += resolve_references(entry.file, interfaces)
        workspace = known.of(chosen[entry.file.path])
        if workspace.root in known.new:
            continue
        for folder, diagnostic in not_searched(entry.file, workspace, chosen, interfaces):
            if (workspace.root, folder) not in told:  # once for a folder
                told.add((workspace.root, folder))
                entry.diagnostics.append(diagnostic)


def _plan(
    run: MigrationRun, good: Sequence[LedgerEntry], chosen: dict[str, str], known: workspaces.Workspaces,
    settled: Mapping[str, yaml.Map], inferred: Sequence[InferredParameters], force: bool,
) -> None:  # fmt: skip
    """`settled` are the documents that were made for several files together, by the path of each."""
    written: dict[str, list[tuple[str, str, yaml.Map]]] = {folder: [] for folder in known.new}
    planned: list[tuple[LedgerEntry, str, str, yaml.Map, Notes, str]] = []
    for entry in good:
        rules, draft = entry.file.rules, entry.file.draft
        assert rules is not None and draft is not None
        path, document = entry.file.path, chosen[entry.file.path]
        if isinstance(draft, MachineDraft):
            planned.append((entry, rules.kind, document, yaml.Map(), Notes(), draft.text))
        else:
            content = settled[path] if isinstance(draft, ConfigDraft | DeploymentDraft) else draft.document
            planned.append((entry, rules.kind, document, content, draft.around, ""))
    planned += [(made.entry, "pdsl", made.path, made.document, Notes(), "") for made in inferred]
    for entry, kind, document, content, around, raw in planned:
        home = known.of(document).root
        gap = "\n" if around.head else ""
        root = run.root(entry.legacy.root)
        heading = HEADING if kind == "idsl" and _has_reserved_names(content) else ""
        text = raw or f"{_modeline(document, home, kind, content)}\n{heading}{gap}{yaml.text(content, around)}"
        output = root.add(os.path.relpath(document, entry.legacy.root), text, force=force, sources=(entry.file.path,))
        run.homes.setdefault(home, []).append(output)
        run.add(entry, root, output)
        if home in written and not raw:
            written[home].append((kind, document, content))
    run.report_failures()
    for folder in known.new:
        run.roots[folder].add(WORKSPACE_FILE, workspaces.file_text(folder, written[folder]), force=force)


def _has_reserved_names(content: yaml.Map) -> bool:
    """Whether a document of interfaces has names that some language takes."""
    tree = yaml.tree(content)
    if schema.validate("idsl", tree):
        return False
    module = build(tree, "")
    return any(one.part("checks").has_taken(module) for one in languages.table().values() if one.warns_others)


def _modeline(document: str, home: str, kind: str, content: yaml.Map) -> str:
    """The first line. What values may be is said by the schema that `compile` makes for their component."""
    component = str(content.get("component"))
    if kind == "config" and component.endswith(".cdsl.yaml"):
        folder = os.path.join(os.path.dirname(document), os.path.dirname(component))
        return workspaces.values_modeline(document, folder)
    return workspace_files.modeline(kind, document, home)
