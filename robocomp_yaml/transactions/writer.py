"""The writer: looks what plans would change on the disk (`prepare`), and changes it, all or nothing (`commit`)."""

from __future__ import annotations

import os
from collections.abc import Iterable

from msgspec.structs import replace

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.source import properties
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions import atomic, changes, manifest
from robocomp_yaml.transactions.changes import Change, Changes, RootChanges
from robocomp_yaml.transactions.desired import DesiredRoot, by_root
from robocomp_yaml.transactions.journal import JOURNAL, JOURNAL_DONE, free_name
from robocomp_yaml.transactions.manifest import Manifest, ManifestEntry
from robocomp_yaml.transactions.output_root import PathStatus
from robocomp_yaml.transactions.plan import ANYBODY, ONCE, FilePlan, Merge, Merges, RootPlan, rights_of


def prepare(
    plans: Iterable[RootPlan], *, adopt: bool = False, others: Iterable[str] = (), merges: Merges | None = None
) -> Changes:
    """What it takes to carry out the plans. Only looks at the disk.

    `adopt` also takes over files that rcyaml did not write. `others` are roots with a manifest for which nothing is
    planned: what they hold for documents that are gone is removed. `merges` are those of the user's own files.
    """
    roots = by_root(plans, others)
    planned = {
        f"{wanted.root.real}/{path}": (wanted.root.real, file.plan.text)
        for wanted in roots for path, file in wanted.files.items()
    }  # fmt: skip
    looks = [_Root(wanted, adopt, merges or Merges(), planned) for wanted in roots]
    found = tuple(look.prepare() for look in looks)
    return Changes(found, tuple(diagnostic for look in looks for diagnostic in look.diagnostics))


def commit(prepared: Changes) -> Changes:
    """Makes the changes of all roots that had no refusal, and says what came of them: where one of them cannot be made,
    none is, and all are refused."""
    batches = [atomic.Batch(root.real, root.steps) for root in prepared.roots if root.steps]
    try:
        atomic.carry_out(batches)
    except atomic.WriteFailed as failure:
        shown = next((root.root for root in prepared.roots if root.real == failure.root), failure.root)
        path = os.path.normpath(os.path.join(shown, failure.path))
        said = codes.CANNOT_WRITE.at(
            Span(path), path=path, reason=failure.reason, hint="nothing was changed by this run"
        )
        return Changes(tuple(root.as_refused() for root in prepared.roots), (*prepared.diagnostics, said))
    return prepared


def recover(plans: Iterable[RootPlan], others: Iterable[str] = ()) -> list[Diagnostic]:
    """Puts in order the roots that a killed run left in the middle of a commit. To be called before `prepare`, unless
    nothing may be changed."""
    diagnostics = []
    for wanted in by_root(plans, others):
        try:
            if atomic.recover(wanted.root.real):
                diagnostics.append(
                    codes.INTERRUPTED.at(
                        Span(wanted.root.shown(JOURNAL)), what="the folder was put back as it was before"
                    )
                )
        except atomic.WriteFailed as failure:
            shown = wanted.root.shown(failure.path)
            diagnostics.append(codes.CANNOT_WRITE.at(Span(shown), path=shown, reason=failure.reason))
        except OSError as error:
            shown = wanted.root.shown("")
            diagnostics.append(codes.CANNOT_WRITE.at(Span(shown), path=shown, reason=error.strerror or str(error)))
    return diagnostics


class _Root:
    """The look at one root: each planned or known file meets what stands at its path.

    Roots may lie in each other: a workspace's `slice/` is that of a component in the same folder, too. `planned` are
    the files of all roots, each with its text and the innermost root that wants it, which writes it.
    """

    def __init__(self, wanted: DesiredRoot, adopt: bool, merges: Merges, planned: dict[str, tuple[str, str]]) -> None:
        self.wanted = wanted
        self.root = wanted.root
        self.adopt = adopt
        self.merges = merges
        self.planned = planned
        self.old = Manifest()
        self.entries: dict[str, ManifestEntry] = {}
        self.diagnostics = list(wanted.diagnostics())
        self.culprits: set[str] = set()
        self.changes: list[Change] = []
        self.steps: list[atomic.FileStep] = []
        self.settled: dict[str, bytes] = {}
        self.once: list[str] = []

    def prepare(self) -> RootChanges:
        manifest_found = self.root.look(manifest.PATH)
        if not self._usable(manifest_found):
            return self._result().as_refused()
        for path in sorted({*self.wanted.files, *self.old.files}):
            wanted, entry = self.wanted.files.get(path), self.old.files.get(path)
            if wanted is None:
                self._unwanted(path, self.old.files[path])
            elif wanted.plan.policy == ONCE:
                self._once(wanted.plan, entry)
            else:
                self._always(wanted.plan, entry)
        self._manifest(manifest_found)
        is_refused = has_errors(self.diagnostics) or self.root.real in self.merges.refused
        return self._result().as_refused() if is_refused else self._result()

    def _result(self) -> RootChanges:
        return RootChanges(
            self.root.path, self.root.real, tuple(self.changes), tuple(self.steps), self.settled, tuple(self.once)
        )

    def _usable(self, found: PathStatus) -> bool:
        if found.problem:
            self._refuse(manifest.PATH, found)
            return False
        try:
            self.old = manifest.read(found.data)
        except manifest.Unusable as unusable:
            self.diagnostics.append(
                codes.BAD_MANIFEST.at(
                    Span(self.root.shown(manifest.PATH)),
                    reason=str(unusable),
                    hint="update rcyaml"
                    if isinstance(unusable, manifest.Newer)
                    else "take it back from version control, or delete it",
                )
            )
            return False
        if any(os.path.lexists(f"{self.root.real}/{name}") for name in (JOURNAL, JOURNAL_DONE)):
            self.diagnostics.append(
                codes.INTERRUPTED.at(
                    Span(self.root.shown(JOURNAL)), what="the next `rcyaml compile` puts the folder in order"
                )
            )
        return True

    def _once(self, plan: FilePlan, entry: ManifestEntry | None) -> None:
        merge = self.merges.files.get((self.root.real, plan.path))
        found = self.root.look(plan.path, read=entry is None or merge is not None)
        text = plan.text.encode()
        self.once.append(plan.path)
        if merge and found.data == merge.before:
            self._merge(plan, found, merge, entry)
        elif found.exists:
            self._note(plan.path, changes.KEPT)
            if entry:
                self._own(plan.path, entry.hash, once=True)
            elif found.data == text:
                # Ours from a run whose manifest was not kept, such as one before a fresh clone.
                self._own(plan.path, digest(text), once=True)
                self._keep_base(plan, text)
        elif found.problem:
            self._refuse(plan.path, found)
        else:
            self._write(plan, PathStatus(), changes.CREATE)
            self._own(plan.path, digest(text), once=True)
            self._keep_base(plan, text)

    def _merge(self, plan: FilePlan, found: PathStatus, merge: Merge, entry: ManifestEntry | None) -> None:
        if merge.text == found.data:
            self._note(plan.path, changes.KEPT)
        else:
            self._write(plan, found, changes.MERGE, merge.text)
        self._own(plan.path, merged(entry, merge), once=True)
        self._keep_base(plan, merge.base)

    def _always(self, plan: FilePlan, entry: ManifestEntry | None) -> None:
        found = self.root.look(plan.path)
        text = plan.text.encode()
        if found.problem:
            self._refuse(plan.path, found)
            return
        if not found.exists:
            self._write(plan, found, changes.CREATE)
        elif found.data == text:
            rights = rights_of(plan.sources)
            is_open = bool(found.mode) and found.mode != atomic.limited(found.mode, rights)
            if is_open or (plan.executable and found.mode and not found.mode & 0o100):
                self._write(plan, found, changes.UPDATE)
            else:
                self._note(plan.path, changes.UNCHANGED)
        elif self._has_another(plan) or self._is_ours(plan.path, found.data or b"", entry):
            self._write(plan, found, changes.UPDATE)
        elif entry and not entry.once:
            change = self._write(plan, found, changes.EDITED)
            self._warn_edited(plan.path, f"it is kept as '{os.path.basename(change.orig)}'")
        elif self.adopt or self._loses_nothing(plan, found.data or b"", text):
            self._write(plan, found, changes.ADOPT)
        else:
            self._note(plan.path, changes.REFUSED, found.data, text)
            self.diagnostics.append(self._not_ours(plan, found.data or b"", text, entry))
            return
        self.settled[plan.path] = text
        self._own(plan.path, digest(text))
        if entry and entry.once:
            self._drop_base(plan.path)

    def _has_another(self, plan: FilePlan) -> bool:
        """Whether a root inside this one writes the very same file."""
        root, text = self.planned[f"{self.root.real}/{plan.path}"]
        return root != self.root.real and text == plan.text

    def _is_ours(self, path: str, data: bytes, entry: ManifestEntry | None) -> bool:
        """Whether rcyaml wrote it, for this root or for another one that has it, too."""
        return is_as_put(entry, data) or manifest.any_has(f"{self.root.real}/{path}", digest(data))

    def _loses_nothing(self, plan: FilePlan, data: bytes, text: bytes) -> bool:
        """Whether a property file that is the user's has no entry of its own that another text would not have."""
        if not plan.stated_in:
            return False
        base = self._base(plan.path)
        return lost(base, data, text) == [] and (base is not None or lost(None, text, data) == [])

    def _base(self, path: str) -> bytes | None:
        return self.root.look(f"{manifest.BASE}/{path}").data if path in self.old.files else None

    def _not_ours(self, plan: FilePlan, data: bytes, text: bytes, entry: ManifestEntry | None) -> Diagnostic:
        span = Span(self.root.shown(plan.path))
        adopt = typed("rcyaml", "compile", "--adopt", self.root.shown(self.wanted.files[plan.path].owners[0]))
        if entry is None or not plan.stated_in:
            return codes.NOT_OURS.at(span, path=plan.path, hint=f"`{adopt}` writes it, and keeps yours as .orig")
        keys = ", ".join(lost(self._base(plan.path), data, text) or ["them"])
        return codes.CHANGED.at(
            span,
            path=plan.path,
            hint=f"bring {keys} into {self.root.shown(plan.stated_in)}; `{adopt}` then rewrites "
            "the file, and keeps yours as .orig",
        )

    def _unwanted(self, path: str, entry: ManifestEntry) -> None:
        """A file of the manifest that no plan asks for: it stays as long as some document may still want it."""
        owners = self.wanted.holders(path, entry)
        if owners:
            self.entries[path] = replace(entry, owners=owners)
            return
        if f"{self.root.real}/{path}" in self.planned:
            return
        found = self.root.look(path, read=not entry.once)
        if entry.once:
            if found.exists:
                self._note(path, changes.LEFT)
            else:
                self._drop_base(path)
        elif not found.exists or found.problem:
            return
        elif self._is_ours(path, found.data or b"", entry):
            self._note(path, changes.REMOVE, found.data)
            self.steps.append(atomic.FileStep(path, found.data, None))
        else:
            orig = self._orig(path)
            self._note(path, changes.EDITED, found.data, orig=orig)
            self.steps.append(atomic.FileStep(path, found.data, None, orig=orig))
            self._warn_edited(path, f"it is no longer generated, and kept as '{os.path.basename(orig)}'")

    def _write(self, plan: FilePlan, found: PathStatus, action: str, text: bytes | None = None) -> Change:
        """Writes the plan's text, or another one."""
        text = plan.text.encode() if text is None else text
        orig = self._orig(plan.path) if action in (changes.EDITED, changes.ADOPT) else ""
        mode = found.mode or None
        if mode and plan.executable:
            # Whoever may read it may run it.
            mode |= (mode & 0o444) >> 2
        if not self._has_another(plan):
            before, rights = found.data if found.exists else None, rights_of(plan.sources)
            self.steps.append(atomic.FileStep(plan.path, before, text, plan.executable, mode, orig, rights))
        return self._note(plan.path, action, found.data, text, orig)

    def _orig(self, path: str) -> str:
        return os.path.relpath(free_name(f"{self.root.real}/{path}"), self.root.real)

    def _note(
        self, path: str, action: str, before: bytes | None = None, after: bytes | None = None, orig: str = ""
    ) -> Change:
        shown = self.root.shown
        wanted = self.wanted.files.get(path)
        secrets = wanted.plan.secrets if wanted else ()
        change = Change(shown(path), action, before, after, shown(orig) if orig else "", secrets)
        self.changes.append(change)
        return change

    def _own(self, path: str, hash_: str, *, once: bool = False) -> None:
        self.entries[path] = ManifestEntry(hash_, self.wanted.holders(path, self.old.files.get(path)), once)

    def _refuse(self, path: str, found: PathStatus) -> None:
        self._note(path, changes.REFUSED)
        if found.culprit not in self.culprits:
            self.culprits.add(found.culprit)
            code = codes.OUTSIDE if found.outside else codes.CANNOT_WRITE
            self.diagnostics.append(code.at(Span(self.root.shown(path)), path=path, reason=found.problem))

    def _warn_edited(self, path: str, what: str) -> None:
        self.diagnostics.append(
            codes.EDITED.at(Span(self.root.shown(path)), path=path, what=what, hint=codes.USERS_PLACES)
        )

    def _keep_base(self, plan: FilePlan, text: bytes) -> None:
        """The text as generated, which a later merge starts from."""
        self._remember(f"{manifest.BASE}/{plan.path}", text, rights_of(plan.sources))

    def _drop_base(self, path: str) -> None:
        self._remember(f"{manifest.BASE}/{path}", None)

    def _manifest(self, found: PathStatus) -> None:
        text = found.data
        new = Manifest(self.entries)
        if new != self.old or not new.files:
            text = new.text().encode() if new.files else None
            self._remember(manifest.PATH, text)
        if text is not None:
            self.settled[manifest.PATH] = text

    def _remember(self, path: str, text: bytes | None, rights: int = ANYBODY) -> None:
        """A file of our own, which no report mentions."""
        found = self.root.look(path)
        if found.problem:
            self._refuse(path, found)
        elif found.data != text:
            before = found.data if found.exists else None
            self.steps.append(atomic.FileStep(path, before, text, mode=found.mode or None, rights=rights))


def is_as_put(entry: ManifestEntry | None, data: bytes) -> bool:
    """Whether a file with this content is as rcyaml last put it there."""
    return entry is not None and entry.hash == digest(data)


def merged(entry: ManifestEntry | None, merge: Merge) -> str:
    """What the manifest keeps of a merge: the digest of all of it where nothing of the user was in the file before;
    else that of the skeleton, which the file then differs from."""
    return digest(merge.text if is_as_put(entry, merge.before) else merge.base)


def lost(base: bytes | None, yours: bytes, new: bytes) -> list[str] | None:
    """The keys of those entries of the user in a property file that another text lacks, or has with another value: of
    those that differ from what rcyaml wrote (`base`). None where that cannot be told. To Ice an entry without a value
    is none."""
    try:
        before, mine, then = (properties.read((data or b"").decode()).values for data in (base, yours, new))
    except UnicodeDecodeError:
        return None
    return [key for key, value in mine.items() if value not in (before.get(key, ""), then.get(key, ""))]
