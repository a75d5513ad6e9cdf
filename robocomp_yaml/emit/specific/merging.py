"""The merge of one component's files, and what stands against it."""

from __future__ import annotations

from collections.abc import Sequence

from robocomp_yaml.diag.codes import specific as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.specific import sources
from robocomp_yaml.emit.specific.merge import Result, Side, merge
from robocomp_yaml.emit.specific.own import Own
from robocomp_yaml.transactions.places import Root
from robocomp_yaml.transactions.plan import Merge

_HINT = "nothing was written; make room by hand, or compile without --merge and paste what it names"


def merge_files(root: Root, files: Sequence[Own]) -> tuple[dict[str, Merge], list[Diagnostic]]:
    """The merges by path; with diagnostics, none of them is to be carried out."""
    refusals: list[Diagnostic] = []
    sides: list[Side] = []
    for file in files:
        path = root.shown(file.plan.path)
        if file.yours is None or (file.is_link and not file.is_settled):
            reason = "it is not UTF-8 text" if file.yours is None else "it is a link: merge what it leads to by hand"
            refusals.append(codes.CONFLICT.at(Span(path), path=path, reason=reason))
        else:
            sides.append(Side(file.plan.path, file.base, file.yours, file.plan.text))
    folders = {side.path.rpartition("/")[0] for side in sides if side.path.startswith("src/")}
    known = {side.path for side in sides}
    others = [code for folder in sorted(folders) for code in sources.others(root, folder, known)]
    merged: dict[str, Merge] = {}
    data = {file.plan.path: file.data for file in files}
    for result in merge(sides, others):
        if result.reason:
            refusals += _refusals(root, result)
        else:
            merged[result.path] = Merge(data[result.path], result.text.encode(), result.base.encode())
    return ({}, refusals) if refusals else (merged, [])


def _refusals(root: Root, result: Result) -> list[Diagnostic]:
    path = root.shown(result.path)
    if not result.conflicts:
        return [codes.CONFLICT.at(Span(path), path=path, reason=result.reason, hint=_HINT)]
    return [
        codes.CONFLICT.at(
            Span(path, conflict.first + 1, 1, max(conflict.end, conflict.first + 1) + 1, 1),
            path=path, reason="you and rcyaml changed the same lines", hint=_HINT, more=conflict.text,
        )
        for conflict in result.conflicts
    ]  # fmt: skip
