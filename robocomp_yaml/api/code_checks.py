"""The checkers of languages, which `check --code` runs over the user's code."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.specific import existing_code
from robocomp_yaml.emit.usage.checked import CheckedCode
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.transactions.output_root import Root


def check(analysis: Analysis, known: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
    """What the checkers report, except in lines about which something is `known`. The types are those of the documents,
    not those of the last compile. Raises Refused if a checker is not installed."""
    built = existing_code.plans(analysis.program, analysis.diagnostics, analysis.workspaces, analysis.addresses.table)
    by_language: dict[str, list[CheckedCode]] = {}
    for plan in built.plans:
        linked = built.components.get((plan.root, plan.owner))
        if linked is not None and linked.component.language.target.has_checker:
            workspace = analysis.workspaces.of(linked.component.path)
            unit = CheckedCode(linked, Root(plan.root), plan.files, workspace.root or ".")
            by_language.setdefault(linked.component.language.name, []).append(unit)
    lines = {(one.span.file, one.span.line) for one in known}
    for units in by_language.values():
        found = units[0].linked.component.language.target.part("checker").check(units)
        yield from (one for one in found if (one.span.file, one.span.line) not in lines)
