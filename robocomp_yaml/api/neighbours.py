"""The TCP ports of the components of a workspace, as far as their configurations leave them open."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.emit.ports import PortTable


def ports(analysis: Analysis) -> Callable[[LinkedComponent], PortTable]:
    """A function that returns the ports of a component's workspace, which are assigned once. If a component is in no
    workspace, the ports are those of the components of this run."""
    known: dict[str, PortTable] = {}

    def of(linked: LinkedComponent) -> PortTable:
        workspace = analysis.linker.workspace_of(linked.component.path)
        key = workspace.root if workspace.declared else ""
        if key not in known:
            from robocomp_yaml.emit.ports import assign  # unused if only interfaces are compiled

            others = Program()
            if workspace.declared:
                # The diagnostics of the others are dropped: their own `check` reports them.
                linker = Linker(analysis.linker.documents, analysis.linker.search)
                others = linker.link(of_kind(workspace.root, "cdsl", analysis.disk))
            values = {**others.values, **analysis.program.values}
            components = [*others.components.values(), *analysis.program.components.values()]
            known[key] = assign(components, analysis.disk, values.values())
        return known[key]

    return of


def workspace_ports(analysis: Analysis) -> PortTable:
    """The ports of all components that were read."""
    from robocomp_yaml.emit.ports import assign

    return assign(analysis.program.components.values(), analysis.disk, analysis.program.values.values())
