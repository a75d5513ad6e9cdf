"""What the files of one run mean to each other: the names of imports, and references that lead nowhere."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.draft import ComponentDraft, ImportDraft, ModuleDraft, ModuleNames, Reference, base_name
from robocomp_yaml.link.workspace import ImportSearch, WorkspaceSettings
from robocomp_yaml.source.discover import WORKSPACE_FILE

INTERFACES = "idsl"


class Neighbours(msgspec.Struct, frozen=True):
    """The interface files of a run by their stem, and where else a document may be found."""

    search: ImportSearch
    by_stem: dict[str, list[Converted]] = {}
    _listed: dict[str, dict[str, str]] = {}

    @classmethod
    def of(cls, files: Iterable[Converted], search: ImportSearch) -> Neighbours:
        neighbours = cls(search)
        for file in files:
            if file.rules is not None and file.rules.kind == INTERFACES:
                neighbours.by_stem.setdefault(base_name(file.path), []).append(file)
        return neighbours

    def imported(self, importer: Converted, stem: str) -> Converted | None:
        """The file of the run that an import means: the one beside it, else the first."""
        found = self.by_stem.get(stem, [])
        here = os.path.dirname(importer.path)
        return next((file for file in found if os.path.dirname(file.path) == here), found[0] if found else None)

    def beside(self, importer: Converted) -> dict[str, str]:
        """The stems of the interface files in an importer's folder, by their lower case."""
        folder = os.path.dirname(importer.path) or "."
        if folder not in self._listed:
            try:
                names = sorted(os.listdir(folder))
            except OSError:
                names = []
            known = (base_name(name) for name in names if name.lower().endswith((".idsl", ".ice")))
            self._listed[folder] = {stem.lower(): stem for stem in known}
        return self._listed[folder]

    def who_defines(self, name: str) -> str:
        """Where a name that is missing can be found, as a hint."""
        for stem, files in sorted(self.by_stem.items()):
            for file in files:
                names = file.draft.names if isinstance(file.draft, ModuleDraft) else None
                if names is not None and name in names.defined:
                    return f"{stem} has it: import {stem}, and write {names.name}::{name}"
        return ""


def _imports(file: Converted) -> tuple[ImportDraft, ...]:
    return file.draft.imports if isinstance(file.draft, ModuleDraft | ComponentDraft) else ()


def name_imports(
    file: Converted, document: str, workspace: WorkspaceSettings, neighbours: Neighbours
) -> Iterable[Diagnostic]:
    """Puts each import's name into the document; warns of those found in another spelling, or not at all."""
    for wanted in _imports(file):
        name = _name(wanted, file, document, workspace, neighbours)
        if name is None:
            yield codes.IMPORT_UNKNOWN.at(wanted.span, name=wanted.stem)
        elif name.lower() == wanted.stem.lower() and name != wanted.stem:
            yield codes.IMPORT_CASE.at(wanted.span, name=wanted.stem, found=name)
        wanted.entry.value = name or wanted.stem


def _name(
    wanted: ImportDraft, file: Converted, document: str, workspace: WorkspaceSettings, neighbours: Neighbours
) -> str | None:
    stem, beside = wanted.stem, neighbours.beside(file)
    found, other_case = neighbours.search.find(stem, document, workspace)
    if stem in neighbours.by_stem or beside.get(stem.lower()) == stem or (found and not other_case):
        return stem
    path = wanted.path.replace("\\", "/")
    if "/" in path and not path.startswith("/"):
        there = os.path.join(os.path.dirname(file.path), path)
        if os.path.isfile(there) or os.path.isfile(f"{there}.idsl"):
            return os.path.normpath(path).removesuffix(".idsl").removesuffix(".ice")
    spelled = {known.lower(): known for known in sorted(neighbours.by_stem)}
    if found:
        return os.path.basename(found).removesuffix(".idsl.yaml")
    return spelled.get(stem.lower()) or beside.get(stem.lower())


def name_machine(file: Converted, chosen: Mapping[str, str]) -> Iterable[Diagnostic]:
    """Puts the path of a component's state machine into its document: that of what this run makes of it. Warns where
    there will be nothing at that path."""
    machine = file.draft.machine if isinstance(file.draft, ComponentDraft) else None
    if machine is None:
        return
    home = os.path.dirname(chosen[file.path])
    legacy = os.path.normpath(os.path.join(os.path.dirname(file.path), machine.path))
    migrated = next((document for path, document in chosen.items() if os.path.normpath(path) == legacy), None)
    if migrated is not None:
        machine.entry.value = os.path.relpath(migrated, home or ".")
        return
    if not os.path.isfile(os.path.join(home, machine.document)):
        yield codes.STATE_MACHINE.at(machine.span, legacy=machine.path, path=machine.document)


def not_searched(
    file: Converted, workspace: WorkspaceSettings, chosen: Mapping[str, str], neighbours: Neighbours
) -> Iterable[tuple[str, Diagnostic]]:
    """Imports whose documents will stand where this one's workspace does not look, each with its folder."""
    looked_in = {os.path.dirname(chosen[file.path]), *workspace.interfaces, *neighbours.search.extra}
    known = {os.path.realpath(folder or ".") for folder in looked_in}
    for wanted in _imports(file):
        target = neighbours.imported(file, str(wanted.entry.value))
        document = chosen.get(target.path) if target is not None else None
        folder = os.path.dirname(document) or "." if document is not None else ""
        if folder and os.path.realpath(folder) not in known:
            inside = os.path.relpath(folder, workspace.root)
            hint = f"add {inside} to `interfaces:` in {os.path.join(workspace.root, WORKSPACE_FILE)}"
            yield folder, codes.NOT_SEARCHED.at(wanted.span, name=wanted.entry.value, folder=folder, hint=hint)


def resolve_references(file: Converted, neighbours: Neighbours) -> Iterable[Diagnostic]:
    """Warns of references of a module that nothing defines. What an import from elsewhere defines is not known here.

    In Slice, several files may hold parts of one module, and need not qualify each other's names; documents do.
    """
    if not isinstance(file.draft, ModuleDraft):
        return
    imported: list[tuple[str, ModuleNames]] = []
    complete = True
    for wanted in file.draft.imports:
        target = neighbours.imported(file, str(wanted.entry.value))
        if target is None or not isinstance(target.draft, ModuleDraft):
            complete = False
        else:
            imported.append((wanted.stem, target.draft.names))
    own = file.draft.names
    for reference in own.references:
        if reference.module in ("", own.name) and reference.name in own.defined:
            continue
        same = [(stem, m) for stem, m in imported if m.name == (reference.module or own.name)]
        there = next((stem for stem, module in same if reference.name in module.defined), None)
        if there is not None:
            if own.name == (reference.module or own.name):
                reference.written.text = f"{there}.{reference.name}"
            continue
        if not any(stem == reference.module and reference.name in module.defined for stem, module in imported):
            problem = _problem(reference, own, dict(imported), complete)
            if problem:
                hint = neighbours.who_defines(reference.name)
                yield codes.UNKNOWN_TYPE.at(reference.span, problem=problem, name=reference.name, hint=hint)


def _problem(reference: Reference, own: ModuleNames, imported: Mapping[str, ModuleNames], complete: bool) -> str:
    """What is wrong with a reference that none of the known modules resolves; nothing if another one might."""
    name, module = reference.name, reference.module or own.name
    if module == own.name or module in imported or any(names.name == module for names in imported.values()):
        return f"module {module} defines no '{name}'" if complete or module != own.name or not imported else ""
    return f"module {module} is not imported, so '{module}::{name}' is unknown" if complete else ""
