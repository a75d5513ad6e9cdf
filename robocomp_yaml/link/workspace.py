"""Workspaces: their roots and settings, and the search path of imports."""

from __future__ import annotations

import os
from collections.abc import Iterator
from collections.abc import Mapping as Map
from typing import Any

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import SEVERITIES, Diagnostic
from robocomp_yaml.link.documents import read_tree
from robocomp_yaml.model.build_interface import entries, items
from robocomp_yaml.model.port_range import PortRange, port_range
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Mapping, Scalar

SUFFIX = ".idsl.yaml"


class WorkspaceSettings(msgspec.Struct, frozen=True):
    """The settings of a workspace. `root` is its folder; `declared` says whether it has an `rcyaml.yaml`. `interfaces`
    are folders of the search path, `output` maps kinds of output to folders (both joined with the root), `lint` maps
    codes to severities or 'off'; `plugins` are the plug-ins of the workspace. `ports` is the range of default TCP
    ports, None if it is not set."""

    root: str
    declared: bool = False
    interfaces: tuple[str, ...] = ()
    output: Map[str, str] = {}
    lint: Map[str, str] = {}
    plugins: Plugins = NONE
    ports: PortRange | None = None

    @property
    def slice_folder(self) -> str:
        """The folder of the Slice that is generated from interfaces."""
        return self.output.get("slice") or os.path.join(self.root, "slice")

    @property
    def runtime_folder(self) -> str:
        """The folder of the run time that components share; it has a folder for each language."""
        return self.output.get("runtime") or os.path.join(self.root, "runtime")


def root_above(folder: str, disk: Disk | None = None) -> str | None:
    """The root of the workspace of `folder`: the nearest folder, it or above, with an `rcyaml.yaml`. None if there is
    none. A relative folder gives a relative root."""
    disk = disk or Disk()
    root = folder or "."
    for _ in range(len(os.path.abspath(root).split(os.sep)) + 1):
        if disk.has_file(os.path.join(root, WORKSPACE_FILE)):
            return os.path.normpath(root)
        root = os.path.join(root, os.pardir)
    return None


def component_argument(name: str, document: str) -> str:
    """The argument that means a component in a command typed in the current folder: the component's name if the folder
    is in the same workspace, else its document."""
    current, own = root_above(""), root_above(os.path.dirname(document))
    is_same = current is not None and own is not None and os.path.realpath(current) == os.path.realpath(own)
    return name if is_same else document


def read(root: str, disk: Disk | None = None) -> tuple[WorkspaceSettings, list[Diagnostic]]:
    """Reads `root/rcyaml.yaml`. Returns its settings, none for an empty or wrong file, and diagnostics."""
    disk = disk or Disk()
    workspace = WorkspaceSettings(root, declared=True)
    path = os.path.normpath(os.path.join(root, WORKSPACE_FILE))
    tree, diagnostics = read_tree(path, disk)
    if tree is None:
        return workspace, [d for d in diagnostics if d.code != codes.EMPTY.id]
    diagnostics = schema.validate("workspace", tree)
    if diagnostics or not isinstance(tree, Mapping):
        return workspace, diagnostics
    named = (node.lexeme for node in items(tree, "interfaces") if isinstance(node, Scalar))
    output = ((key.lexeme, node.lexeme) for key, node in entries(tree, "output") if isinstance(node, Scalar))
    plugins, diagnostics = _plugins(tree)
    workspace = WorkspaceSettings(
        root,
        True,
        tuple(os.path.normpath(os.path.join(root, folder)) for folder in named),
        {kind: os.path.normpath(os.path.join(root, folder)) for kind, folder in output if folder},
        {key.lexeme: str(value.data) for key, value in entries(tree, "lint") if value.data is not None},
        plugins,
        port_range(tree),
    )
    return workspace, [*diagnostics, *_ineffective_settings(tree, workspace, disk)]


def _plugins(tree: Mapping) -> tuple[Plugins, list[Diagnostic]]:
    named = [(node.lexeme, node.span) for node in items(tree, "plugins") if isinstance(node, Scalar)]
    if not named:
        return NONE, []
    from robocomp_yaml.plugins import loading  # most workspaces name none

    return loading.resolve(named)


def above(path: str, disk: Disk | None = None) -> tuple[WorkspaceSettings, list[Diagnostic]]:
    """The settings of the workspace of a folder or file, and diagnostics. Without a declared workspace, that folder is
    the root."""
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    root = root_above(folder, disk)
    return (WorkspaceSettings(folder), []) if root is None else read(root, disk)


def _ineffective_settings(tree: Mapping, workspace: WorkspaceSettings, disk: Disk) -> Iterator[Diagnostic]:
    from robocomp_yaml.diag.codes import table

    root = workspace.root
    if workspace.ports is not None and workspace.ports.is_empty:
        yield workspace.ports.fault()
    for node in items(tree, "interfaces"):
        if isinstance(node, Scalar) and not disk.has_folder(os.path.join(root, node.lexeme)):
            yield codes.WORKSPACE_SETTING.at(node.span, problem=f"the folder '{node.lexeme}' does not exist")
    for key, value in entries(tree, "lint"):
        if key.lexeme not in table() and key.lexeme not in workspace.plugins.codes and workspace.plugins.whole:
            yield codes.WORKSPACE_SETTING.at(
                key.span, problem=f"unknown code {key.lexeme}", hint="`rcyaml explain` lists them"
            )
        elif value.data not in (*SEVERITIES, "off"):
            yield codes.WORKSPACE_SETTING.at(value.span, problem=f"unknown severity '{value.data}'")


class Workspaces(msgspec.Struct, frozen=True):
    """The workspaces of documents. The settings of each are read at their first use."""

    disk: Disk = msgspec.field(default_factory=Disk)
    _read: dict[str, tuple[WorkspaceSettings, list[Diagnostic]]] = {}  # by the real path of the root
    _by_folder: dict[str, WorkspaceSettings] = {}

    @property
    def caches(self) -> tuple[dict[str, Any], ...]:
        """What was read until now."""
        return self._read, self._by_folder

    def of(self, path: str) -> WorkspaceSettings:
        """The settings of a document's workspace; without a declared workspace, its root is the document's folder."""
        folder = os.path.dirname(path)
        if folder not in self._by_folder:
            root = root_above(folder, self.disk)
            self._by_folder[folder] = WorkspaceSettings(folder) if root is None else self._settings(root)
        return self._by_folder[folder]

    def plugins_of(self, path: str) -> Plugins:
        """The plug-ins of a document's workspace."""
        return self.of(path).plugins

    @property
    def declared(self) -> list[WorkspaceSettings]:
        """The workspaces with a settings file to which documents belong."""
        return [settings for settings, _ in self._read.values()]

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The errors in the settings of these workspaces."""
        return [diagnostic for _, diagnostics in self._read.values() for diagnostic in diagnostics]

    def _settings(self, root: str) -> WorkspaceSettings:
        real = self.disk.real(root)
        if real not in self._read:
            self._read[real] = read(root, self.disk)
        return self._read[real][0]


class ImportSearch(msgspec.Struct, frozen=True):
    """Resolves imports: in the document's folder, the workspace's folders, then `extra` (`-I`, RCYAML_PATH)."""

    extra: tuple[str, ...] = ()
    disk: Disk = msgspec.field(default_factory=Disk)
    _names: dict[str, tuple[frozenset[str], dict[str, str]]] = {}

    @property
    def cache(self) -> dict[str, Any]:
        """The names in the folders that were searched until now."""
        return self._names

    def find(self, name: str, document: str, workspace: WorkspaceSettings) -> tuple[str | None, bool]:
        """Returns the path of an imported document, or None, and whether only its case differs from the import."""
        beside = os.path.dirname(document)
        tail = name if name.endswith(SUFFIX) else name + SUFFIX
        folders = [beside]
        if not name.startswith((".", "/")):
            folders += [*workspace.interfaces, *self.extra]
        candidates = list(dict.fromkeys(os.path.normpath(os.path.join(folder, tail)) for folder in folders))
        for path in candidates:
            if os.path.basename(path) in self._listed(path)[0]:
                return path, False
        for path in candidates:
            actual = self._listed(path)[1].get(os.path.basename(path).lower())
            if actual:
                return os.path.join(os.path.dirname(path), actual), True
        return None, False

    def known(self, document: str, workspace: WorkspaceSettings) -> list[str]:
        """The names of all documents that a document can import."""
        folders = [os.path.dirname(document), *workspace.interfaces, *self.extra]
        names = {n for f in folders for n in self._listed(os.path.join(f, "x"))[0] if n.endswith(SUFFIX)}
        return sorted(name.removesuffix(SUFFIX) for name in names)

    def _listed(self, path: str) -> tuple[frozenset[str], dict[str, str]]:
        """The names in the folder of a path, and a map from their lower case to these names."""
        folder = os.path.dirname(path)
        if folder not in self._names:
            names = self.disk.documents(folder)
            self._names[folder] = frozenset(names), {name.lower(): name for name in names}
        return self._names[folder]
