"""The workspace: the nearest folder above a document that holds `rcyaml.yaml`, and where imports are looked for."""

from __future__ import annotations

import os
from collections.abc import Iterator
from collections.abc import Mapping as Map

import msgspec

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import SEVERITIES, Diagnostic
from robocomp_yaml.model.build_interface import entries, items
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source import schema
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping, Scalar, parse

SUFFIX = ".idsl.yaml"


class WorkspaceSettings(msgspec.Struct, frozen=True):
    """`root` is the workspace's folder; `declared` says whether it has an `rcyaml.yaml`. `interfaces` are folders to
    look for imports in, `output` those of outputs where it names some (both joined with the root), `lint` a severity
    (or 'off') by code; `plugins` are those that it names."""

    root: str
    declared: bool = False
    interfaces: tuple[str, ...] = ()
    output: Map[str, str] = {}
    lint: Map[str, str] = {}
    plugins: Plugins = NONE

    @property
    def slice_folder(self) -> str:
        """Where the Slice of its interfaces goes."""
        return self.output.get("slice") or os.path.join(self.root, "slice")

    @property
    def runtime_folder(self) -> str:
        """Where the run time goes that its components share, a folder for each language."""
        return self.output.get("runtime") or os.path.join(self.root, "runtime")


def root_above(folder: str, disk: Disk | None = None) -> str | None:
    """The nearest folder at or above one that holds `rcyaml.yaml`, spelled relative where `folder` is."""
    disk = disk or Disk()
    here = folder or "."
    for _ in range(len(os.path.abspath(here).split(os.sep)) + 1):
        if disk.has_file(os.path.join(here, WORKSPACE_FILE)):
            return os.path.normpath(here)
        here = os.path.join(here, os.pardir)
    return None


def component_argument(name: str, document: str) -> str:
    """A component as a command takes it that is typed here: by its name in its own workspace, else by its document."""
    here, there = root_above(""), root_above(os.path.dirname(document))
    is_here = here is not None and there is not None and os.path.realpath(here) == os.path.realpath(there)
    return name if is_here else document


def read(root: str, disk: Disk | None = None) -> tuple[WorkspaceSettings, list[Diagnostic]]:
    """The workspace that `root/rcyaml.yaml` declares; an empty file is one without settings."""
    disk = disk or Disk()
    workspace = WorkspaceSettings(root, declared=True)
    path = os.path.normpath(os.path.join(root, WORKSPACE_FILE))
    raw, diagnostics = disk.read(path)
    if raw is None:
        return workspace, diagnostics
    content, diagnostics = decode(path, raw)
    if content is None:
        return workspace, diagnostics
    tree, diagnostics = parse(path, content)
    if tree is None:
        return workspace, [d for d in diagnostics if d.code != codes.EMPTY.id]
    diagnostics = schema.validate("workspace", tree)
    if diagnostics or not isinstance(tree, Mapping):
        return workspace, diagnostics
    named = (node.lexeme for node in items(tree, "interfaces") if isinstance(node, Scalar))
    output = ((key.lexeme, node.lexeme) for key, node in entries(tree, "output") if isinstance(node, Scalar))
    plugins, said = _plugins(tree)
    workspace = WorkspaceSettings(
        root,
        True,
        tuple(os.path.normpath(os.path.join(root, folder)) for folder in named),
        {kind: os.path.normpath(os.path.join(root, folder)) for kind, folder in output if folder},
        {key.lexeme: str(value.data) for key, value in entries(tree, "lint") if value.data is not None},
        plugins,
    )
    return workspace, [*said, *_idle_settings(tree, workspace, disk)]


def _plugins(tree: Mapping) -> tuple[Plugins, list[Diagnostic]]:
    named = [(node.lexeme, node.span) for node in items(tree, "plugins") if isinstance(node, Scalar)]
    if not named:
        return NONE, []
    from robocomp_yaml.plugins import finding  # most workspaces name none

    return finding.found(named)


def above(path: str, disk: Disk | None = None) -> tuple[WorkspaceSettings, list[Diagnostic]]:
    """The workspace that a folder, or a file, belongs to; without a declared one, that folder."""
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    root = root_above(folder, disk)
    return (WorkspaceSettings(folder), []) if root is None else read(root, disk)


def _idle_settings(tree: Mapping, workspace: WorkspaceSettings, disk: Disk) -> Iterator[Diagnostic]:
    from robocomp_yaml.diag.codes import table

    root = workspace.root
    for node in items(tree, "interfaces"):
        if isinstance(node, Scalar) and not disk.has_folder(os.path.join(root, node.lexeme)):
            yield codes.WORKSPACE_SETTING.at(node.span, problem=f"there is no folder '{node.lexeme}'")
    for key, value in entries(tree, "lint"):
        if key.lexeme not in table() and key.lexeme not in workspace.plugins.codes and workspace.plugins.whole:
            yield codes.WORKSPACE_SETTING.at(
                key.span, problem=f"no diagnostic is called {key.lexeme}", hint="`rcyaml explain` lists them"
            )
        elif value.data not in (*SEVERITIES, "off"):
            yield codes.WORKSPACE_SETTING.at(value.span, problem=f"'{value.data}' is no severity")


class ImportSearch(msgspec.Struct):
    """Looks imports up: beside the document, in the workspace's folders, then in the extra ones (`-I`, RCYAML_PATH)."""

    extra: tuple[str, ...] = ()
    disk: Disk = msgspec.field(default_factory=Disk)
    _names: dict[str, tuple[frozenset[str], dict[str, str]]] = {}

    def find(self, name: str, document: str, workspace: WorkspaceSettings) -> tuple[str | None, bool]:
        """The path of an imported document, or None; and whether its name differs in case."""
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
        """The names that an import of this document could have."""
        folders = [os.path.dirname(document), *workspace.interfaces, *self.extra]
        names = {n for f in folders for n in self._listed(os.path.join(f, "x"))[0] if n.endswith(SUFFIX)}
        return sorted(name.removesuffix(SUFFIX) for name in names)

    def _listed(self, path: str) -> tuple[frozenset[str], dict[str, str]]:
        """The names in a path's folder, and the same by their lower case."""
        folder = os.path.dirname(path)
        if folder not in self._names:
            names = self.disk.documents(folder)
            self._names[folder] = frozenset(names), {name.lower(): name for name in names}
        return self._names[folder]
