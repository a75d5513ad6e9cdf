"""The workspaces of migrated documents, and the `rcyaml.yaml` of a migrated folder."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable

import msgspec

from robocomp_yaml.diag.codes import cdsl, idsl, machines
from robocomp_yaml.legacy.document import List, Map, Notes, text
from robocomp_yaml.legacy.outputs import OutputRoot
from robocomp_yaml.link import workspace as link_workspace
from robocomp_yaml.link import workspace_files
from robocomp_yaml.link.workspace import WorkspaceSettings, root_above
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.inside import stays_inside


class Workspaces(msgspec.Struct, frozen=True):
    """The workspaces of a run. `new` are the folders that become workspaces by it."""

    new: list[str] = []
    _known: dict[str, WorkspaceSettings] = {}

    def of(self, document: str) -> WorkspaceSettings:
        """Return the workspace of a document, which may not exist yet."""
        folder = os.path.dirname(document) or "."
        if folder not in self._known:
            inside = [new for new in self.new if stays_inside(new, os.path.realpath(folder))]
            above = root_above(folder)
            if inside and (above is None or not stays_inside(max(inside, key=len), os.path.realpath(above))):
                self._known[folder] = _renewed(max(inside, key=len))
            elif above is not None:
                self._known[folder] = link_workspace.read(above)[0]
            else:
                self._known[folder] = WorkspaceSettings(folder)
        return self._known[folder]


def _renewed(root: str) -> WorkspaceSettings:
    """Return a workspace of a run, which has the folders of interfaces of an earlier one: this one need not convert
    again what is in them."""
    earlier = link_workspace.read(root)[0].interfaces if os.path.isfile(os.path.join(root, WORKSPACE_FILE)) else ()
    return WorkspaceSettings(root, interfaces=tuple(filter(os.path.isdir, earlier)), declared=True)


def needs_file(root: OutputRoot) -> bool:
    """Whether a migrated folder gets an `rcyaml.yaml`: it is in no workspace, or has the file of an earlier run."""
    above = root_above(root.root.path)
    if above is None:
        return True
    return os.path.realpath(above) == root.root.real and root.is_unchanged(WORKSPACE_FILE)


def file_text(root: str, documents: Iterable[tuple[str, str, Map]], others: Iterable[str]) -> str:
    """Return the `rcyaml.yaml` of a migrated folder, for documents as (kind, path, content): the folders of interfaces,
    in `documents` and `others`, and as warnings the errors that are usual in legacy repositories and matter only to
    compile."""
    document, lint = Map(block=True), Map(block=True)
    folders: dict[str, set[str]] = {"idsl": set(), "cdsl": set()}
    components: Counter[str] = Counter()
    for kind, path, content in documents:
        components.update(_component(content) if kind == "cdsl" else ())
        folder = os.path.relpath(os.path.dirname(path) or ".", root)
        folders.setdefault(kind, set()).add(folder)
    found = [*sorted(folders["idsl"]), *others]
    known = {os.path.realpath(os.path.join(root, folder)) for folder in found}
    earlier = [path for path in _renewed(root).interfaces if os.path.realpath(path) not in known]
    found[len(folders["idsl"]) : len(folders["idsl"])] = [os.path.relpath(path, root) for path in earlier]
    # A name that is not UTF-8 is not valid text.
    if listed := [folder for folder in found if folder.isprintable()]:
        document.put("interfaces", List.of(listed))
    for row in (idsl.UNRESOLVED_IMPORT, cdsl.UNRESOLVED_IMPORT, machines.UNREADABLE):
        lint.put(row.id, "warning")
    if components and max(components.values()) > 1:
        notes = Notes(head=["Several components have the same name, as in the legacy files."])
        lint.put(cdsl.SAME_NAME.id, "warning", notes)
    document.put("lint", lint, Notes(head=["Documents refer to files that were missing when they were migrated."]))
    modeline = workspace_files.modeline("workspace", os.path.join(root, WORKSPACE_FILE), root)
    return f"{modeline}\n{text(document, Notes())}"


def values_modeline(document: str, folder: str) -> str:
    """Return the modeline of a values document of the component in a folder."""
    schema = os.path.join(folder, "generated", "config.schema.json")
    return f"# yaml-language-server: $schema={os.path.relpath(schema, os.path.dirname(document) or '.')}"


def _component(content: Map) -> list[str]:
    """Return what identifies a component: its name and language."""
    language = content.get("language")
    language = language.get("name") if isinstance(language, Map) else language
    return [f"{content.get('component')} in {language}"]
