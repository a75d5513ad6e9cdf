"""The ports of a workspace, for the configuration of one of its components, as far as that leaves them open."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.emit.ports import Ports


def ports(analysis: Analysis) -> Callable[[LinkedComponent], Ports]:
    """The ports of a component's workspace, assigned once for each workspace; where a component is in none, those of
    this run's components."""
    known: dict[str, Ports] = {}

    def of(linked: LinkedComponent) -> Ports:
        workspace = analysis.linker.workspace_of(linked.component.path)
        key = workspace.root if workspace.declared else ""
        if key not in known:
            from robocomp_yaml.emit.ports import assign  # a compile of interfaces alone does not need it

            around = Program()
            if workspace.declared:  # what is wrong with neighbours is for their own `check`
                linker = Linker(analysis.linker.documents, analysis.linker.search)
                around = linker.link(of_kind(workspace.root, "cdsl", analysis.disk))
            values = {**around.values, **analysis.program.values}
            components = [*around.components.values(), *analysis.program.components.values()]
            known[key] = assign(components, analysis.disk, values.values())
        return known[key]

    return of
