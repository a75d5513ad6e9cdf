"""Which fixes are applied: some at a time, looking again after each round, until there is nothing left to fix.

A fix has to prove itself: what it mends is gone, no document can be read less than before, and in the end there are no
more errors. What does not is left, with the reason. A document that can be understood further than before may show what
could not be seen: a safe fix is not blamed for that, nor is a guess by which the whole document is understood; another
guess stays if this is mended in turn.

Nothing here touches the disk; documents are looked at as they would be.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.diag.fix import Fix
from robocomp_yaml.source.spelled import DocumentText

MOST_LOOKS = 300  # at all documents; each takes as long as a check

Key = tuple[str, str, object]
UNREADABLE, MISSHAPEN, UNDERSTOOD = 0, 1, 2


class Look(msgspec.Struct):
    """What a check finds: `contents` are the bytes of each document by its path, `levels` say how far each could be
    understood: UNREADABLE, MISSHAPEN or UNDERSTOOD."""

    diagnostics: Sequence[Diagnostic]
    contents: Mapping[str, bytes]
    levels: Mapping[str, int] = {}

    @property
    def errors(self) -> Counter[Key]:
        return Counter(_key(told) for told in self.diagnostics if told.severity == ERROR)


class Done(msgspec.Struct, frozen=True):
    """A fix that was applied, with the diagnostic as it was before; or one that was not, and why."""

    diagnostic: Diagnostic
    fix: Fix
    reason: str = ""


class Mended(msgspec.Struct):
    """`changed` are contents by the documents' paths; `look` is what is found then."""

    look: Look
    changed: dict[str, bytes] = {}
    fixed: list[Done] = []
    left: list[Done] = []


def mend(look: Callable[[Mapping[str, bytes]], Look], may_change: Collection[str], *, unsafe: bool) -> Mended:
    """Applies what can be applied to the documents that may change. `look` looks at the documents with some contents
    instead of the disk's."""
    rounds = _Rounds(look, may_change, unsafe)
    while rounds.one():
        pass
    return rounds.mended


class _Doubted(msgspec.Struct, frozen=True):
    """A guess after which more errors are seen, with all as it was before."""

    told: Diagnostic
    fix: Fix
    look: Look
    changed: dict[str, bytes]
    fixed: int


class _Rounds:
    def __init__(
        self, look: Callable[[Mapping[str, bytes]], Look], may_change: Collection[str], unsafe: bool
    ) -> None:  # fmt: skip
        self.look, self.may_change, self.unsafe = look, may_change, unsafe
        self.mended = Mended(look({}))
        self.looks = 1
        self.most = 1 << 20  # so many are tried at once; fewer where they do not go together
        self.refused: set[tuple[Key, Fix]] = set()
        self.doubted: list[_Doubted] = []

    def one(self) -> bool:
        """Whether there was something to try."""
        now, changed = self.mended.look, self.mended.changed
        batch = list(_apart(self._wanted(), self.most))
        if not batch or self.looks >= MOST_LOOKS:
            for told, fix in batch:
                self._leave(told, fix, "it was not tried: there is too much to fix at once")
            return self._took_back()
        after = self.look(changed | _applied([fix for _, fix in batch], now.contents))
        self.looks += 1
        verdict = _verdict(now, after, batch)
        if verdict.reason and len(batch) > 1:
            self.most = len(batch) // 2
        elif verdict.reason:
            self._leave(*batch[0], verdict.reason)
            self.most = 8
        else:
            if verdict.is_doubtful:
                self.doubted.append(_Doubted(*batch[0], now, changed, len(self.mended.fixed)))
            self.mended.look = after
            self.mended.changed = changed | _applied([fix for _, fix in batch], now.contents)
            self.mended.fixed += [Done(told, fix) for told, fix in batch]
            self.most = max(self.most, 2) * 2
        return True

    def _leave(self, told: Diagnostic, fix: Fix, reason: str) -> None:
        self.refused.add((_key(told), fix))
        self.mended.left.append(Done(told, fix, reason))

    def _took_back(self) -> bool:
        """Whether a guess was taken back, since there are more errors in the end: the rest is tried again without."""
        while self.doubted:
            last = self.doubted.pop()
            if reason := _more(last.look, self.mended.look):
                self.mended.look, self.mended.changed = last.look, last.changed
                del self.mended.fixed[last.fixed :]
                self._leave(last.told, last.fix, reason)
                return True
        return False

    def _wanted(self) -> Iterator[tuple[Diagnostic, Fix]]:
        """The fix of each diagnostic that has one, the safe ones first: what they mend need not be guessed."""
        found = [
            (told, fix)
            for told in self.mended.look.diagnostics
            for fix in sorted(told.fixes, key=lambda fix: not fix.safe)
            if (fix.safe or self.unsafe) and fix.is_spelled and (_key(told), fix) not in self.refused
            and all(edit.span.file in self.may_change for edit in fix.edits)
        ]  # fmt: skip
        yield from sorted({_place(told): (told, fix) for told, fix in reversed(found)}.values(), key=_rank)


def _place(told: Diagnostic) -> tuple[object, ...]:
    return (told.span, told.code, told.facts)


def _rank(wanted: tuple[Diagnostic, Fix]) -> tuple[object, ...]:
    return (not wanted[1].safe, *wanted[0].sort_key)


def _apart(wanted: Iterator[tuple[Diagnostic, Fix]], most: int) -> Iterator[tuple[Diagnostic, Fix]]:
    """Those of which no two touch the same place; all safe, or none."""
    taken: dict[str, list[tuple[tuple[int, int], tuple[int, int]]]] = {}
    count, safe = 0, None
    for told, fix in wanted:
        places = [
            (edit.span.file, (edit.span.line, edit.span.column), (edit.span.end_line, edit.span.end_column))
            for edit in fix.edits
        ]
        is_free = all(
            end < start_ or start > end_ for file, start, end in places for start_, end_ in taken.get(file, ())
        )
        if count < most and is_free and safe in (None, fix.safe):
            count, safe = count + 1, fix.safe
            for file, start, end in places:
                taken.setdefault(file, []).append((start, end))
            yield told, fix


def _applied(fixes: list[Fix], contents: Mapping[str, bytes]) -> dict[str, bytes]:
    """The contents of the files that fixes change, with a mark of byte order where they had one."""
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


def _key(told: Diagnostic) -> Key:
    """A diagnostic wherever it stands, since other fixes move it, and whatever it proposes: that depends on how much
    there is to say."""
    return (told.span.file, told.code, tuple(fact for fact in told.facts if fact[0] != "meant"))


class _Verdict(msgspec.Struct, frozen=True):
    """Why fixes are not to be applied, or ''; one may be doubtful until it is seen whether its errors can be mended."""

    reason: str = ""
    is_doubtful: bool = False


def _verdict(before: Look, after: Look, batch: list[tuple[Diagnostic, Fix]]) -> _Verdict:
    files = {edit.span.file for _, fix in batch for edit in fix.edits}
    steps = [after.levels.get(file, UNDERSTOOD) - before.levels.get(file, UNDERSTOOD) for file in files]
    if any(step < 0 for step in steps):
        return _Verdict("the document could not be understood any more")
    were, are = Counter(map(_key, before.diagnostics)), Counter(map(_key, after.diagnostics))
    wanted = Counter(_key(told) for told, _ in batch if not _is_later(before, after, told))
    if any(are[key] > were[key] - count for key, count in wanted.items()):
        return _Verdict("it would not mend this")
    if len(batch) > 1:
        seen = {file for file, step in zip(files, steps, strict=True) if step > 0 and batch[0][1].safe}
        worse = [key for key in after.errors - before.errors if key[0] not in seen]
        return _Verdict("they do not go together" if worse else "")
    (_, fix), reason = batch[0], _more(before, after)
    is_blind = any(before.levels.get(file) == UNREADABLE for file in files)  # only a first error was seen
    if not reason or not any(steps):
        return _Verdict(reason)
    is_understood = all(after.levels.get(file, UNDERSTOOD) == UNDERSTOOD for file in files)
    return _Verdict(is_doubtful=not (fix.safe or is_blind or is_understood))


def _is_later(before: Look, after: Look, told: Diagnostic) -> bool:
    """Whether a text that is no YAML, of which only the first fault is seen, has the same one further on."""
    places = [one.span for one in after.diagnostics if _key(one) == _key(told)]
    return before.levels.get(told.span.file) == UNREADABLE and bool(places) and min(places) > told.span


def _more(before: Look, after: Look) -> str:
    count, now = before.errors.total(), after.errors.total()
    return f"there would be {now} errors instead of {count}" if now > count else ""
