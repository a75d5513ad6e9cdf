"""Which fixes are applied: in rounds, with a check after each, until there is nothing left to fix.

A fix has to prove itself: its diagnostic is gone, no document is understood less than before, and in the end there are
no more errors than before. A fix that fails is left, with the reason. A document that is understood better than before
may reveal more errors. A safe fix is not blamed for them, nor is a guess after which the whole document is understood.
Any other guess, and a safe fix that reveals more errors without that, is kept only if these errors are fixed, too. Of
two fixes that undo each other, none is applied.

This module does not use the disk: documents are checked with the contents that they would have.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.source.spelled import DocumentText

MAX_CHECKS = 300  # checks of all documents

Key = tuple[str, str, object]
UNREADABLE, MISSHAPEN, UNDERSTOOD = 0, 1, 2


class CheckedDocuments(msgspec.Struct):
    """The result of a check. `contents` are the bytes of each document by its path; `levels` says how far each was
    understood: UNREADABLE, MISSHAPEN or UNDERSTOOD."""

    diagnostics: Sequence[Diagnostic]
    contents: Mapping[str, bytes]
    levels: Mapping[str, int] = {}

    @property
    def errors(self) -> Counter[Key]:
        return Counter(_key(diagnostic) for diagnostic in self.diagnostics if diagnostic.severity == ERROR)


Batch = list[tuple[Diagnostic, Fix]]
CheckWith = Callable[[Mapping[str, bytes]], CheckedDocuments]


class AttemptedFix(msgspec.Struct, frozen=True):
    """A fix that was applied, with its diagnostic; or one that was not, with the reason."""

    diagnostic: Diagnostic
    fix: Fix
    reason: str = ""


class FixResult(msgspec.Struct):
    """`changed` are contents by the paths of documents; `look` is the last check."""

    look: CheckedDocuments
    changed: dict[str, bytes] = {}
    fixed: list[AttemptedFix] = []
    left: list[AttemptedFix] = []


def apply_fixes(look: CheckWith, may_change: Collection[str], *, unsafe: bool) -> FixResult:
    """Applies fixes to the documents that may change, with `unsafe` also guesses. `look` checks the documents with some
    contents replaced."""
    rounds = _FixRounds(look, may_change, unsafe)
    while rounds.one():
        pass
    return rounds.result


class _UncertainFix(msgspec.Struct, frozen=True):
    """A guess after which there are more errors, with the state before it."""

    diagnostic: Diagnostic
    fix: Fix
    look: CheckedDocuments
    changed: dict[str, bytes]
    fixed: int


class _Step(msgspec.Struct, frozen=True):
    """A state of the documents, and the fixes that were applied to it."""

    look: CheckedDocuments
    changed: dict[str, bytes]
    fixed: int
    batch: Batch


class _FixRounds:
    def __init__(self, look: CheckWith, may_change: Collection[str], unsafe: bool) -> None:
        self.look, self.may_change, self.unsafe = look, may_change, unsafe
        self.result = FixResult(look({}))
        self.checks = 1
        self.batch_size = 1 << 20  # fixes that are tried at once: fewer if they do not go together
        self.rejected: set[tuple[Key, Fix]] = set()
        self.uncertain: list[_UncertainFix] = []
        self.first = self.result.look.contents
        self.steps: dict[frozenset[tuple[str, bytes]], _Step] = {}  # by the changed contents

    def one(self) -> bool:
        """Runs one round. Returns False if nothing is left to try."""
        now, changed = self.result.look, self.result.changed
        batch = list(_batch(self._candidates(), self.batch_size))
        if not batch or self.checks >= MAX_CHECKS:
            for diagnostic, fix in batch:
                self._reject(diagnostic, fix, "it was not tried: there are too many fixes; run the command again")
            return self._undo_guess()
        changed_next = changed | _applied([fix for _, fix in batch], now.contents)
        after = self.look(changed_next)
        self.checks += 1
        reason, is_uncertain = _verdict(now, after, batch)
        if not reason and (former := self.steps.get(self._state(changed_next))) is not None:
            if len(batch) == 1:
                self._go_back(former)
                return True
            reason = "they would undo other fixes"
        if reason and len(batch) > 1:
            self.batch_size = len(batch) // 2
        elif reason:
            self._reject(*batch[0], reason)
            self.batch_size = 8
        else:
            if is_uncertain:
                self.uncertain.append(_UncertainFix(*batch[0], now, changed, len(self.result.fixed)))
            self.steps[self._state(changed)] = _Step(now, changed, len(self.result.fixed), batch)
            self.result.look, self.result.changed = after, changed_next
            self.result.fixed += [AttemptedFix(diagnostic, fix) for diagnostic, fix in batch]
            self.batch_size = max(self.batch_size, 2) * 2
        return True

    def _state(self, changed: Mapping[str, bytes]) -> frozenset[tuple[str, bytes]]:
        return frozenset((path, content) for path, content in changed.items() if self.first.get(path) != content)

    def _go_back(self, former: _Step) -> None:
        """Goes back to a state that a fix would lead to again: two fixes undo each other. None of them is applied."""
        self.result.look, self.result.changed = former.look, former.changed
        del self.result.fixed[former.fixed :]
        self.batch_size = 1
        if len(former.batch) == 1:
            self._reject(*former.batch[0], "there would be another error, whose fix undoes this one")

    def _reject(self, diagnostic: Diagnostic, fix: Fix, reason: str) -> None:
        self.rejected.add((_key(diagnostic), fix))
        self.result.left.append(AttemptedFix(diagnostic, fix, reason))

    def _undo_guess(self) -> bool:
        """Undoes the last guess that left more errors. Returns whether there was one."""
        while self.uncertain:
            last = self.uncertain.pop()
            if reason := _more_errors(last.look, self.result.look):
                self.result.look, self.result.changed = last.look, last.changed
                del self.result.fixed[last.fixed :]
                self._reject(last.diagnostic, last.fix, reason)
                return True
        return False

    def _candidates(self) -> Iterator[tuple[Diagnostic, Fix]]:
        """The best fix of each diagnostic, safe fixes first."""
        found = [
            (diagnostic, fix)
            for diagnostic in self.result.look.diagnostics
            for fix in sorted(diagnostic.fixes, key=lambda fix: not fix.safe)
            if (fix.safe or self.unsafe) and fix.is_spelled and (_key(diagnostic), fix) not in self.rejected
            and all(edit.span.file in self.may_change for edit in fix.edits)
        ]  # fmt: skip
        best = {(one.span, one.code, one.facts): (one, fix) for one, fix in reversed(found)}
        yield from sorted(best.values(), key=lambda one: (not one[1].safe, *one[0].sort_key))


def _batch(candidates: Iterator[tuple[Diagnostic, Fix]], most: int) -> Iterator[tuple[Diagnostic, Fix]]:
    """A batch of fixes that do not overlap: all safe, or all guesses."""
    used: dict[str, list[tuple[tuple[int, int], tuple[int, int]]]] = {}
    count, safe = 0, None
    for diagnostic, fix in candidates:
        places = [
            (edit.span.file, (edit.span.line, edit.span.column), (edit.span.end_line, edit.span.end_column))
            for edit in fix.edits
        ]
        is_free = all(
            end < start_ or start > end_ for file, start, end in places for start_, end_ in used.get(file, ())
        )
        if count < most and is_free and safe in (None, fix.safe):
            count, safe = count + 1, fix.safe
            for file, start, end in places:
                used.setdefault(file, []).append((start, end))
            yield diagnostic, fix


def _applied(fixes: list[Fix], contents: Mapping[str, bytes]) -> dict[str, bytes]:
    """The contents of the changed files. A byte order mark is kept."""
    made = {}
    by_file: dict[str, list[tuple[int, int, str]]] = {}
    texts: dict[str, DocumentText] = {}
    for fix in fixes:
        for edit in fix.edits:
            file, span = edit.span.file, edit.span
            if file not in texts:
                texts[file] = DocumentText(file, contents[file].decode("utf-8-sig"))
            start = texts[file].index(span.line, span.column)
            by_file.setdefault(file, []).append((start, texts[file].index(span.end_line, span.end_column), edit.text))
    for file, places in by_file.items():
        text = texts[file].text
        for start, end, new in sorted(set(places), reverse=True):
            text = text[:start] + new + text[end:]
        bom = contents[file][:3] if contents[file].startswith(b"\xef\xbb\xbf") else b""
        made[file] = bom + text.encode()
    return made


def _key(diagnostic: Diagnostic) -> Key:
    """The identity of a diagnostic, without its location, which other fixes move, and without its suggestion, which
    depends on the rest of the document."""
    return (diagnostic.span.file, diagnostic.code, tuple(fact for fact in diagnostic.facts if fact[0] != "meant"))


def _verdict(before: CheckedDocuments, after: CheckedDocuments, batch: Batch) -> tuple[str, bool]:
    """The reason not to apply these fixes, or ''; and whether a fix is uncertain: its new errors may still be fixed."""
    files = {edit.span.file for _, fix in batch for edit in fix.edits}
    steps = [after.levels.get(file, UNDERSTOOD) - before.levels.get(file, UNDERSTOOD) for file in files]
    if any(step < 0 for step in steps):
        return "the document could not be parsed any more", False
    were, are = Counter(map(_key, before.diagnostics)), Counter(map(_key, after.diagnostics))
    expected = Counter(_key(diagnostic) for diagnostic, _ in batch if not _is_next_of_kind(before, after, diagnostic))
    if any(are[key] > were[key] - count for key, count in expected.items()):
        return "it would not fix this diagnostic", False
    if len(batch) > 1:
        seen = {file for file, step in zip(files, steps, strict=True) if step > 0 and batch[0][1].safe}
        worse = [key for key in after.errors - before.errors if key[0] not in seen]
        return "they do not go together" if worse else "", False
    (_, fix), reason = batch[0], _more_errors(before, after)
    is_blind = any(before.levels.get(file) == UNREADABLE for file in files)  # the parser stopped at the first error
    if not reason or not any(steps):
        return ("", True) if reason and fix.safe else (reason, False)
    is_understood = all(after.levels.get(file, UNDERSTOOD) == UNDERSTOOD for file in files)
    return "", not (fix.safe or is_blind or is_understood)


def _is_next_of_kind(before: CheckedDocuments, after: CheckedDocuments, diagnostic: Diagnostic) -> bool:
    """Whether a text that is no YAML has the same error again further down. The parser reports only the first one."""
    places = [one.span for one in after.diagnostics if _key(one) == _key(diagnostic)]
    return before.levels.get(diagnostic.span.file) == UNREADABLE and bool(places) and min(places) > diagnostic.span


def _more_errors(before: CheckedDocuments, after: CheckedDocuments) -> str:
    count, now = before.errors.total(), after.errors.total()
    return f"there would be {now} errors instead of {count}" if now > count else ""
