"""Merges a user's file with a new skeleton, or reports why that is not possible without harm.

First the three-way merge. If it has conflicts, or its result is rejected, the missing methods are inserted into the
user's version. Every result is checked before it is accepted: it has every line of the user, no more syntax errors than
before, and no missing, duplicate or outdated method.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import specific as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.emit.specific import config_merge, threeway
from robocomp_yaml.emit.specific.code import ImportLine, SourceCode
from robocomp_yaml.emit.specific.compare import Accepted, accepted_in, behind_errors, compare
from robocomp_yaml.emit.specific.insert import insert
from robocomp_yaml.emit.specific.reading import compiles, others, read
from robocomp_yaml.emit.specific.threeway import Conflict
from robocomp_yaml.emit.specific.user_file import UserFile
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import Merge

_HINT = "nothing was written; include the change in your lines, or compile without --merge and paste what it reports"


class MergeResult(msgspec.Struct, frozen=True):
    """`text` is the merge, and `base` what a later merge starts from. `reason`: why there is no merge, else ''."""

    text: str
    base: str
    conflicts: tuple[Conflict, ...] = ()
    reason: str = ""


def merge_files(root: Root, files: Sequence[UserFile]) -> tuple[dict[str, Merge], list[Diagnostic]]:
    """The merges by path, or diagnostics if a file cannot be merged: then there is no merge at all."""
    merged: dict[str, Merge] = {}
    refusals: list[Diagnostic] = []
    sides: list[UserFile] = []
    for file in files:
        path = root.shown(file.path)
        if not file.is_text:
            refusals.append(codes.CONFLICT.at(Span(path), path=path, reason="it is not UTF-8 text"))
        elif file.is_link and not file.is_up_to_date:
            reason = "it is a link: merge its target by hand"
            refusals.append(codes.CONFLICT.at(Span(path), path=path, reason=reason))
        else:
            sides.append(replace(file, yours=file.yours.replace("\r\n", "\n")) if _is_dos(file) else file)
    beside = others(root, {side.path for side in sides if side.path.startswith(f"{SOURCES}/")})
    accepted = accepted_in(code for side in sides if (code := read(side.path, side.accepted)))
    bases = {base for side in sides if (code := read(side.path, side.new)) for base in code.bases}
    for side in sides:
        result = _merge(side, [one for one in sides if one is not side], beside, bases, accepted)
        if result.reason:
            refusals += _refusals(root.shown(side.path), result)
        else:
            text = result.text.replace("\n", "\r\n") if _is_dos(side) else result.text
            merged[side.path] = Merge(side.data, text.encode(), result.base.encode())
    return ({}, refusals) if refusals else (merged, [])


def _is_dos(file: UserFile) -> bool:
    """Whether all lines end with CR LF."""
    return 0 < file.data.count(b"\n") == file.data.count(b"\r\n")


def _refusals(path: str, result: MergeResult) -> list[Diagnostic]:
    if not result.conflicts:
        return [codes.CONFLICT.at(Span(path), path=path, reason=result.reason, hint=_HINT)]
    return [
        codes.CONFLICT.at(
            Span(path, conflict.first + 1, 1, max(conflict.end, conflict.first + 1) + 1, 1),
            path=path, reason="you and the new skeleton changed the same lines", hint=_HINT, more=conflict.text,
        )
        for conflict in result.conflicts
    ]  # fmt: skip


def _merge(
    side: UserFile, besides: Sequence[UserFile], others: Sequence[SourceCode], bases: Collection[str],
    accepted: Accepted,
) -> MergeResult:  # fmt: skip
    yours = read(side.path, side.yours)
    new = read(side.path, side.new)
    if yours is None or new is None:
        return _merge_text(side)
    old = None if side.base is None else read(side.path, side.base)
    goal = new if old is None else _with_obsolete(new, old, yours)
    elsewhere = [*others, *(code for one in besides if (code := read(one.path, one.yours)))]
    judge = _Judge(side, yours, goal, old, elsewhere, bases, {code.path for code in others}, accepted)
    lacking = judge.lacking(yours)
    goal_text = "".join(goal.lines)
    if goal_text == side.base and not lacking:
        return MergeResult(side.yours, goal_text)
    merged = threeway.Merged(side.yours) if side.base is None else threeway.merge(side.base, side.yours, goal_text)
    reason = ""
    for text in _candidates(side, merged, goal, judge):
        reason = judge.fault(text)
        if not reason:
            return MergeResult(text, goal_text)
    return MergeResult(side.yours, side.base or "", merged.conflicts, reason)


def _candidates(side: UserFile, merged: threeway.Merged, goal: SourceCode, judge: _Judge) -> Iterator[str]:
    if not merged.conflicts:
        yield merged.text
    texts = (side.yours,) if judge.touches_changed(merged.conflicts) else (merged.text, side.yours)
    for text in dict.fromkeys(texts):
        code = _code(side.path, text)
        yield insert(code, goal, judge.lacking(code))


def _code(path: str, text: str) -> SourceCode:
    """The code of a file whose language has merging."""
    code = read(path, text)
    assert code is not None
    return code


def _merge_text(side: UserFile) -> MergeResult:
    """The merge of a file that is not code."""
    if config_merge.is_config(side.path):
        return MergeResult(config_merge.merge(side.base, side.yours, side.new), side.new)
    if side.base is None:
        return MergeResult(side.yours, side.new)
    merged = threeway.merge(side.base, side.yours, side.new)
    if merged.conflicts:
        return MergeResult(side.yours, side.base, merged.conflicts, "you and the new skeleton changed the same lines")
    return MergeResult(merged.text, side.new)


def _with_obsolete(new: SourceCode, old: SourceCode, yours: SourceCode) -> SourceCode:
    """The new skeleton, with the obsolete methods and imports that the user's file still has: a merge deletes none."""
    mine = {method.name for method in yours.methods}
    today = {method.name for method in new.methods}
    gone = {method.name for method in old.methods} & mine - today
    kept = tuple(one for one in old.imports if one in yours.imports)
    return _code(new.path, insert(_joined_imports(new, kept), replace(old, imports=kept), gone))


def _joined_imports(code: SourceCode, more: Sequence[ImportLine]) -> SourceCode:
    """The code with further imported names in its lines that import from the same modules."""
    lines = list(code.lines)
    for n, line in enumerate(lines):
        head, word, names = line.rstrip().partition(" import ")
        if word and head.startswith("from "):
            added = [one.line.rstrip().partition(word)[2] for one in more if one.line.startswith(f"{head}{word}")]
            lines[n] = f"{head}{word}{', '.join(sorted({*names.split(', '), *added}))}\n"
    return _code(code.path, "".join(lines))


class _Judge:
    """Decides whether a text is acceptable as the merge of a file."""

    def __init__(
        self, side: UserFile, yours: SourceCode, goal: SourceCode, old: SourceCode | None,
        elsewhere: Sequence[SourceCode], bases: Collection[str], untouched: Collection[str], accepted: Accepted,
    ) -> None:  # fmt: skip
        """`elsewhere` is the code of the user's other files, and `untouched` are those of them that are not merged."""
        self.side, self.yours, self.goal, self.elsewhere, self.bases = side, yours, goal, elsewhere, bases
        self.untouched, self.accepted = untouched, accepted
        self.hidden = behind_errors([yours, *elsewhere])
        self.base = {} if old is None else {side.path: old}
        self.changed = _changed(old, goal) if old else set()
        self.was_outdated = self._outdated(yours, old) - self.changed
        self.mine = Counter(_lines(side.yours)) - Counter(_lines(side.base or ""))

    def lacking(self, code: SourceCode) -> set[str]:
        codes = [code, *self.elsewhere]
        comparison = compare([self.goal], self.base, codes, self.bases, self.accepted, hidden=self.hidden)
        return {one.method.name for one in comparison.missing}

    def _outdated(self, code: SourceCode, against: SourceCode | None) -> set[str]:
        if against is None:
            return set()
        comparison = compare([against], self.base, [code, *self.elsewhere], self.bases, self.accepted)
        return {one.method.name for one in comparison.outdated if one.code.path in (code.path, *self.untouched)}

    def touches_changed(self, conflicts: Sequence[Conflict]) -> bool:
        """Whether lines of a conflict belong to a method whose signature changed."""
        methods = [m for m in self.yours.methods if m.name in self.changed]
        return any(one.first < m.end and m.first < max(one.end, one.first + 1) for m in methods for one in conflicts)

    def fault(self, text: str) -> str:
        """The reason why a text is rejected, '' if it is accepted."""
        code = _code(self.side.path, text)
        if lost := self.mine - Counter(_lines(text)):
            return f"the merge would lose your line '{next(iter(lost)).strip()}'"
        if code.faults > self.yours.faults or (compiles(self.yours) and not compiles(code)):
            return "the result would have syntax errors"
        if lacking := self.lacking(code):
            return f"{', '.join(sorted(lacking))} cannot be inserted"
        mine, now = _counts([self.yours, *self.elsewhere]), _counts([code, *self.elsewhere])
        if twice := {name for name, count in now.items() if count > max(1, mine[name])}:
            return f"{', '.join(sorted(twice))} would be defined twice"
        if outdated := self._outdated(code, self.goal if self.base else None) - self.was_outdated:
            return f"you and the new skeleton changed {', '.join(sorted(outdated))}"
        return ""


def _changed(old: SourceCode, new: SourceCode) -> set[str]:
    """The methods whose signatures changed."""
    before = {m.name: m.signature for m in old.methods}
    return {m.name for m in new.methods if before.get(m.name, m.signature) != m.signature}


def _counts(codes: Sequence[SourceCode]) -> Counter[str]:
    """The number of declarations and of definitions of each method."""
    declared = Counter(method.name for code in codes for method in code.members)
    return declared + Counter(f"{method.name}()" for code in codes for method in code.definitions)


def _lines(text: str) -> list[str]:
    return [line.rstrip("\r\n") for line in text.split("\n") if line.strip()]
