"""The workspace that a document belongs to: its schemas' place, and the `rcyaml.yaml` of a folder that is migrated."""

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


class Workspaces(msgspec.Struct, frozen=True):
    """`new` are folders that will be workspaces after this run."""

    new: list[str] = []
    _known: dict[str, WorkspaceSettings] = {}

    def of(self, document: str) -> WorkspaceSettings:
        """The workspace of a document that is, or will be, there."""
        folder = os.path.dirname(document) or "."
        if folder not in self._known:
            inside = [new for new in self.new if _is_below(folder, new)]
            above = root_above(folder)
            if inside and (above is None or not _is_below(above, max(inside, key=len))):
                self._known[folder] = WorkspaceSettings(max(inside, key=len), declared=True)
            elif above is not None:
                self._known[folder] = link_workspace.read(above)[0]
            else:
                self._known[folder] = WorkspaceSettings(folder)
        return self._known[folder]


def wants_file(root: OutputRoot) -> bool:
    """Whether a migrated folder gets an `rcyaml.yaml`: it is in no workspace, or ours is there already."""
    above = root_above(root.root.path)
    if above is None:
        return True
    return os.path.realpath(above) == root.root.real and root.is_ours(WORKSPACE_FILE)


def file_text(root: str, documents: Iterable[tuple[str, str, Map]]) -> str:
    """The `rcyaml.yaml` of a migrated folder, for documents with their kinds and contents: where its interfaces are,
    and what a legacy repository does that only becomes wrong when it is compiled."""
    document, lint = Map(block=True), Map(block=True)
    folders: dict[str, set[str]] = {"idsl": set(), "cdsl": set()}
    components: Counter[str] = Counter()
    for kind, path, content in documents:
        components.update(_component(content) if kind == "cdsl" else ())
        folder = os.path.relpath(os.path.dirname(path) or ".", root)
        folders.setdefault(kind, set()).add(folder)
    if folders["idsl"]:
        listed = [folder for folder in sorted(folders["idsl"]) if folder.isprintable()]  # what is not UTF-8 is no text
        document.put("interfaces", List.of(listed))
    for row in (idsl.UNRESOLVED_IMPORT, cdsl.UNRESOLVED_IMPORT, machines.UNREADABLE):
        lint.put(row.id, "warning")
    if components and max(components.values()) > 1:
        notes = Notes(head=["Components that have the same name are kept as they were."])
        lint.put(cdsl.SAME_NAME.id, "warning", notes)
    document.put("lint", lint, Notes(head=["Files that were not there to be migrated are named still."]))
    return modeline(os.path.join(root, WORKSPACE_FILE), root, "workspace") + text(document, Notes())


def modeline(document: str, root: str, kind: str) -> str:
    return workspace_files.modeline(kind, document, root) + "\n"


def values_modeline(document: str, folder: str) -> str:
    """The modeline of values of the component in a folder."""
    schema = os.path.join(folder, "generated", "config.schema.json")
    return f"# yaml-language-server: $schema={os.path.relpath(schema, os.path.dirname(document) or '.')}\n"


def _component(content: Map) -> list[str]:
    """What tells a component from others: its name and language."""
    entries = {entry.key: entry.value for entry in content.entries}
    language = entries.get("language")
    if isinstance(language, Map):
        language = next((entry.value for entry in language.entries if entry.key == "name"), "")
    return [f"{entries.get('component')} in {language}"]


def _is_below(path: str, folder: str) -> bool:
    inner, outer = os.path.realpath(path), os.path.realpath(folder)
    return inner == outer or inner.startswith(outer.rstrip("/") + "/")
