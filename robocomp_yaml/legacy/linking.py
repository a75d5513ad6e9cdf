"""Link the files of one run: resolve imports and state machines."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.listing import some
from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.document import DocumentEntry, List, Map
from robocomp_yaml.legacy.draft import ComponentDraft, ImportDraft, ModuleDraft, base_name
from robocomp_yaml.link.workspace import SUFFIX, ImportSearch, WorkspaceSettings
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.disk import names_in

INTERFACES = "idsl"

_IDSLS = "interfaces/IDSLs"

COPIES = ("src", "generated")
"""The folders of a component that have copies of interfaces."""


class InterfaceFiles(msgspec.Struct, frozen=True):
    """The interface files of a run by their stem, and the search path for all others. `copies` are those that RoboComp
    copied into the `src/` or `generated/` of a component."""

    search: ImportSearch
    by_stem: dict[str, list[Converted]] = {}
    copies: dict[str, list[Converted]] = {}
    _listed: dict[str, dict[str, str]] = {}
    _used: dict[str, None] = {}

    @classmethod
    def of(cls, files: Iterable[Converted], search: ImportSearch) -> InterfaceFiles:
        interfaces = cls(search)
        for file in files:
            interfaces.add(file)
        return interfaces

    def add(self, file: Converted) -> None:
        """Add a file of the run, if it is an interface."""
        if file.rules is not None and file.rules.kind == INTERFACES:
            by_stem = self.copies if is_copy(file) else self.by_stem
            by_stem.setdefault(base_name(file.path), []).append(file)

    def imported(self, importer: Converted, stem: str) -> Converted | None:
        """Return the file of the run that an import refers to: the one in the importer's folder, else the first; else
        the component's own copy, else the first copy."""
        folder = os.path.dirname(importer.path)
        copies = self.copies.get(stem, [])
        for files, homes in (
            (self.by_stem.get(stem, []), {folder}),
            (copies, {folder, *(os.path.join(folder, name) for name in COPIES)}),
        ):
            if files:
                return next((file for file in files if os.path.dirname(file.path) in homes), files[0])
        return None

    def folders_used(self, root: str) -> list[str]:
        """Return the folders of the search path in which imports were found, relative to `root` unless they were passed
        as absolute paths."""
        return [path if os.path.isabs(path) else os.path.relpath(path, root) for path in self._used]

    def find(self, stem: str, document: str, workspace: WorkspaceSettings) -> str | None:
        """Return the document of an import, which has its name but for the case."""
        match, _ = self.search.find(stem, document, workspace)
        folder = os.path.dirname(match or "")
        for extra in self.search.extra:
            if match and os.path.normpath(extra) == folder and folder not in workspace.interfaces:
                self._used.setdefault(extra)
        return match

    def original(self, stem: str, workspace: WorkspaceSettings) -> str | None:
        """Return the path of the interface that a copy with this stem was made from, if it is known."""
        if stem in self.by_stem:
            return self.by_stem[stem][0].path
        folders = (*workspace.interfaces, *self.search.extra)
        documents = (os.path.normpath(os.path.join(folder, f"{stem}.idsl.yaml")) for folder in folders)
        return next((document for document in documents if os.path.isfile(document)), None)

    def beside(self, importer: Converted) -> dict[str, str]:
        """Return the stems of the interface files in an importer's folder, by their lower case."""
        folder = os.path.dirname(importer.path)
        if folder not in self._listed:
            known = (base_name(name) for name in names_in(folder) if name.lower().endswith((".idsl", ".ice")))
            self._listed[folder] = {stem.lower(): stem for stem in known}
        return self._listed[folder]

    def defining(self, module: str, name: str) -> list[str]:
        """Return the stems of the files of the run that define a name in a module."""
        drafts = [(stem, file.draft) for stem, files in self.by_stem.items() for file in files]
        modules = [(stem, draft.names) for stem, draft in drafts if isinstance(draft, ModuleDraft)]
        return [stem for stem, names in modules if module and names.name == module and name in names.defined]

    def definer_hint(self, name: str) -> str:
        """Return a hint which interface file of the run defines a name, or ''."""
        for stem, files in sorted(self.by_stem.items()):
            for file in files:
                names = file.draft.names if isinstance(file.draft, ModuleDraft) else None
                if names is not None and name in names.defined:
                    return f"{stem} defines it: import {stem}, and write {names.name}::{name}"
        return ""


def is_copy(file: Converted) -> bool:
    """Whether an interface file is in the `src/` or `generated/` of a component, where RoboComp copies interfaces."""
    folder = os.path.dirname(file.path)
    if file.rules is None or not file.rules.is_made or os.path.basename(folder) not in COPIES:
        return False
    names = {*names_in(folder), *names_in(os.path.dirname(folder) or ".")}
    return any(name.lower().endswith((".cdsl", ".jcdsl")) or name.startswith("specificworker.") for name in names)


def imports_of(file: Converted) -> tuple[ImportDraft, ...]:
    """Return the imports of an interface or a component."""
    return file.draft.imports if isinstance(file.draft, (ModuleDraft, ComponentDraft)) else ()


def name_imports(
    file: Converted, documents: Mapping[str, str], workspace: WorkspaceSettings, interfaces: InterfaceFiles
) -> Iterable[Diagnostic]:
    """Resolve the imports of a file and write their names into its document; report imports that are unknown, or
    spelled in another case."""
    for imported in imports_of(file):
        name = _name(imported, file, documents, workspace, interfaces)
        if name is None:
            yield codes.IMPORT_UNKNOWN.at(
                imported.span, name=imported.stem, hint=_where(imported.stem, interfaces.search.extra)
            )
        elif name.lower() == imported.stem.lower() and name != imported.stem:
            yield codes.IMPORT_CASE.at(imported.span, name=imported.stem, found=name)
        imported.entry.value = name or imported.stem
        if imported.is_added and name and name != imported.stem and isinstance(file.draft, ComponentDraft):
            add_import(file.draft.document, name)


def add_import(document: Map, stem: str) -> None:
    """Add a name to the imports of a document, once."""
    listed = document.get("imports")
    if isinstance(listed, List):
        if all(item.value != stem for item in listed.items):
            listed.put(stem)
        return
    at = next((n for n, entry in enumerate(document.entries) if entry.key not in ("module", "component", "doc")), None)
    document.entries.insert(len(document.entries) if at is None else at, DocumentEntry("imports", List.of([stem])))


def _where(stem: str, searched: Sequence[str]) -> str:
    """Return a hint where RoboComp keeps an interface that is in none of the folders `searched`."""
    homes = (
        os.environ.get("ROBOCOMP", ""),
        os.path.expanduser("~/robocomp"),
        "/opt/robocomp",
        "/home/robocomp/robocomp",
    )
    for folder in (os.path.join(home, _IDSLS) for home in homes if home):
        if os.path.isfile(os.path.join(folder, f"{stem}.idsl")):
            return f"{os.path.join(folder, stem)}.idsl exists: add `-I {folder}`"
    if searched:
        return f"it is not in {some(searched)}, either: pass the folder that has it with -I, too"
    return f"RoboComp's own interfaces are in {_IDSLS} of its repository, robocomp/robocomp: pass that folder with -I"


def _name(
    imported: ImportDraft, file: Converted, documents: Mapping[str, str], workspace: WorkspaceSettings,
    interfaces: InterfaceFiles,
) -> str | None:  # fmt: skip
    stem, beside, document = imported.stem, interfaces.beside(file), documents[file.path]
    match = interfaces.find(stem, document, workspace)
    other_case = match is not None and os.path.basename(match) != stem + SUFFIX
    if stem not in interfaces.by_stem and stem in interfaces.copies and not (match and not other_case):
        copy = interfaces.imported(file, stem)
        assert copy is not None
        other = documents[copy.path].removesuffix(SUFFIX)
        return os.path.relpath(other, os.path.dirname(document) or ".")
    if stem in interfaces.by_stem or beside.get(stem.lower()) == stem or (match and not other_case):
        return stem
    path = imported.path.replace("\\", "/")
    if "/" in path and not path.startswith("/"):
        target = os.path.join(os.path.dirname(file.path), path)
        if os.path.isfile(target) or os.path.isfile(f"{target}.idsl"):
            return os.path.normpath(path).removesuffix(".idsl").removesuffix(".ice")
    by_lower_case = {known.lower(): known for known in sorted(interfaces.by_stem)}
    if match:
        return os.path.basename(match).removesuffix(".idsl.yaml")
    return by_lower_case.get(stem.lower()) or beside.get(stem.lower())


def name_machine(file: Converted, documents: Mapping[str, str]) -> Iterable[Diagnostic]:
    """Write the path of a component's state machine into its document; report a path at which no file will exist."""
    machine = file.draft.machine if isinstance(file.draft, ComponentDraft) else None
    if machine is None:
        return
    home = os.path.dirname(documents[file.path])
    legacy = os.path.normpath(os.path.join(os.path.dirname(file.path), machine.path))
    migrated = next((document for path, document in documents.items() if os.path.normpath(path) == legacy), None)
    if migrated is not None:
        machine.entry.value = os.path.relpath(migrated, home or ".")
        return
    if not os.path.isfile(os.path.join(home, machine.document)):
        yield codes.STATE_MACHINE.at(machine.span, legacy=machine.path, path=machine.document)


def not_searched(
    file: Converted, workspace: WorkspaceSettings, documents: Mapping[str, str], interfaces: InterfaceFiles
) -> Iterable[tuple[str, Diagnostic]]:
    """Report imports whose documents are written outside of the workspace's search path, each with its folder."""
    search_path = {os.path.dirname(documents[file.path]), *workspace.interfaces, *interfaces.search.extra}
    known = {os.path.realpath(folder or ".") for folder in search_path}
    for imported in imports_of(file):
        target = interfaces.imported(file, str(imported.entry.value))
        document = documents.get(target.path) if target is not None else None
        folder = os.path.dirname(document) or "." if document is not None else ""
        if folder and os.path.realpath(folder) not in known:
            inside = os.path.relpath(folder, workspace.root)
            hint = f"add {inside} to `interfaces:` in {os.path.join(workspace.root, WORKSPACE_FILE)}"
            yield folder, codes.NOT_SEARCHED.at(imported.span, name=imported.entry.value, folder=folder, hint=hint)
