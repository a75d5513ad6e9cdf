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
from robocomp_yaml.legacy.ledger import Entry
from robocomp_yaml.legacy.linking import Neighbours, name_imports, name_machine, not_searched, resolve_references
from robocomp_yaml.legacy.networks.settle import settle as settle_networks
from robocomp_yaml.legacy.result import Migration
from robocomp_yaml.legacy.rules import Formats, with_plugins
from robocomp_yaml.legacy.settings.components import Inferred, settle
from robocomp_yaml.legacy.settings.plan import Guesses
from robocomp_yaml.legacy.sources import LegacyFile, find, names
from robocomp_yaml.legacy.upgrade import upgrade
from robocomp_yaml.link.workspace import ImportSearch, above
from robocomp_yaml.model.build_interface import build
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.migrated import HEADING

_IMPORTS = (idsl.UNRESOLVED_IMPORT.id, cdsl.UNRESOLVED_IMPORT.id)
_SAME = {
    codes.UNKNOWN_TYPE.id: (idsl.UNKNOWN_TYPE.id,),
    codes.IMPORT_UNKNOWN.id: _IMPORTS,
    codes.NOT_SEARCHED.id: _IMPORTS,
    codes.STATE_MACHINE.id: (machines.UNREADABLE.id,),
    codes.NO_PDSL.id: (pdsl.NO_COMPONENT.id,),
}  # what `migrate` says of what is not there, and what `check` says of it

Progress = Callable[[Sequence[LegacyFile]], Iterator[LegacyFile]]


def migrate(
    paths: Sequence[str], output: str | None, extra: Sequence[str], *, force: bool, progress: Progress = iter,
    guesses: Guesses = Guesses(), exact: bool = False,
) -> Migration:  # fmt: skip
    """Everything but the writing."""
    formats, said = _formats(paths)
    found = find(paths, output, formats)
    run = Migration(general=[*said, *found.diagnostics])
    by_file: list[tuple[LegacyFile, Entry]] = []
    for file in progress(found.files):
        entry = Entry(convert(file.path, formats), skipped=bool(file.preferred))
        entry.diagnostics = [*entry.file.diagnostics]
        if file.preferred:
            entry.diagnostics = [codes.PREFERRED.at(Span(file.path), other=file.preferred)]
        by_file.append((file, entry))
    run.entries = [entry for _, entry in by_file]
    good = [(file, entry) for file, entry in by_file if not entry.skipped and not entry.file.refused]

    known = workspaces.Workspaces()
    for folder in found.workspaces():
        root = run.root(folder)
        if workspaces.wants_file(root) and good:
            known.new.append(folder)
    chosen, said = names([(file, entry.file.rules) for file, entry in good if entry.file.rules is not None])
    _tell(run, said)
    _link(run, good, chosen, known, extra)
    networks = settle_networks([entry for _, entry in good], chosen, known)
    settled = settle(good, chosen, run.remembers, guesses, exact=exact)
    _plan(run, good, chosen, known, networks | dict(settled.documents), settled.inferred, force)
    upgrade(run, paths)
    return run


def _formats(paths: Sequence[str]) -> tuple[Formats, list[Diagnostic]]:
    """The built-in formats, and those of the plug-ins that the workspaces of these paths name."""
    workspaces_ = {os.path.realpath(made.root): (made, said) for made, said in map(above, paths)}
    active = {one.name: one for made, _ in workspaces_.values() for one in made.plugins.active}
    told = [one for made, said in workspaces_.values() if not made.plugins.whole for one in said]
    return with_plugins(Plugins(tuple(active.values()))), told


def look_back(run: Migration, extra: Sequence[str]) -> None:
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
        errors = [told for told in found.get(os.path.realpath(path), []) if not _is_said(told, entry.diagnostics)]
        if errors:
            first, more = errors[0], f" (and {len(errors) - 1} more)" if errors[1:] else ""
            entry.diagnostics.append(
                codes.NOT_ACCEPTED.at(
                    Span(entry.file.path), path=path, line=first.span.line, reason=first.message + more, hint=first.hint
                )
            )


def _is_said(error: Diagnostic, said: Sequence[Diagnostic]) -> bool:
    """Whether an error of `check` is of what migrating has told already: the same thing that is not there."""
    for told in said:
        if error.code in _SAME.get(told.code, ()):
            name = re.escape(_missing(told).rpartition("::")[2])
            if re.search(rf"(?<!\w){name}(?!\w)", _missing(error)):
                return True
    return False


def _missing(told: Diagnostic) -> str:
    """The name or path that is not there."""
    return str(told.fact("path") if told.fact("name") is None else told.fact("name"))


def _tell(run: Migration, said: Sequence[Diagnostic]) -> None:
    """Each diagnostic to the entry of its file."""
    by_path = {entry.file.path: entry for entry in run.entries}
    for diagnostic in said:
        by_path[diagnostic.span.file].diagnostics.append(diagnostic)


def _link(
    run: Migration, good: Sequence[tuple[LegacyFile, Entry]], chosen: dict[str, str], known: workspaces.Workspaces,
    extra: Sequence[str],
) -> None:  # fmt: skip
    neighbours = Neighbours.of((entry.file for entry in run.entries if not entry.skipped), ImportSearch(tuple(extra)))
    for file, entry in good:
        document = chosen[file.path]
        entry.diagnostics += name_imports(entry.file, document, known.of(document), neighbours)
        entry.diagnostics += name_machine(entry.file, chosen)
    told: set[tuple[str, str]] = set()
    for file, entry in good:
        entry.diagnostics += resolve_references(entry.file, neighbours)
        workspace = known.of(chosen[file.path])
        if workspace.root in known.new:
            continue
        for folder, diagnostic in not_searched(entry.file, workspace, chosen, neighbours):
            if (workspace.root, folder) not in told:  # once for a folder
                told.add((workspace.root, folder))
                entry.diagnostics.append(diagnostic)


def _plan(
    run: Migration, good: Sequence[tuple[LegacyFile, Entry]], chosen: dict[str, str], known: workspaces.Workspaces,
    settled: Mapping[str, yaml.Map], inferred: Sequence[Inferred], force: bool,
) -> None:  # fmt: skip
    """`settled` are the documents that were made for several files together, by the path of each."""
    written: dict[str, list[tuple[str, str, yaml.Map]]] = {folder: [] for folder in known.new}
    planned: list[tuple[LegacyFile, Entry, str, str, yaml.Map, Notes, str]] = []
    for file, entry in good:
        rules, draft = entry.file.rules, entry.file.draft
        assert rules is not None and draft is not None
        kind, document = rules.kind, chosen[file.path]
        if isinstance(draft, MachineDraft):
            planned.append((file, entry, kind, document, yaml.Map(), Notes(), draft.text))
        else:
            content = settled[file.path] if isinstance(draft, ConfigDraft | DeploymentDraft) else draft.document
            planned.append((file, entry, kind, document, content, draft.around, ""))
    planned += [(made.file, made.entry, "pdsl", made.path, made.document, Notes(), "") for made in inferred]
    for file, entry, kind, document, content, around, raw in planned:
        home = known.of(document).root
        gap = "\n" if around.head else ""
        root = run.root(file.root)
        heading = HEADING if kind == "idsl" and _has_taken(content) else ""
        text = raw or _modeline(document, home, kind, content) + heading + gap + yaml.text(content, around)
        output = root.add(os.path.relpath(document, file.root), text, force=force, sources=(file.path,))
        run.homes.setdefault(home, []).append(output)
        run.add(entry, root, output)
        if home in written and not raw:
            written[home].append((kind, document, content))
    run.tell_failures()
    for folder in known.new:
        run.roots[folder].add(WORKSPACE_FILE, workspaces.file_text(folder, written[folder]), force=force)


def _has_taken(content: yaml.Map) -> bool:
    """Whether a document of interfaces has names that some language takes."""
    tree = yaml.tree(content)
    if schema.validate("idsl", tree):
        return False
    module = build(tree, "")
    return any(one.part("checks").has_taken(module) for one in languages.table().values() if one.warns_others)


def _modeline(document: str, home: str, kind: str, content: yaml.Map) -> str:
    """The first line. What values may be is said by the schema that `compile` makes for their component."""
    component = next((str(entry.value) for entry in content.entries if entry.key == "component"), "")
    if kind == "config" and component.endswith(".cdsl.yaml"):
        folder = os.path.join(os.path.dirname(document), os.path.dirname(component))
        return workspaces.values_modeline(document, folder)
    return workspaces.modeline(document, home, kind)
