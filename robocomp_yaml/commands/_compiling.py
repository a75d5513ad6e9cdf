"""What `rcyaml compile` does between the program and the disk, and how it tells of it."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors, in_order
from robocomp_yaml.diag.render import render
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.emit import changes as actions
from robocomp_yaml.emit.build import Options, build as build_plans
from robocomp_yaml.emit.changes import Change, Changes
from robocomp_yaml.emit.plan import RootPlan
from robocomp_yaml.emit.ports import Ports, assign
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.link.workspace import Workspace
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import documents_below, kind_of

SHOWN = 6  # files of one folder and one fate that are listed; of more, the number is told

_DONE = {
    actions.CREATE: "wrote", actions.UPDATE: "updated", actions.ADOPT: "took over", actions.EDITED: "rewrote",
    actions.REMOVE: "removed", actions.KEPT: "kept", actions.LEFT: "left", actions.UNCHANGED: "unchanged",
}  # fmt: skip
_WOULD = {
    actions.CREATE: "would write", actions.UPDATE: "would update", actions.ADOPT: "would take over",
    actions.EDITED: "would rewrite", actions.REMOVE: "would remove", actions.KEPT: "would keep",
    actions.LEFT: "would leave", actions.UNCHANGED: "unchanged",
}  # fmt: skip


@dataclass(slots=True)
class Built:
    """The plans of a run, what kept documents from being planned, and the other roots to look at: those in which a
    document that is gone may have left something."""

    plans: list[RootPlan]
    diagnostics: list[Diagnostic]
    others: list[str] = field(default_factory=list)


def build(analysis: Analysis, output: str | None, targets: Iterable[str]) -> Built:
    """What `analysis` comes to on the disk."""
    workspace_of = analysis.linker.workspace_of
    options = Options(output, analysis.found.folders, frozenset(targets), workspace_of, _ports(analysis))
    built = build_plans(analysis.program, analysis.diagnostics, options)
    others = list(analysis.found.roots)
    if output is not None and analysis.found.folders and os.path.isdir(output):
        for _ in documents_below(output, others):
            pass
    return Built(built.plans, built.diagnostics, others)


def _ports(analysis: Analysis) -> Callable[[LinkedComponent], Ports]:
    """The ports of a component's workspace, assigned once for each workspace; where a component is in none, those of
    this run's components."""
    known: dict[str, Ports] = {}

    def of(linked: LinkedComponent) -> Ports:
        workspace = analysis.linker.workspace_of(linked.component.path)
        key = workspace.root if workspace.declared else ""
        if key not in known:
            known[key] = assign([*_neighbours(workspace, analysis), *analysis.program.components.values()])
        return known[key]

    return of


def _neighbours(workspace: Workspace, analysis: Analysis) -> Iterable[LinkedComponent]:
    """All components of a workspace, whether this run is about them or not."""
    if not workspace.declared:
        return ()
    paths = [path for path in documents_below(workspace.root) if kind_of(path) == "cdsl"]
    around = Linker(analysis.linker.documents, analysis.linker.search)
    around.link(paths)  # what is wrong with neighbours is for their own `check`
    return around.program.components.values()


def refresh_schemas(analysis: Analysis) -> list[Diagnostic]:
    """Brings the schemas up to date that the workspaces' editors read. A workspace that cannot be written to has
    compiled all the same."""
    from robocomp_yaml.source import workspace_files

    for workspace in analysis.linker.workspaces.values():
        try:
            workspace_files.install(Path(workspace.root))
        except OSError:
            continue
    return []


def report(
    ctx: click.Context, changes: Changes, told: list[Diagnostic], analysis: Analysis, format_: str, *,
    dry_run: bool, diff: bool, check: bool,
) -> None:  # fmt: skip
    """Prints what happened to the files and what is wrong, and ends the command."""
    told = in_order(told)
    failed = has_errors(told) or (check and changes.dirty)
    if format_ == "json":
        files = [{"path": c.path, "action": c.action, **({"orig": c.orig} if c.orig else {})} for c in changes]
        data = {"diagnostics": [as_data(d) for d in told], "documents": analysis.program.documents, "files": files}
        click.echo(json.dumps(data, indent=2, ensure_ascii=False))
    elif format_ == "sarif":
        click.echo(render(format_, told, analysis.program.documents), nl=False)
    else:
        if diff:
            click.echo("".join(line for change in changes for line in _diff(change, _options.colored(ctx))), nl=False)
        elif ctx.obj.verbosity >= 0 or check:
            _tell(ctx, changes, _WOULD if dry_run else _DONE)
        if told:
            shown = render("text", told, analysis.program.documents, _options.colored(ctx))
            click.echo(shown, nl=False, color=ctx.color)
        if ctx.obj.verbosity >= 0 and not diff:
            click.echo(_summary(changes, analysis, dry_run))
    ctx.exit(1 if failed else 0)


def _diff(change: Change, color: bool) -> Iterable[str]:
    if change.action not in (*actions.WRITING, actions.REFUSED):
        return
    for line in change.diff():
        tint = {"+": "green", "-": "red", "@": "cyan"}.get(line[:1]) if color else None
        yield click.style(line, fg=tint) if tint else line


def _tell(ctx: click.Context, changes: Changes, words: dict[str, str]) -> None:
    """One line a file; of many alike in one folder, one line for all. What is unchanged is told of to the curious."""
    hidden = {actions.REFUSED} if ctx.obj.verbosity > 0 else {actions.REFUSED, actions.UNCHANGED}
    for root in changes.roots:
        groups: dict[tuple[str, str], list[Change]] = {}
        for change in root.changes:
            top = os.path.relpath(change.path, root.root).partition("/")
            folder = os.path.normpath(os.path.join(root.root, top[0])) if top[1] else root.root
            groups.setdefault((change.action, folder), []).append(change)
        for (action, folder), group in groups.items():
            if action in hidden:
                continue
            if len(group) > SHOWN and ctx.obj.verbosity < 1:
                click.echo(f"{words[action]:<9} {folder}/ ({len(group)} files)")
                continue
            for change in group:
                kept = f" (yours is {change.orig})" if change.orig else " (yours)" if action == actions.KEPT else ""
                click.echo(f"{words[action]:<9} {change.path}{kept}")


def _summary(changes: Changes, analysis: Analysis, dry_run: bool) -> str:
    counts = Counter(change.action for change in changes)
    written = sum(counts[action] for action in actions.WRITING if action != actions.REMOVE)
    verb = "to write" if dry_run else "written"
    parts = [f"{written} file{'' if written == 1 else 's'} {verb}"]
    for action, words in ((actions.REMOVE, "removed"), (actions.UNCHANGED, "unchanged"), (actions.KEPT, "yours")):
        if counts[action]:
            parts.append(f"{counts[action]} {words}")
    documents = analysis.program.documents
    return f"{documents} document{'' if documents == 1 else 's'} compiled: {', '.join(parts)}"
