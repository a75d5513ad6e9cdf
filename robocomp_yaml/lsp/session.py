"""The documents of an editor, and their diagnostics, apart from the protocol.

Documents belong to workspaces: the folder of the next `rcyaml.yaml` above, or the folder that the editor has opened. A
document outside of any is a workspace of its own. Each workspace has a living analysis, which sees the texts of all
open documents. The diagnostics of one document are those of the document and all that it names; whether others
contradict it, only the diagnostics of the workspace say. In a document for which this takes long, such as a deployment
of a thousand processes, a key shows what is wrong with the document by itself; the rest follows when typing rests.
"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress

import msgspec

from robocomp_yaml.api.living import LivingWorkspace
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.grouping import grouped
from robocomp_yaml.link.program import Program
from robocomp_yaml.link.workspace import ImportSearch, above, root_above
from robocomp_yaml.lsp.moved import moved
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import Names
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import WORKSPACE_FILE, is_script, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentTexts
from robocomp_yaml.source.text import encoded

_MODELINE = re.compile(r"^#\s*yaml-language-server\s*:.*\$schema", re.MULTILINE)
_HEAD = 10_000  # characters that editors search
_SETTINGS = (".vscode/settings.json", ".yamlls.json", ".helix/languages.toml")
LONG = 0.06  # seconds of CPU that a key may take
MACHINE = ".scxml"
FEW = 1000  # documents whose names are collected before anybody asks for them
MANY = 500  # lines of a deployment that probably takes longer
_ALONE = ("RC01", "RC02")  # codes of syntax and shape
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
        return encoded(self.text)

    @property
    def is_saved(self) -> bool:
        try:
            with open(self.path, "rb") as file:
                return file.read() == self.raw
        except OSError:
            return False


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


class Look(msgspec.Struct, frozen=True):
    """The diagnostics in a document of the last look at it and what it names, with the texts that they refer to.
    `is_long`: such a look takes too long for a key."""

    is_long: bool
    found: Sequence[Diagnostic]
    texts: DocumentTexts


class OpenWorkspace:
    """A workspace with open documents. `root` is its folder, or the document itself if it belongs to none. `found` are
    its last diagnostics, and `texts` the texts that they refer to. `beyond` are those of open documents that only the
    whole workspace shows, with the lines that they are about. `whole` is the last analysis of all documents."""

    def __init__(self, root: str, include: Iterable[str]) -> None:
        self.root, self.living = root, LivingWorkspace((root,), include)
        self.is_known = False  # whether it was analysed as a whole
        self.is_idle = False  # whether none of its documents is open
        self.found: Found = {}
        self.whole: Analysis | None = None
        self.names: KnownNames | None = None
        self.last_names: KnownNames | None = None  # of the texts before the last edits
        self.texts = DocumentTexts({}, {})
        self.beyond: dict[str, list[tuple[Diagnostic, str]]] = {}
        self.looks: dict[str, Look] = {}


class Session:
    """`folders` are those that the editor has opened. Paths are real paths."""

    def __init__(self, folders: Iterable[str] = (), include: Iterable[str] = ()) -> None:
        self.folders = [os.path.realpath(folder) for folder in folders]
        self.include = tuple(include)
        self.open: dict[str, EditedText] = {}
        self.code: dict[str, EditedText] = {}  # the user's code, and Slice
        self.workspaces: dict[str, OpenWorkspace] = {}
        self._has_settings: dict[str, bool] = {}
        self._disk: Disk | None = None

    @property
    def disk(self) -> Disk:
        """The files of the disk, and the open documents."""
        if self._disk is None:
            self._disk = Disk({one.path: one.raw for one in self.open.values()})
        return self._disk

    def edit(self, document: EditedText) -> None:
        """A document was opened or changed."""
        self._forget_names()
        self.open[document.path], self._disk = document, None
        for workspace in self.workspaces.values():
            workspace.living.edit(document.path, document.raw)

    def edit_code(self, code: EditedText) -> None:
        """A file of the user's code was opened or changed. No document depends on it."""
        self.code[code.path] = code
        for workspace in self.workspaces.values():
            workspace.living.edit(code.path, code.raw)

    def close_code(self, path: str) -> list[str]:
        """A file of the user's code was closed. Returns the same as `close`."""
        root = root_above(os.path.dirname(path), self.disk)
        self.code.pop(path, None)
        for workspace in self.workspaces.values():
            workspace.living.edit(path, None)
        return self._drop_unused(os.path.realpath(root) if root is not None else "")

    def close(self, path: str) -> list[str]:
        """A document was closed. Returns the paths whose diagnostics go with it. The workspace of the last document is
        kept, because most people open another one of it next."""
        self._forget_names()
        root = self.root_of(path)
        self.open.pop(path, None)
        self._disk = None
        for workspace in self.workspaces.values():
            workspace.looks.pop(path, None)
            workspace.living.edit(path, None)
        return self._drop_unused(root if root != path else "")

    def _drop_unused(self, last: str) -> list[str]:
        used = {self.root_of(path) for path in self.open} | self._roots_of_code()
        gone: list[str] = []
        for root in self.workspaces.keys() - used:
            workspace = self.workspaces[root]
            gone += (*workspace.found, root)
            workspace.found, workspace.beyond, workspace.is_idle = {}, {}, True
            if root != last:
                del self.workspaces[root]
        return gone

    def refresh(self) -> None:
        """Files may have changed on the disk."""
        self._has_settings, self._disk = {}, None
        self._forget_names()
        for workspace in self.workspaces.values():
            workspace.living.refresh()

    def roots(self) -> set[str]:
        """The workspaces of the open documents that are documents of rcyaml, and of open code."""
        return {self.root_of(path) for path in self.open if self.is_checked(path)} | self._roots_of_code()

    def _roots_of_code(self) -> set[str]:
        """The declared workspaces of open code: other folders with code need not have anything to do with rcyaml."""
        roots = (root_above(os.path.dirname(path), self.disk) for path in self.code)
        return {os.path.realpath(root) for root in roots if root is not None}

    def versions(self) -> dict[str, int | None]:
        return {path: document.version for path, document in (*self.open.items(), *self.code.items())}

    def root_of(self, path: str) -> str:
        root = root_above(os.path.dirname(path), self.disk)
        if root is not None:
            return os.path.realpath(root)
        inside = [folder for folder in self.folders if path.startswith(os.path.join(folder, ""))]
        return max(inside, key=len, default=path)

    def workspace_of(self, path: str) -> OpenWorkspace:
        return self.workspace_of_root(self.root_of(path))

    def workspace_of_root(self, root: str) -> OpenWorkspace:
        if root not in self.workspaces:
            workspace = self.workspaces[root] = OpenWorkspace(root, self.include)
            for document in (*self.open.values(), *self.code.values()):
                workspace.living.edit(document.path, document.raw)
        workspace = self.workspaces[root]
        if workspace.is_idle:
            workspace.is_idle = False
            workspace.living.refresh()  # nobody told of changes on the disk
        return workspace

    def is_document(self, path: str) -> bool:
        """Whether a file is a document, a mock script, or the settings of a workspace."""
        is_other = os.path.basename(path) == WORKSPACE_FILE or is_script(path)
        return is_other or kind_of(path, self.disk) is not None

    def is_checked(self, path: str) -> bool:
        """Whether rcyaml has something to say about a file: it is a document, or a state machine."""
        return path.endswith(MACHINE) or self.is_document(path)

    def of_document(self, path: str, *, at_rest: bool = False) -> tuple[list[Diagnostic], DocumentTexts]:
        """The diagnostics of an open document and of what it names, at once, with those that only its whole workspace
        shows, as far as their lines are the same. If this took long the last time, those of the document by itself,
        unless nothing is typed."""
        workspace = self.workspace_of(path)
        if kind_of(path, self.disk) is None:
            return _as_now(workspace, self.open[path])
        known = workspace.looks.get(path) or self._first(workspace, path)
        if known is not None and known.is_long and not at_rest:
            return self._at_a_glance(workspace, path, known)
        analysis = self._look(workspace, path)
        own = [one for one in analysis.diagnostics if one.span.file == path]
        line_of = _lines(analysis.texts, path)
        beyond = [one for one, line in workspace.beyond.get(path, []) if line_of(one) == line and one not in own]
        return [*own, *beyond], analysis.texts

    def _first(self, workspace: OpenWorkspace, path: str) -> Look | None:
        """What is known of a document before the first look at it, if that probably takes long."""
        if kind_of(path) != "ddsl" or self.open[path].text.count("\n") < MANY:
            return None
        return Look(True, workspace.found.get(path, ()), workspace.texts)

    def _look(self, workspace: OpenWorkspace, path: str) -> Analysis:
        began = time.thread_time()
        analysis = workspace.living.look(path).analysis
        took = time.thread_time() - began
        own = [one for one in analysis.diagnostics if one.span.file == path]
        workspace.looks[path] = Look(took > LONG, own, analysis.texts)
        return analysis

    def _at_a_glance(self, workspace: OpenWorkspace, path: str, known: Look) -> tuple[list[Diagnostic], DocumentTexts]:
        """The diagnostics of a document by itself; all others are those of the last look, where the lines are the
        same."""
        texts = DocumentTexts({path: self.open[path].raw}, {})
        before, after = known.texts.get(path), texts.get(path)
        own = workspace.living.glance(path)
        if before is None or after is None:
            return own, texts
        beyond = (one for one, line in workspace.beyond.get(path, ()) if _lines(known.texts, path)(one) == line)
        kept = dict.fromkeys(moved((*known.found, *beyond), path, before.lines, after.lines))
        workspace.looks[path] = Look(True, list(kept), texts)
        return [*own, *(one for one in kept if not one.code.startswith(_ALONE))], texts

    def _forget_names(self) -> None:
        for workspace in self.workspaces.values():
            workspace.names = None

    def names_around(self, path: str, *, may_be_old: bool = False) -> KnownNames:
        """The names of the workspace of a document, which are collected when they are asked for. Those before the last
        edits are good enough for what is typed in the document now."""
        workspace = self.workspace_of(path)
        if workspace.names is None and may_be_old:
            if workspace.last_names is None and workspace.whole is not None:
                workspace.last_names = KnownNames(names_of(workspace.whole), workspace.whole)
            if workspace.last_names is not None:
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
        document = self.open.get(path) or self.code.get(path)
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

    def of_code(self, path: str) -> tuple[list[Diagnostic], DocumentTexts]:
        """The diagnostics of open code, which is checked with its workspace."""
        workspace, code = self.workspaces.get(self.root_of(path)), self.code.get(path)
        if workspace is None or code is None:
            return [], DocumentTexts({}, {})
        return _as_now(workspace, code)

    def names_everywhere(self) -> list[KnownNames]:
        """Those of all workspaces that are open: as a folder, or with a document."""
        marks = filter(os.path.isfile, (os.path.join(folder, WORKSPACE_FILE) for folder in self.folders))
        return [
            self.names_around(path) for path in {self.root_of(path): path for path in (*marks, *self.open)}.values()
        ]

    def of_workspace(self, root: str, is_cancelled: Callable[[], bool] = lambda: False) -> Found:
        """All diagnostics of a workspace, also of documents that had some before. Raises Cancelled."""

        def go_on(path: str) -> None:
            if is_cancelled():
                raise Cancelled

        workspace = self.workspaces[root]
        if workspace.root in self.open:  # a document of no workspace
            found, workspace.texts = self.of_document(root, at_rest=True)
            workspace.found, workspace.is_known = {root: found}, True
            return workspace.found
        whole = workspace.living.load(go_on, lambda: go_on(root))
        before, workspace.found = workspace.found, grouped((one.span.file, one) for one in whole.check())
        workspace.texts, workspace.is_known, workspace.whole = whole.analysis.texts, True, whole.analysis
        if workspace.last_names is not None or len(whole.analysis.documents) <= FEW:  # they are, or will be, asked for
            self._collect_names(workspace, whole.analysis)
        workspace.beyond = {path: self._beyond(workspace, path) for path in self._in(root)}
        return {**{path: [] for path in (*before, *self._in(root))}, **workspace.found}

    def _in(self, root: str) -> list[str]:
        return [path for path in self.open if self.is_checked(path) and self.root_of(path) == root]

    def _beyond(self, workspace: OpenWorkspace, path: str) -> list[tuple[Diagnostic, str]]:
        known = workspace.looks.get(path) or self._first(workspace, path)
        if known is not None and known.is_long:  # until the whole is analysed again, what it says is kept
            workspace.looks[path] = Look(True, workspace.found.get(path, ()), workspace.texts)
            return []
        if path not in workspace.found:
            return []
        line_of = _lines(workspace.texts, path)
        own = set[Diagnostic]()
        with suppress(KeyError):
            own = set(self._look(workspace, path).diagnostics)
        return [(one, line_of(one)) for one in workspace.found[path] if one not in own]


def _as_now(workspace: OpenWorkspace, edited: EditedText) -> tuple[list[Diagnostic], DocumentTexts]:
    """The diagnostics of a file that is checked only with its workspace, where its lines are the same."""
    texts, found = DocumentTexts({edited.path: edited.raw}, {}), workspace.found.get(edited.path, [])
    before, after = workspace.texts.get(edited.path), texts.get(edited.path)
    if before is None or after is None or before.text == after.text:
        return found, workspace.texts
    return list(moved(found, edited.path, before.lines, after.lines)), texts


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
