"""The writer: computes what plans change on the disk (`prepare`), and applies the changes (`commit`)."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterable

from msgspec.structs import replace

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.file_names import with_document
from robocomp_yaml.transactions import atomic, changes, manifest, settings
from robocomp_yaml.transactions.changes import Change, Changes, RootChanges
from robocomp_yaml.transactions.desired import DesiredRoot, by_root
from robocomp_yaml.transactions.journal import JOURNAL, JOURNAL_DONE, free_name
from robocomp_yaml.transactions.manifest import Manifest, ManifestEntry
from robocomp_yaml.transactions.output_root import PathStatus
from robocomp_yaml.transactions.plan import ANYBODY, ONCE, FilePlan, Merge, Merges, RootPlan, rights_of


def prepare(
    plans: Iterable[RootPlan], *, adopt: bool = False, others: Iterable[str] = (), merges: Merges | None = None
) -> Changes:
    """The changes that apply the plans. Only reads the disk.

    `adopt`: also overwrite files that rcyaml did not write. `others` are further roots with a manifest, in which the
    files of missing documents are deleted. `merges` are those of the user's files.
    """
    roots = by_root(plans, others)
    planned = {
        f"{desired.root.real}/{path}": (desired.root.real, file.plan.text)
        for desired in roots for path, file in desired.files.items()
    }  # fmt: skip
    rights = functools.cache(rights_of)  # most files of a component are made of the same documents
    planners = [_RootPlanner(desired, adopt, merges or Merges(), planned, rights) for desired in roots]
    prepared = tuple(planner.prepare() for planner in planners)
    return Changes(prepared, tuple(diagnostic for planner in planners for diagnostic in planner.diagnostics))


def commit(prepared: Changes) -> Changes:
    """Applies the changes of all roots that are not refused, and returns what was applied. If one change fails, none is
    applied, and all roots are refused."""
    try:
        atomic.carry_out({root.real: root.steps for root in prepared.roots if root.steps})
    except atomic.WriteFailed as failure:
        shown = next((root.root for root in prepared.roots if root.real == failure.root), failure.root)
        path = os.path.normpath(os.path.join(shown, failure.path))
        error = codes.CANNOT_WRITE.at(Span(path), path=path, reason=failure.reason, hint="this run changed nothing")
        return Changes(tuple(root.as_refused() for root in prepared.roots), (*prepared.diagnostics, error))
    return prepared


def recover(plans: Iterable[RootPlan], others: Iterable[str] = ()) -> list[Diagnostic]:
    """Rolls back or completes interrupted commits, and returns diagnostics about them. Call it before `prepare`, unless
    nothing may be changed."""
    diagnostics = []
    for root in (desired.root for desired in by_root(plans, others)):
        try:
            if atomic.recover(root.real):
                what = "its changes were rolled back"
                diagnostics.append(codes.INTERRUPTED.at(Span(root.shown(JOURNAL)), what=what))
        except atomic.WriteFailed as failure:
            shown = root.shown(failure.path)
            diagnostics.append(codes.CANNOT_WRITE.at(Span(shown), path=shown, reason=failure.reason))
        except OSError as error:
            shown = root.shown("")
            diagnostics.append(codes.CANNOT_WRITE.at(Span(shown), path=shown, reason=reason_of(error)))
    return diagnostics


class _RootPlanner:
    """Computes the changes of one root: compares each planned or known file with what is at its path.

    A root may be inside another one: a workspace's `slice/` is also that of a component in the same folder. `planned`
    are the files of all roots, each with its text and the innermost root that plans it, which writes it.
    """

    def __init__(
        self, desired: DesiredRoot, adopt: bool, merges: Merges, planned: dict[str, tuple[str, str]],
        rights_of: Callable[[tuple[str, ...]], int],
    ) -> None:  # fmt: skip
        self.desired = desired
        self.root = desired.root
        self.adopt = adopt
        self.merges = merges
        self.planned = planned
        self.rights_of = rights_of
        self.has_base = functools.cache(lambda folder: os.path.lexists(f"{self.root.real}/{manifest.BASE}/{folder}"))
        self.old = Manifest()
        self.entries: dict[str, ManifestEntry] = {}
        self.diagnostics = list(desired.diagnostics())
        self.culprits: set[str] = set()
        self.changes: list[Change] = []
        self.steps: list[atomic.FileStep] = []
        self.settled: dict[str, str] = {}
        self.once: list[str] = []
        self.users_settings: dict[str, list[FilePlan]] = {}

    def prepare(self) -> RootChanges:
        manifest_status = self.root.status(manifest.PATH)
        if not self._usable(manifest_status):
            return self._result().as_refused()
        for path in sorted({*self.desired.files, *self.old.files}):
            desired, entry = self.desired.files.get(path), self.old.files.get(path)
            if desired is None:
                self._not_planned(path, self.old.files[path])
            elif desired.plan.policy == ONCE:
                self._once(desired.plan, entry)
            else:
                self._always(desired.plan, entry)
        self._warn_settings()
        self._manifest(manifest_status)
        is_refused = has_errors(self.diagnostics) or self.root.real in self.merges.refused
        return self._result().as_refused() if is_refused else self._result()

    def _result(self) -> RootChanges:
        return RootChanges(
            self.root.path, self.root.real, tuple(self.changes), tuple(self.steps), self.settled, tuple(self.once)
        )

    def _usable(self, status: PathStatus) -> bool:
        if status.problem:
            self._refuse(manifest.PATH, status)
            return False
        try:
            self.old = manifest.read(status.data)
        except manifest.Unusable as error:
            span = Span(self.root.shown(manifest.PATH))
            is_newer = isinstance(error, manifest.Newer)
            hint = "update rcyaml" if is_newer else "restore it from version control, or delete it"
            self.diagnostics.append(codes.BAD_MANIFEST.at(span, reason=str(error), hint=hint))
            return False
        if any(os.path.lexists(f"{self.root.real}/{name}") for name in (JOURNAL, JOURNAL_DONE)):
            what = "the next `rcyaml compile` recovers the folder"
            self.diagnostics.append(codes.INTERRUPTED.at(Span(self.root.shown(JOURNAL)), what=what))
        return True

    def _once(self, plan: FilePlan, entry: ManifestEntry | None) -> None:
        merge = self.merges.files.get((self.root.real, plan.path))
        status = self.root.status(plan.path, read=entry is None or merge is not None)
        text = plan.text.encode()
        self.once.append(plan.path)
        if merge and status.data == merge.before:
            self._merge(plan, status, merge, entry)
        elif status.exists:
            self._note(plan.path, changes.KEPT)
            if entry:
                self._enter(plan.path, entry.hash, once=True)
            elif status.data == text:
                # rcyaml wrote it in a run whose manifest was not kept, such as before a fresh clone.
                self._enter(plan.path, digest(text), once=True)
                self._keep_base(plan, text)
        elif status.problem:
            self._refuse(plan.path, status)
        else:
            self._write(plan, PathStatus(), changes.CREATE, text, hash_ := digest(text))
            self._enter(plan.path, hash_, once=True)
            self._keep_base(plan, text)

    def _merge(self, plan: FilePlan, status: PathStatus, merge: Merge, entry: ManifestEntry | None) -> None:
        if merge.text == status.data:
            self._note(plan.path, changes.KEPT)
        else:
            self._write(plan, status, changes.MERGE, merge.text, digest(merge.text))
        self._enter(plan.path, digest_of_merge(entry, merge), once=True)
        self._keep_base(plan, merge.base)

    def _always(self, plan: FilePlan, entry: ManifestEntry | None) -> None:
        status = self.root.status(plan.path)
        text = plan.text.encode()
        if status.problem:
            self._refuse(plan.path, status)
            return
        hash_ = digest(text)
        if not status.exists:
            self._write(plan, status, changes.CREATE, text, hash_)
        elif status.data == text:
            rights = self.rights_of(plan.sources)
            is_open = bool(status.mode) and status.mode != atomic.limited(status.mode, rights)
            if is_open or (plan.executable and status.mode and not status.mode & 0o100):
                self._write(plan, status, changes.UPDATE, text, hash_)
            else:
                self._note(plan.path, changes.UNCHANGED)
        elif self._is_written_inside(plan) or self._is_generated(plan.path, status.data or b"", entry):
            self._write(plan, status, changes.UPDATE, text, hash_)
        elif not self.adopt and plan.stated_in and self._has_same_settings(plan, status, text):
            self._keep_same_settings(plan, text)
            return
        elif not self.adopt and plan.users:
            self._users_settings(plan, entry)
            return
        elif not plan.stated_in and entry and not entry.once:
            change = self._write(plan, status, changes.EDITED, text, hash_)
            self._warn_edited(plan.path, f"your version is kept as '{os.path.basename(change.orig)}'")
        elif self.adopt or plan.stated_in or plan.takes_over:
            self._write(plan, status, changes.ADOPT, text, hash_)
        else:
            self._note(plan.path, changes.REFUSED, status.data, text)
            adopt = typed("rcyaml", "compile", "--adopt", self._owner(plan.path))
            hint = f"`{adopt}` overwrites it, and keeps your file as .orig"
            at = Span(self.root.shown(plan.path))
            self.diagnostics.append(codes.NOT_GENERATED.at(at, path=plan.path, hint=hint))
            return
        self.settled[plan.path] = hash_
        self._enter(plan.path, hash_)
        if plan.base:
            self._keep_base(plan, plan.base.encode())
        elif entry:
            self._drop_base(plan.path)

    def _is_written_inside(self, plan: FilePlan) -> bool:
        """Whether a root inside this one writes the same file with the same text."""
        root, text = self.planned[f"{self.root.real}/{plan.path}"]
        return root != self.root.real and text == plan.text

    def _is_generated(self, path: str, data: bytes, entry: ManifestEntry | None) -> bool:
        """Whether rcyaml wrote this content, for this root or for another one."""
        return is_as_put(entry, data) or manifest.any_has(f"{self.root.real}/{path}", digest(data))

    def _has_same_settings(self, plan: FilePlan, status: PathStatus, text: bytes) -> bool:
        """Whether the user's property file has the planned properties, and rights that are not too wide."""
        data = status.data or b""
        is_open = bool(status.mode) and status.mode != atomic.limited(status.mode, self.rights_of(plan.sources))
        base = self.root.status(f"{manifest.BASE}/{plan.path}").data if plan.path in self.old.files else None
        # After a change of the document, blanks count: they are part of a text.
        exactly = base not in (None, text, plan.base.encode())
        return not is_open and settings.are_alike(plan.path, data, text, plan.beside.encode(), exactly=exactly)

    def _keep_same_settings(self, plan: FilePlan, text: bytes) -> None:
        """The user's text stays until the document changes. The planned text is the base: nothing in it is an edit."""
        self._note(plan.path, changes.KEPT)
        self._enter(plan.path, digest(text), once=True)
        self._keep_base(plan, text)

    def _users_settings(self, plan: FilePlan, entry: ManifestEntry | None) -> None:
        """A property file that the user wrote or edited stays, because programs read it."""
        self._note(plan.path, changes.KEPT)
        if entry:
            self._enter(plan.path, entry.hash, once=entry.once)
        self.users_settings.setdefault(os.path.dirname(plan.path), []).append(plan)

    def _warn_settings(self) -> None:
        """One warning for each folder with property files of the user."""
        for found in self.users_settings.values():
            plan = found[0]
            files = "; ".join(f"{one.path} ({some(one.users)})" for one in found)
            adopt = typed("rcyaml", "compile", "--adopt", self._owner(plan.path))
            documents = some([self.root.shown(one.stated_in) for one in found])
            hint = f"set them in {documents} as well; or `{adopt}` overwrites your files, and keeps them as .orig"
            self.diagnostics.append(codes.CHANGED_CONFIG.at(Span(self.root.shown(plan.path)), files=files, hint=hint))

    def _owner(self, path: str) -> str:
        """What `compile` takes to write a file."""
        return with_document(self.root.shown(self.desired.files[path].owners[0]))

    def _not_planned(self, path: str, entry: ManifestEntry) -> None:
        """A file of the manifest that is not planned: it stays as long as one of its owners exists."""
        owners = self.desired.holders(path, entry)
        if owners:
            self.entries[path] = replace(entry, owners=owners)
            return
        if f"{self.root.real}/{path}" in self.planned:
            return
        status = self.root.status(path, read=not entry.once)
        if entry.once:
            if status.exists:
                self._note(path, changes.LEFT)
            else:
                self._drop_base(path)
        elif not status.exists or status.problem:
            return
        elif self._is_generated(path, status.data or b"", entry):
            self._note(path, changes.REMOVE, status.data)
            self.steps.append(atomic.FileStep(path, status.data, None))
        else:
            orig = self._orig(path)
            self._note(path, changes.EDITED, status.data, orig=orig)
            self.steps.append(atomic.FileStep(path, status.data, None, orig=orig))
            self._warn_edited(path, f"it is no longer generated, and is kept as '{os.path.basename(orig)}'")

    def _write(self, plan: FilePlan, status: PathStatus, action: str, text: bytes, hash_: str) -> Change:
        """Writes a text with this digest."""
        orig = self._orig(plan.path) if action in (changes.EDITED, changes.ADOPT) else ""
        mode = status.mode or None
        if mode and plan.executable:
            # Whoever may read it may execute it.
            mode |= (mode & 0o444) >> 2
        if not self._is_written_inside(plan):
            before, rights = status.data if status.exists else None, self.rights_of(plan.sources)
            self.steps.append(atomic.FileStep(plan.path, before, text, plan.executable, mode, orig, rights, hash_))
        return self._note(plan.path, action, status.data, text, orig)

    def _orig(self, path: str) -> str:
        """The name, relative to the root, under which an existing file is kept."""
        return os.path.relpath(free_name(f"{self.root.real}/{path}"), self.root.real)

    def _note(
        self, path: str, action: str, before: bytes | None = None, after: bytes | None = None, orig: str = ""
    ) -> Change:
        shown = self.root.shown
        desired = self.desired.files.get(path)
        secrets = desired.plan.secrets if desired else ()
        change = Change(shown(path), action, before, after, shown(orig) if orig else "", secrets)
        self.changes.append(change)
        return change

    def _enter(self, path: str, hash_: str, *, once: bool = False) -> None:
        self.entries[path] = ManifestEntry(hash_, self.desired.holders(path, self.old.files.get(path)), once)

    def _refuse(self, path: str, status: PathStatus) -> None:
        self._note(path, changes.REFUSED)
        if status.culprit not in self.culprits:
            self.culprits.add(status.culprit)
            code = codes.OUTSIDE if status.outside else codes.CANNOT_WRITE
            if status.culprit == os.curdir and not status.outside:  # no file below the root can be written
                code, path, shown = codes.CANNOT_WRITE, os.path.normpath(self.root.path), self.root.path
            else:
                shown = self.root.shown(path)
            self.diagnostics.append(code.at(Span(shown), path=path, reason=status.problem))

    def _warn_edited(self, path: str, what: str) -> None:
        span = Span(self.root.shown(path))
        self.diagnostics.append(codes.EDITED.at(span, path=path, what=what, hint=codes.USERS_FOLDERS))

    def _keep_base(self, plan: FilePlan, text: bytes) -> None:
        """Keeps the generated text, which a later merge starts from."""
        self._write_internal(f"{manifest.BASE}/{plan.path}", text, self.rights_of(plan.sources))

    def _drop_base(self, path: str) -> None:
        if self.has_base(path.rpartition("/")[0]):
            self._write_internal(f"{manifest.BASE}/{path}", None)

    def _manifest(self, status: PathStatus) -> None:
        text = status.data
        new = Manifest(self.entries)
        if new != self.old or not new.files:
            text = new.text().encode() if new.files else None
            self._write_internal(manifest.PATH, text)
        if text is not None:
            self.settled[manifest.PATH] = digest(text)

    def _write_internal(self, path: str, text: bytes | None, rights: int = ANYBODY) -> None:
        """Writes or deletes an internal file, which is not reported."""
        status = self.root.status(path)
        if status.problem:
            self._refuse(path, status)
        elif status.data != text:
            before = status.data if status.exists else None
            self.steps.append(atomic.FileStep(path, before, text, mode=status.mode or None, rights=rights))


def is_as_put(entry: ManifestEntry | None, data: bytes) -> bool:
    """Whether this content is what rcyaml wrote last."""
    return entry is not None and entry.hash == digest(data)


def digest_of_merge(entry: ManifestEntry | None, merge: Merge) -> str:
    """The digest of a merge for the manifest: that of the merged text if the user had not edited the file, else that of
    the skeleton, from which the file differs."""
    return digest(merge.text if is_as_put(entry, merge.before) else merge.base)
