"""Changing documents: a change is made in the text, checked, and written if the file did not change meanwhile.

Nothing is written before `write`. A change that leads to new errors is written only if that is wanted.
"""

from __future__ import annotations

import os
import re
import time
from collections import Counter, OrderedDict
from collections.abc import Callable, Sequence
from contextlib import suppress

import msgspec

from robocomp_yaml import languages
from robocomp_yaml.api import edited as files
from robocomp_yaml.api.editing import changes, components, created, deployments, history, layout
from robocomp_yaml.api.editing.entries import Entries
from robocomp_yaml.api.editing.history import PastChange
from robocomp_yaml.api.editing.text import EditedText
from robocomp_yaml.api.living import LivingWorkspace
from robocomp_yaml.api.new.documents import component_document
from robocomp_yaml.api.refusals import require
from robocomp_yaml.api.values import parameter_at, spells_text
from robocomp_yaml.api.workspace import Workspace
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Faulty, Refused, reason_of
from robocomp_yaml.fixing import CheckedDocuments
from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.model.deployment import INDEX
from robocomp_yaml.parameters.editing.edit import NotEditable
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.parts import PartsParser
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import parse
from robocomp_yaml.transactions.changes import unified

_KEPT = 100  # contents that others have seen
UNDO, REDO = "undo", "redo"
BOM = "\ufeff"


class EditConflict(Refused):
    """A document was changed by somebody else since it was read. `theirs` is its text now, `version` that of this text,
    `ours` the text that the change would have made of the earlier one, '' if that one is unknown."""

    def __init__(self, path: str, theirs: bytes, ours: bytes) -> None:
        super().__init__(f"{path} has changed meanwhile, and is kept as it is: look at it, and repeat the change")
        self.path, self.theirs, self.ours = path, _text(theirs), _text(ours)
        self.version = digest(theirs)


class Revision(msgspec.Struct, frozen=True):
    """A change of a document that is not written yet. `what` is the change in words. `diagnostics` are all of the
    workspace after it, `new_errors` those that the change causes."""

    path: str
    what: str
    before: bytes
    after: bytes
    diagnostics: tuple[Diagnostic, ...] = ()
    new_errors: tuple[Diagnostic, ...] = ()
    documents: int = 0
    diff: str = ""
    """A unified diff, without secrets."""
    created: tuple[tuple[str, bytes], ...] = ()
    """Other documents that are written with it, by path."""
    renamed: tuple[tuple[str, str, str], ...] = ()
    """Entries that have another name: the deployment's document, the old and the new name."""

    @property
    def version(self) -> str:
        """What the document is after the change: to be passed as `based_on` with the next one."""
        return digest(self.after)

    @property
    def based_on(self) -> str:
        """What the document was before the change."""
        return digest(self.before)

    @property
    def is_empty(self) -> bool:
        return self.before == self.after


class DocumentEditor:
    """Changes the documents of a living workspace. Not for several threads at once."""

    def __init__(self, living: LivingWorkspace) -> None:
        self.living = living
        self._seen: OrderedDict[str, bytes] = OrderedDict()
        self._parsers: dict[str, PartsParser] = {}

    def version(self, path: str) -> str:
        """The version of a document on the disk, for `based_on`. Raises Refused if it cannot be read."""
        return self._remember(_read(path))

    def revise(
        self, document: str, change: changes.DocumentChange, based_on: str = "", workspace: Workspace | None = None
    ) -> Revision:  # fmt: skip
        """A change of a deployment's or a component's document, checked with all documents of the workspace.
        `based_on` is the version that the change means, '' for whatever the file contains. Raises EditConflict if the
        file is another one, Refused if the change is not possible, and Faulty if the document cannot be parsed.
        `workspace` are the documents as they are, if they were just read."""
        workspace = workspace or self._now()
        path = self._document(workspace, document, change)
        before = self._known(path, based_on, lambda earlier: self._made(workspace, document, path, change, earlier)[0])
        new = self._created(path, change)
        after, entries = self._made(workspace, document, path, change, before, new)
        renamed = [(path, old, name) for old, name in entries.renamed] if entries is not None else []
        if entries is not None and entries.scope:
            renamed += [(document, f"{entries.scope}{old}", f"{entries.scope}{name}") for _, old, name in renamed]
        return self._checked(workspace, path, _words(change), before, after, new, tuple(renamed))

    def rewrite(self, document: str, text: str, based_on: str = "", workspace: Workspace | None = None) -> Revision:
        """A document with a text that a person typed, checked as a change is. Its byte-order mark and its kind of line
        ends stay. Raises as `revise` does."""
        workspace = workspace or self._now()
        before = self._known(document, based_on, lambda earlier: _as_before(document, earlier, text))
        return self._checked(workspace, document, "text", before, _as_before(document, before, text))

    def _known(self, path: str, based_on: str, made: Callable[[bytes], bytes]) -> bytes:
        """The content of a document. Raises EditConflict, with what is `made` of the earlier content, if it is not the
        one that is meant."""
        content = _read(path)
        if based_on and self._remember(content) != based_on:
            earlier, ours = self._seen.get(based_on), b""
            with suppress(Refused, Faulty):  # it was not possible then, either
                ours = made(earlier) if earlier is not None else b""
            raise EditConflict(path, content, ours)
        return content

    def parameter(self, document: str, entry: str, parameter: str, text: str) -> changes.SetParameter:
        """The change that sets a parameter to a value that a person types: text needs no quotes. Raises Refused."""
        workspace = self.living.look(document)
        deployment = workspace.analysis.program.deployments.get(os.path.realpath(document))
        instances = deployment.instances.values() if deployment is not None else ()
        names = ((one, {one.name, one.entry.name, re.sub(r"\d+$", INDEX, one.name)}) for one in instances)
        linked = next((one.component for one, known in names if entry in known), None)
        if linked is not None:
            _, type_ = parameter_at(parameter, linked.parameters.parameters.root)
            if spells_text(type_, text):
                return changes.SetParameter(entry, parameter, text)
        node, faults = parse(document, text)
        if node is None or faults:
            raise Refused(f"the value of {parameter} is not YAML: write it in quotes if it is a text")
        return changes.SetParameter(entry, parameter, node.data)

    def write(self, revision: Revision, *, force: bool = False) -> None:
        """Writes a revision, and remembers it for `undo`. Raises EditConflict if the file is not the one that was read,
        Faulty if the change causes errors, unless `force`, and Refused if the file cannot be written."""
        if revision.new_errors and not force:
            raise Faulty(revision.new_errors, revision.documents, {revision.path: _text(revision.after)})
        with created.written(revision.created):
            self._replace(revision.path, revision.before, revision.after)
        for renamed in revision.renamed:
            layout.rename(*renamed)
        if not revision.is_empty:
            past = history.read(revision.path)
            past.add(PastChange(
                revision.what, time.time(), revision.before, revision.after, revision.created, revision.renamed
            ))  # fmt: skip
            history.write(revision.path, past)

    def undo(self, document: str) -> Revision:
        """Undoes the last change of a document, if nobody else changed it since. Raises Refused."""
        return self._go(document, UNDO)

    def redo(self, document: str) -> Revision:
        """Makes the change again that was undone last. Raises Refused."""
        return self._go(document, REDO)

    def _go(self, document: str, way: str) -> Revision:
        past, now = history.read(document), _read(document)
        found = past.undoable(now) if way == UNDO else past.redoable(now)
        if found is None:
            is_other = (past.done if way == UNDO else past.done < len(past.past)) and past.past
            reason = "it was changed by somebody else" if is_other else "there is no such change"
            raise Refused(f"{document} has nothing to {way}: {reason}")
        before, after = (found.after, found.before) if way == UNDO else (found.before, found.after)
        workspace = self._now()
        again = found.created if way == REDO else ()
        renamed = found.renamed if way == REDO else tuple((path, new, old) for path, old, new in found.renamed)
        revision = self._checked(workspace, document, f"{way}: {found.what}", before, after, again, renamed)
        with created.written(again):
            self._replace(document, before, after)
        if way == UNDO:
            created.remove(found.created)
        for one in renamed:
            layout.rename(*one)
        past.done += -1 if way == UNDO else 1
        history.write(document, past)
        return revision

    def _now(self) -> Workspace:
        self.living.refresh()
        return self.living.look(*self.living.paths)

    def _replace(self, path: str, before: bytes, after: bytes) -> None:
        if before == after:
            return
        (written,) = files.write([path], [(path, before, after)], look_only=False)
        if written.reason:
            if (now := _read(path)) != before:
                raise EditConflict(path, now, after)
            raise Refused(f"cannot write {path}: {written.reason}")
        self._remember(after)

    def _remember(self, content: bytes) -> str:
        version = digest(content)
        self._seen[version] = content
        self._seen.move_to_end(version)
        while len(self._seen) > _KEPT:
            self._seen.popitem(last=False)
        return version

    def _document(self, workspace: Workspace, document: str, change: changes.DocumentChange) -> str:
        """The document that a change changes: that of the entry, which may be an included one, or of the component."""
        if isinstance(change, changes.ComponentChange) and change.component:
            return components.document_of(workspace.analysis.program, change.component)
        kind = kind_of(document)
        expected = "cdsl" if isinstance(change, changes.ComponentChange) else "ddsl"
        if kind != expected:
            what = "a component" if expected == "cdsl" else "a deployment"
            raise Refused(f"{document} is not the document of {what}")
        instance = _instance(workspace, document, getattr(change, "entry", ""))
        return os.path.normpath(instance.document.path if instance is not None else document)

    def _created(self, path: str, change: changes.DocumentChange) -> created.Created:
        """The documents that a change writes beside the one that it changes."""
        if not isinstance(change, changes.AddNew):
            return ()
        uses = {key: getattr(change, key) for key in components.PORT_LISTS}
        language = change.language or languages.DEFAULT
        require("language", language, languages.table())
        made = component_document(self._root(path), change.component, language, uses, self.living.include)
        return ((made.path, made.text.encode()),)

    def _made(
        self, workspace: Workspace, document: str, path: str, change: changes.DocumentChange, content: bytes,
        new: created.Created = (),
    ) -> tuple[bytes, Entries | None]:  # fmt: skip
        """The content after a change, and the entries of a deployment."""
        text, _ = decode(path, content)
        try:
            if text is None:
                raise ValueError
            edited = EditedText(path, text, self._parsers.setdefault(path, PartsParser()))
        except ValueError:
            broken = [one for one in workspace.analysis.diagnostics if one.span.file == path]
            raise Faulty(broken or workspace.analysis.diagnostics, workspace.documents_read) from None
        entries = None
        try:
            if isinstance(change, changes.ComponentChange):
                linked = workspace.analysis.program.components.get(os.path.realpath(path))
                components.make(change, edited, linked, self._root(path), self.living.include)
            else:
                entries = _entries(workspace, document, edited, getattr(change, "entry", ""))
                entries.created = [path for path, _ in new]
                deployments.make(change, entries)
        except NotEditable as error:
            where = f"{path}:{error.node.span.line}"
            raise Refused(f"{where} cannot be changed in place: {error}; edit the document itself") from None
        bom = content[:3] if content.startswith(b"\xef\xbb\xbf") else b""
        return bom + edited.text.encode(), entries

    def _root(self, path: str) -> str:
        """The folder of the workspace, or without one, the one that is analysed."""
        folder = os.path.dirname(path) or "."
        return root_above(folder) or next(filter(os.path.isdir, self.living.paths), folder)

    def _checked(
        self, workspace: Workspace, path: str, what: str, before: bytes, after: bytes, new: created.Created = (),
        renamed: tuple[tuple[str, str, str], ...] = (),
    ) -> Revision:  # fmt: skip
        """The revision with what is wrong after it: documents are checked with the text that this one would have."""
        texts = ((path, after), *new)
        for one, text in texts:
            self.living.edit(one, text)
        try:
            revised = self.living.look(*self.living.paths)
        finally:
            for one, _ in texts:
                self.living.edit(one, None)
        now = revised.analysis.diagnostics
        errors = new_errors(workspace.analysis.diagnostics, now)
        hidden = revised.analysis.hidden()
        diff = hidden.without(workspace.analysis.hidden().without(
            "".join(unified("", _text(text), "/dev/null", f"b/{one}") for one, text in new)
            + unified(_text(before), _text(after), f"a/{path}", f"b/{path}")
        ))  # fmt: skip
        return Revision(
            path, what, before, after, tuple(now), tuple(errors), revised.documents_read, diff, new, renamed
        )


def new_errors(before: Sequence[Diagnostic], after: Sequence[Diagnostic]) -> list[Diagnostic]:
    """The errors that are new, and no other form of errors that were there: such as those that name another entry."""
    were, now = CheckedDocuments(before, {}).errors, CheckedDocuments(after, {}).errors
    kinds = Counter((file, code) for file, code, _ in now.elements())
    kinds.subtract((file, code) for file, code, _ in were.elements())
    new = {key for key in now - were if kinds[key[:2]] > 0}
    return [one for one in after if not new.isdisjoint(CheckedDocuments([one], {}).errors)]


def _instance(workspace: Workspace, document: str, name: str) -> LinkedInstance | None:
    """The process of a network that a change names, if it is in another document that this one includes."""
    deployment = workspace.analysis.program.deployments.get(os.path.realpath(document))
    found = deployment.instances.get(name) if deployment is not None else None
    own = os.path.realpath(document)
    return found if found is not None and os.path.realpath(found.document.path) != own else None


def _entries(workspace: Workspace, document: str, edited: EditedText, name: str) -> Entries:
    instance = _instance(workspace, document, name)
    known: dict[str, LinkedComponent] = {}
    deployment = workspace.analysis.program.deployments.get(os.path.realpath(edited.path))
    for one in deployment.instances.values() if deployment is not None else ():
        if one.component is not None and not one.scope:
            known[_key(edited, one)] = one.component
    return Entries(edited, instance.scope if instance is not None else "", known)


def _key(edited: EditedText, instance: LinkedInstance) -> str:
    """The key of an instance's entry, which contains `{i}` if there are several."""
    name = instance.entry.name
    number = "" if instance.number is None else str(instance.number)
    entries = edited.data("components") or {}
    return next((key for key in entries if INDEX in key and key.replace(INDEX, number) == name), name)


def _words(change: changes.DocumentChange) -> str:
    """A change in words: `connect speech Mouth mouth`."""
    values = [getattr(change, field) for field in change.__struct_fields__]
    if isinstance(change, changes.ComponentChange):
        values = list(change.interfaces)
    if isinstance(change, changes.AddHost):
        values = [change.name, change.address, change.user]
    if isinstance(change, changes.SetParameter):  # its value may be a secret
        values = [change.entry, change.parameter]
    return " ".join(filter(None, (changes.name_of(change), *map(_shown, values))))


def _shown(value: object) -> str:
    return " ".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _read(path: str) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise Refused(f"cannot read {path}: {reason_of(error)}") from None


def _as_before(path: str, before: bytes, text: str) -> bytes:
    """The content of a document with a new text. Raises Refused if a text cannot replace the content."""
    try:
        was = before.decode("utf-8")
        return f"{BOM if was.startswith(BOM) else ''}{_with_line_ends(was, text.removeprefix(BOM))}".encode()
    except UnicodeDecodeError:
        raise Refused(f"{path} is not UTF-8 text: edit it where its encoding is known") from None
    except UnicodeEncodeError:
        raise Refused("the text contains half a character (a surrogate)") from None


def _with_line_ends(was: str, text: str) -> str:
    """A text with the line ends that it had: a browser only knows line feeds."""
    is_dos = "\r\n" in was and "\n" not in was.replace("\r\n", "")
    return text.replace("\r\n", "\n").replace("\n", "\r\n") if is_dos else text


def _text(content: bytes) -> str:
    return content.decode("utf-8", "surrogateescape")
