"""The port tables of workspaces. Each is made when it is first used, because most runs need none."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from robocomp_yaml.addresses.port_numbers import USUAL, default_port, usable
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.link.workspace import Workspaces, WorkspaceSettings
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.addresses.own import OwnAddresses, OwnText
    from robocomp_yaml.addresses.table import PortTable


class Addresses:
    """The addresses of the components of a program, and of the other components of their workspaces."""

    def __init__(self, program: Program, workspaces: Workspaces, link: Callable[[Iterable[str]], Program]) -> None:
        """`link` returns the program of further documents."""
        self._program, self._workspaces, self._link = program, workspaces, link
        self._tables: dict[str, PortTable] = {}

    def table(self, linked: LinkedComponent) -> PortTable:
        """The ports of a component's workspace. If a component is in no workspace, these are the ports of the
        components of this run."""
        return self._of(self._workspaces.of(linked.component.path))

    def all(self) -> PortTable:
        """The ports of all components of this run, in the range of the workspace around the working folder."""
        from robocomp_yaml.addresses.table import assign  # interfaces alone have no ports

        components, values = self._program.components.values(), self._program.values.values()
        return assign(components, self._program.disk, values, self.range_of(""))

    def faults(self) -> list[Diagnostic]:
        """The diagnostics of the workspaces' own ranges of ports. Without such a range, no port is assigned."""
        ranged = {}
        for linked in self._program.components.values():
            workspace = self._workspaces.of(linked.component.path)
            if workspace.declared and usable(workspace.ports) is not None:
                ranged[workspace.root] = workspace
        return [fault for workspace in ranged.values() for fault in self._of(workspace).diagnostics]

    def range_of(self, document: str) -> PortRange:
        """The range of default ports of a document's workspace."""
        return usable(self._workspaces.of(document).ports) or USUAL

    def _of(self, workspace: WorkspaceSettings) -> PortTable:
        from robocomp_yaml.addresses.table import assign

        key = workspace.root if workspace.declared else ""
        if key not in self._tables:
            others = self._others(workspace) if workspace.declared else Program()
            values = {**others.values, **self._program.values}
            components = [*others.components.values(), *self._program.components.values()]
            ports = usable(workspace.ports) or USUAL
            self._tables[key] = assign(components, self._program.disk, values.values(), ports)
        return self._tables[key]

    def _others(self, workspace: WorkspaceSettings) -> Program:
        """The components of a workspace, if this run has not read all of them. The diagnostics of the others are
        dropped: their own `check` reports them."""
        documents = of_kind(workspace.root, "cdsl", self._program.disk)
        if set(map(self._program.disk.real, documents)) <= self._program.components.keys():
            return Program()
        return self._link(documents)

    def own_endpoint(self, linked: LinkedComponent, own: OwnAddresses, name: str) -> OwnText | None:
        """The endpoint of an adapter that a component's own configuration sets; None for what rcyaml writes if nobody
        sets one."""
        text = own.endpoints.get(name)
        if text is None or text.is_as_written:
            return None
        # Most are the first choice, for which the ports of the others need not be known.
        ports = self.range_of(linked.component.path)
        if text.text == f"tcp -p {default_port(linked.component.name, name, ports)}":
            return None
        return None if self.table(linked).is_default_endpoint(linked, name, text) else text

    def own_proxy(self, linked: LinkedComponent, own: OwnAddresses, port: Port) -> OwnText | None:
        """The proxy of a port that a component's own configuration sets; None for what rcyaml writes if nobody sets
        one."""
        text = own.proxies.get(port.name)
        if text is None or text.is_as_written or self.table(linked).is_default_proxy(linked, port, text):
            return None
        return text
