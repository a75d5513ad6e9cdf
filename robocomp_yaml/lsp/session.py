"""The documents of an editor, and their diagnostics, apart from the protocol.

Documents belong to workspaces: the folder of the next `rcyaml.yaml` above, or the folder that the editor has opened. A
document outside of any is a workspace of its own. Each workspace has a living analysis, which sees the texts of all
open documents. The diagnostics of one document are those of the document and all that it names; whether others
contradict it, only the diagnostics of the workspace say.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from contextlib import suppress

import msgspec

from robocomp_yaml.api.living import LivingWorkspace
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.workspace import ImportSearch, above, root_above
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import Names
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import WORKSPACE_FILE, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentTexts

_MODELINE = re.compile(r"^#\s*yaml-language-server\s*:.*\$schema", re.MULTILINE)
_HEAD = 10_000  # characters that editors search
_SETTINGS = (".vscode/settings.json", ".yamlls.json", ".helix/languages.toml")
Found = dict[str, list[Diagnostic]]
"""Diagnostics by the paths of their documents."""


class Cancelled(Exception):
    """The analysis of a workspace was given up, because the user types on."""


class EditedText(msgspec.Struct):
    """An open document."""

    uri: str
    path: str
    text: str
    version: int | None = None

    @property
    def raw(self) -> bytes:
        return self.text.encode("utf-8", "surrogatepass")  # half a pair is an error of the document, not of ours


class KnownNames(msgspec.Struct, frozen=True):
    """The names of a program, with the texts in which they are."""

    names: Names
    analysis: Analysis

    @property
    def texts(self) -> DocumentTexts:
        return self.analysis.texts

    @property
    def search(self) -> ImportSearch:
        return self.analysis.search

    @property
    def program(self) -> Program:
        return self.analysis.program


class OpenWorkspace:
    """A workspace with open documents. `root` is its folder, or the document itself if it belongs to none. `found` are
    its last diagnostics, and `texts` the texts that they refer to. `beyond` are those of open documents that only the
    whole workspace shows, with the lines that they are about."""

    def __init__(self, root: str, include: Iterable[str]) -> None:
        self.root, self.living = root, LivingWorkspace((root,), include)
        self.is_known = False  # whether it was analysed as a whole
        self.found: Found = {}
        self.names: KnownNames | None = None
        self.last_names: KnownNames | None = None  # of the texts before the last edits
        self.texts = DocumentTexts({}, {})
        self.beyond: dict[str, list[tuple[Diagnostic, str]]] = {}


class Session:
    """`folders` are those that the editor has opened. Paths are real paths."""

    def __init__(self, folders: Iterable[str] = (), include: Iterable[str] = ()) -> None:
        self.folders = [os.path.realpath(folder) for folder in folders]
        self.include = tuple(include)
        self.open: dict[str, EditedText] = {}
        self.workspaces: dict[str, OpenWorkspace] = {}
        self._has_settings: dict[str, bool] = {}

    def edit(self, document: EditedText) -> None:
        """A document was opened or changed."""
        self._forget_names()
        self.open[document.path] = document
        for workspace in self.workspaces.values():
            workspace.living.edit(document.path, document.raw)

    def close(self, path: str) -> list[str]:
        """A document was closed. Returns the paths whose diagnostics go with it."""
        self._forget_names()
        self.open.pop(path, None)
        for workspace in self.workspaces.values():
            workspace.living.edit(path, None)
        return self._drop_unused()

    def _drop_unused(self) -> list[str]:
        used = {self.root_of(path) for path in self.open}
        gone = [self.workspaces.pop(root) for root in list(self.workspaces) if root not in used]
        return [path for workspace in gone for path in (*workspace.found, workspace.root)]

    def refresh(self) -> None:
        """Files may have changed on the disk."""
        self._has_settings = {}
        self._forget_names()
        for workspace in self.workspaces.values():
            workspace.living.refresh()

    def roots(self) -> set[str]:
        """The workspaces of the open documents that are documents of rcyaml."""
        return {self.root_of(path) for path in self.open if self.is_document(path)}

    def versions(self) -> dict[str, int | None]:
        return {path: document.version for path, document in self.open.items()}

    def root_of(self, path: str) -> str:
        disk = Disk({one.path: one.raw for one in self.open.values()})
        root = root_above(os.path.dirname(path), disk)
        if root is not None:
            return os.path.realpath(root)
        inside = [folder for folder in self.folders if path.startswith(os.path.join(folder, ""))]
        return max(inside, key=len, default=path)

    def workspace_of(self, path: str) -> OpenWorkspace:
        return self.workspace_of_root(self.root_of(path))

    def workspace_of_root(self, root: str) -> OpenWorkspace:
        if root not in self.workspaces:
            workspace = self.workspaces[root] = OpenWorkspace(root, self.include)
            for document in self.open.values():
                workspace.living.edit(document.path, document.raw)
        return self.workspaces[root]

    def is_document(self, path: str) -> bool:
        """Whether rcyaml has something to say about a file: it is a document, or the settings of a workspace."""
        overlay = {one.path: one.raw for one in self.open.values()}
        return kind_of(path, Disk(overlay)) is not None or os.path.basename(path) == WORKSPACE_FILE

    def of_document(self, path: str) -> tuple[list[Diagnostic], DocumentTexts]:
        """The diagnostics of an open document and of what it names, at once, with those that only its whole workspace
        shows, as far as their lines are the same."""
        workspace = self.workspace_of(path)
        if kind_of(path, Disk(workspace.living.unsaved)) is None:
            return workspace.found.get(path, []), workspace.texts
        analysis = workspace.living.look(path).analysis
        own = [one for one in analysis.diagnostics if one.span.file == path]
        line_of = _lines(analysis.texts, path)
        beyond = [one for one, line in workspace.beyond.get(path, []) if line_of(one) == line and one not in own]
        return [*own, *beyond], analysis.texts

    def _forget_names(self) -> None:
        for workspace in self.workspaces.values():
            workspace.names = None

    def names_around(self, path: str, *, may_be_old: bool = False) -> KnownNames:
        """The names of the workspace of a document, which are collected when they are asked for. Those before the last
        edits are good enough for what is typed in the document now."""
        workspace = self.workspace_of(path)
        if workspace.names is None and may_be_old and workspace.last_names is not None:
            return workspace.last_names
        if workspace.names is None:
            return self._collect_names(workspace, workspace.living.look(workspace.root).analysis)
        return workspace.names

    def _collect_names(self, workspace: OpenWorkspace, analysis: Analysis) -> KnownNames:
        known = KnownNames(names_of(analysis), analysis)
        workspace.names = workspace.last_names = known
        return known

    def text_of(self, path: str) -> str:
        """The text of a file that is no document; '' if it cannot be read."""
        document = self.open.get(path)
        raw = document.raw if document is not None else Disk().read(path)[0]
        return raw.decode("utf-8-sig", "replace") if raw is not None else ""

    def is_for_schema_server(self, path: str) -> bool:
        """Whether a document names its schema, or its workspace has settings for an editor with a server of schemas."""
        document = self.open.get(path)
        if document is not None and _MODELINE.search(document.text[:_HEAD]):
            return True
        root = self.root_of(path)
        if root not in self._has_settings:
            self._has_settings[root] = any(_names_schemas(os.path.join(root, name)) for name in _SETTINGS)
        return self._has_settings[root]

    def importable(self, path: str) -> list[str]:
        """The names of the documents that a document can import."""
        search = self.names_around(path, may_be_old=True).search
        return search.known(path, above(path, search.disk)[0])

    def names_everywhere(self) -> list[KnownNames]:
        return [self.names_around(path) for path in {self.root_of(path): path for path in self.open}.values()]

    def of_workspace(self, root: str, is_cancelled: Callable[[], bool] = lambda: False) -> Found:
        """All diagnostics of a workspace, also of documents that had some before. Raises Cancelled."""

        def go_on(path: str) -> None:
            if is_cancelled():
                raise Cancelled

        workspace = self.workspaces[root]
        if workspace.root in self.open:  # a document of no workspace
            found, workspace.texts = self.of_document(root)
            workspace.found, workspace.is_known = {root: found}, True
            return workspace.found
        whole = workspace.living.load(go_on)
        before, workspace.found = workspace.found, {}
        for one in whole.check():
            workspace.found.setdefault(one.span.file, []).append(one)
        workspace.texts, workspace.is_known = whole.analysis.texts, True
        if workspace.last_names is not None:  # they are asked for
            self._collect_names(workspace, whole.analysis)
        workspace.beyond = {path: self._beyond(workspace, path) for path in self.open if path in workspace.found}
        return {**{path: [] for path in (*before, *self._in(root))}, **workspace.found}

    def _in(self, root: str) -> list[str]:
        return [path for path in self.open if self.is_document(path) and self.root_of(path) == root]

    def _beyond(self, workspace: OpenWorkspace, path: str) -> list[tuple[Diagnostic, str]]:
        line_of = _lines(workspace.texts, path)
        own = set[Diagnostic]()
        with suppress(KeyError):
            own = set(workspace.living.look(path).analysis.diagnostics)
        return [(one, line_of(one)) for one in workspace.found[path] if one not in own]


def _names_schemas(path: str) -> bool:
    """Whether a file of settings names our schemas."""
    with suppress(OSError, UnicodeDecodeError), open(path, encoding="utf-8") as file:
        return ".rcyaml/schemas" in file.read(1 << 20)
    return False


def _lines(texts: DocumentTexts, path: str) -> Callable[[Diagnostic], str]:
    document = texts.get(path)
    lines = document.lines if document is not None else []

    def line_of(one: Diagnostic) -> str:
        return lines[one.span.line - 1] if one.span.line <= len(lines) else ""

    return line_of
