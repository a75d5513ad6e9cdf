"""Link the names of one run: what interfaces and components refer to, and which file defines it.

RoboComp's own tool looked for interfaces in all files that it had read, also in those that only imports import. It did
not look for types at all, so that files kept the names of types that moved to another module.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.document import List, Map
from robocomp_yaml.legacy.draft import ComponentDraft, ModuleDraft, ModuleNames, Reference, base_name
from robocomp_yaml.legacy.linking import InterfaceFiles, add_import, imports_of, is_copy
from robocomp_yaml.link.workspace import SUFFIX, WorkspaceSettings
from robocomp_yaml.source.heading import root_of

_PORTS = ("implements", "requires", "publishes", "subscribes")


class FilesBehind:
    """The interface files behind the imports of a file, directly or not, the nearest first."""

    def __init__(self, file: Converted, interfaces: InterfaceFiles) -> None:
        self.direct: dict[str, ModuleDraft] = {}
        self.others: dict[str, ModuleDraft] = {}
        self.is_whole = True
        seen, todo = {file.path}, [file]
        while todo:
            importer = todo.pop(0)
            for each in imports_of(importer):
                target = interfaces.imported(importer, str(each.entry.value))
                if target is None or not isinstance(target.draft, ModuleDraft):
                    self.is_whole = False
                elif target.path not in seen:
                    seen.add(target.path)
                    todo.append(target)
                    if importer is file:
                        self.direct[base_name(target.path)] = target.draft
                    elif not is_copy(target):
                        self.others[base_name(target.path)] = target.draft

    def definer(self, name: str, *, also_direct: bool = False) -> str:
        """The only file that defines a name, by its stem; '' if several or none do."""
        files = {**self.others, **(self.direct if also_direct else {})}
        found = [stem for stem, draft in files.items() if name in draft.names.defined]
        return found[0] if len(found) == 1 else ""


def add_imports_of_interfaces(
    file: Converted, document: str, workspace: WorkspaceSettings, interfaces: InterfaceFiles
) -> Iterator[Diagnostic]:
    """Import the files of a component's interfaces that only its imports import. `document` is the component's."""
    draft = file.draft
    if not isinstance(draft, ComponentDraft) or not draft.imports:
        return
    behind = FilesBehind(file, interfaces)
    unknown = [
        name
        for name in dict.fromkeys(_interfaces(draft.document))
        if all(name not in module.names.defined for module in behind.direct.values())
    ]
    migrated = dict(_migrated(draft, document, workspace, interfaces)) if unknown and not behind.is_whole else {}
    direct = {str(each.entry.value) for each in draft.imports}
    for name in unknown:
        defining = [stem for stem, names in migrated.items() if name in names]
        stem = behind.definer(name) or (defining[0] if len(defining) == 1 else "")
        if stem and stem not in direct:
            add_import(draft.document, stem)
            yield codes.IMPORT_ADDED.at(draft.imports[0].span, name=name, stem=stem)


def _migrated(
    draft: ComponentDraft, document: str, workspace: WorkspaceSettings, interfaces: InterfaceFiles
) -> Iterator[tuple[str, Collection[str]]]:
    """The interfaces of the documents behind a component's imports, which an earlier run migrated."""
    todo = [(str(each.entry.value), document) for each in draft.imports]
    seen = set()
    while todo:
        stem, importer = todo.pop(0)
        path = interfaces.find(stem, importer, workspace)
        if path is None or path in seen:
            continue
        seen.add(path)
        root = root_of(path)
        content = root.data if root is not None and isinstance(root.data, dict) else {}
        defined, imports = content.get("interfaces"), content.get("imports")
        yield base_name(path.removesuffix(SUFFIX)), tuple(defined) if isinstance(defined, dict) else ()
        todo += [(str(each), path) for each in imports] if isinstance(imports, list) else []


def resolve_references(file: Converted, interfaces: InterfaceFiles) -> Iterable[Diagnostic]:
    """Report references of a module that no known module defines. Imports from outside of the run may define more
    names.

    In Slice, several files may contain parts of one module, and need not qualify each other's names. Documents qualify
    them.
    """
    if not isinstance(file.draft, ModuleDraft):
        return
    imported: list[tuple[str, ModuleNames]] = []
    all_known = True
    for each in file.draft.imports:
        target = interfaces.imported(file, str(each.entry.value))
        if target is None or not isinstance(target.draft, ModuleDraft):
            all_known = False
        else:
            imported.append((each.stem, target.draft.names))
    own = file.draft.names
    for reference in own.references:
        if reference.module in ("", own.name) and reference.name in own.defined:
            continue
        same = [(stem, m) for stem, m in imported if m.name == (reference.module or own.name)]
        definer = next((stem for stem, module in same if reference.name in module.defined), None)
        if definer is not None:
            if own.name == (reference.module or own.name):
                reference.written.text = f"{definer}.{reference.name}"
            continue
        if not any(stem == reference.module and reference.name in module.defined for stem, module in imported):
            problem = _problem(reference, own, dict(imported), all_known)
            moved = _moved(file, reference, interfaces) if problem else None
            if moved is not None:
                yield moved
            elif problem:
                hint = interfaces.definer_hint(reference.name)
                yield codes.UNKNOWN_TYPE.at(reference.span, problem=problem, name=reference.name, hint=hint)


def _problem(reference: Reference, own: ModuleNames, imported: Mapping[str, ModuleNames], all_known: bool) -> str:
    """Return why a reference is unknown; '' if a module outside of the run may define it."""
    name, module = reference.name, reference.module or own.name
    if module == own.name or module in imported or any(names.name == module for names in imported.values()):
        return f"module {module} defines no '{name}'" if all_known or module != own.name or not imported else ""
    return f"module {module} is not imported, so '{module}::{name}' is unknown" if all_known else ""


def _moved(file: Converted, reference: Reference, interfaces: InterfaceFiles) -> Diagnostic | None:
    """Write a reference that no import defines as that of the only file that does: the one of the module that it names,
    else one of those behind the imports."""
    draft = file.draft
    assert isinstance(draft, ModuleDraft)
    named = interfaces.defining(reference.module, reference.name)
    stem = named[0] if len(named) == 1 else ""
    if not named:
        # A type of another module moved to a file that this module imports.
        targets = [interfaces.imported(file, str(each.entry.value)) for each in draft.imports]
        modules = [(each, each.draft) for each in targets if each is not None]
        homes = [each for each, it in modules if isinstance(it, ModuleDraft) and it.names.name == reference.module]
        stem = FilesBehind(homes[0] if homes else file, interfaces).definer(reference.name, also_direct=True)
    if not stem:
        return None
    spelled = f"{reference.module}::{reference.name}" if reference.module else reference.name
    reference.written.text = f"{stem}.{reference.name}"
    if all(str(each.entry.value) != stem for each in draft.imports):
        add_import(draft.document, stem)
    return codes.TYPE_MOVED.at(reference.span, name=spelled, stem=stem, written=reference.written.text)


def _interfaces(document: Map) -> Iterable[str]:
    for key in _PORTS:
        listed = document.get(key)
        for item in listed.items if isinstance(listed, List) else ():
            value = item.value
            if isinstance(value, Map):
                value = value.entries[0].value
            if isinstance(value, Map):
                value = value.get("interface")
            if isinstance(value, str):
                yield value
