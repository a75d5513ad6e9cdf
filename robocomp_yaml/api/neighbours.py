"""The ports of a workspace, for the configuration of one of its components, as far as that leaves them open."""

from __future__ import annotations

from collections.abc import Callable

from robocomp_yaml.emit.ports import PortTable, assign
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.link.workspace import Workspace
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import of_kind


def ports(analysis: Analysis) -> Callable[[LinkedComponent], PortTable]:
    """The ports of a component's workspace, assigned once for each workspace; where a component is in none, those of
    this run's components."""
    known: dict[str, PortTable] = {}

    def of(linked: LinkedComponent) -> PortTable:
        workspace = analysis.linker.workspace_of(linked.component.path)
        key = workspace.root if workspace.declared else ""
        if key not in known:
            around = _neighbours(workspace, analysis)
            values = {**around.values, **analysis.program.values}
            components = [*around.components.values(), *analysis.program.components.values()]
            known[key] = assign(components, analysis.disk, values.values())
        return known[key]

    return of


def _neighbours(workspace: Workspace, analysis: Analysis) -> Program:
    """All components of a workspace, whether this run is about them or not."""
    if not workspace.declared:
        return Program()
    paths = of_kind(workspace.root, "cdsl", analysis.disk)
    around = Linker(analysis.linker.documents, analysis.linker.search)
    return around.link(paths)  # what is wrong with neighbours is for their own `check`
