"""The TCP ports of a workspace, and which of its components implement what others require.

Ports that values documents or an `etc/config` set are kept. A default is never one of them. If two defaults are equal,
the later name (component, then interface) gets the next free port. Defaults therefore depend only on names, and do not
change once they are in an `etc/config`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable

import msgspec

from robocomp_yaml.addresses.interface_comparison import Implementers
from robocomp_yaml.addresses.own import OwnAddresses, OwnText, adapters, of_flat, of_values
from robocomp_yaml.addresses.own_configuration import chosen, is_own
from robocomp_yaml.addresses.port_numbers import RESERVED, USUAL, FreePorts, default_port
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.flat_configs import flat_config
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port
from robocomp_yaml.model.port_range import PortRange
from robocomp_yaml.semantics import connections
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint

LOCALHOST = "localhost"


class Resolved(msgspec.Struct, frozen=True):
    """Where a required interface is served in a workspace: the proxy, the component that implements it (None if no
    other component does, so that the proxy is only a proposal), and all of these components."""

    proxy: str
    component: LinkedComponent | None = None
    others: tuple[LinkedComponent, ...] = ()


class PortTable(msgspec.Struct):
    """The endpoint of each adapter of a workspace (key: real path of the component's document, name of the interface),
    and the components that implement an interface. `ports` is the range of defaults. `wanted` has for each port
    the adapters that have it, or would have it by default in this range or in the usual one. `first` has the ports that
    rcyaml wrote, where the user changed them: another text would make the user's ports rcyaml's own. `diagnostics`
    report a full range. `real` returns the real path of a document."""

    endpoints: dict[tuple[str, str], IceEndpoint] = {}
    first: dict[tuple[str, str], int] = {}
    implementers: Implementers = msgspec.field(default_factory=Implementers)
    ports: PortRange = USUAL
    wanted: dict[int, set[tuple[str, str]]] = {}
    diagnostics: list[Diagnostic] = []
    real: Callable[[str], str] = os.path.realpath

    def key(self, linked: LinkedComponent, name: str) -> tuple[str, str]:
        """The key of an adapter of a component: the document identifies the component."""
        return self.real(linked.component.path), name

    def endpoint(self, linked: LinkedComponent, name: str) -> IceEndpoint:
        """The endpoint of an adapter of a component."""
        return self.endpoints[self.key(linked, name)]

    def first_port(self, linked: LinkedComponent, name: str) -> int:
        """The port of an adapter in the first `etc/config` of a component, whatever the user made of that."""
        return self.first.get(self.key(linked, name)) or self.endpoint(linked, name).port

    def proposed(self, interface: str) -> int:
        """The port of an interface that no component of the workspace implements."""
        return default_port("", interface, self.ports)

    def resolve(self, linked: LinkedComponent) -> dict[str, Resolved]:
        """Where each required interface of a component is served, by the name of its port. The second port of an
        interface is for the second component that implements it, if there is one."""
        found: dict[str, Resolved] = {}
        earlier: list[Port] = []
        for port in linked.requires:
            count = sum(self.implementers.comparison.is_equal(port, other) for other in earlier)
            earlier.append(port)
            serving = self.implementers.of(port, besides=linked)
            if serving:
                other, served = serving[min(count, len(serving) - 1)]
                endpoint, components = self.endpoint(other, served.name), tuple(one for one, _ in serving)
                found[port.name] = Resolved(_proxy(port, endpoint), other, components)
            else:
                found[port.name] = Resolved(_proxy(port, IceEndpoint(self.proposed(port.interface.name))))
        return found

    def is_default_endpoint(self, linked: LinkedComponent, name: str, own: OwnText) -> bool:
        """Whether an endpoint is what rcyaml writes if nobody sets one: then it is not the user's choice."""
        if own.is_as_written:
            return True
        endpoint = parse_endpoint(own.text)
        if endpoint is None or (endpoint.protocol, endpoint.host, endpoint.options) != ("tcp", "", ""):
            return False
        return any(self._leads_to(linked, name, endpoint.port, ports) for ports in {USUAL, self.ports})

    def is_default_proxy(self, linked: LinkedComponent, port: Port, own: OwnText) -> bool:
        """Whether a proxy is what rcyaml writes if nobody sets one."""
        if own.is_as_written:
            return True
        if own.text == self.resolve(linked)[port.name].proxy:
            return True
        owners = [("", port.interface.name)]
        owners += [(other.component.name, one.name) for other, one in self.implementers.of(port, besides=linked)]
        numbers = {default_port(*owner, ports) for owner in owners for ports in (USUAL, self.ports)}
        name = port.interface.name.lower()
        return own.text in {f"{name}:tcp -h {LOCALHOST} -p {number}" for number in numbers}

    def want(self, owner: str, name: str, port: int) -> None:
        self.wanted.setdefault(port, set()).add((owner, name))

    def _leads_to(self, linked: LinkedComponent, name: str, number: int, ports: PortRange) -> bool:
        """Whether the default of an adapter is this port, or would be if others had its first choice."""
        at = default_port(linked.component.name, name, ports)
        for _ in range(ports.count):
            if at == number:
                return True
            if at not in RESERVED and not self.wanted.get(at, set()) - {self.key(linked, name)}:
                return False
            at = ports.first + (at + 1 - ports.first) % ports.count
        return False


def assign(
    components: Iterable[LinkedComponent], disk: Disk, values: Iterable[LinkedValues] = (), ports: PortRange = USUAL
) -> PortTable:
    """The ports of a workspace's components: those that values documents set, those of `etc/config`, else defaults in
    the range `ports`."""
    configured = {one.parameters.component: one for one in values if one.parameters and is_own(one, disk)}
    distinct = {disk.real(linked.component.path): linked for linked in components}
    ordered = sorted(distinct.items(), key=lambda item: (item[1].component.name, item[0]))
    result, free = PortTable(implementers=Implementers(real=disk.real), ports=ports, real=disk.real), FreePorts()
    for key, linked in ordered:
        for name, endpoint in _fixed(linked, configured.get(linked), disk):
            result.endpoints[key, name] = endpoint
            free.taken.add(endpoint.port)
            result.want(key, name, endpoint.port)
        result.first |= {(key, name): port for name, port in _first(linked, disk)}
    for key, linked in ordered:
        for name in sorted(adapters(linked)):
            for each in (USUAL, ports):
                result.want(key, name, default_port(linked.component.name, name, each))
            if (key, name) not in result.endpoints:
                # A full range is reported; the ports are valid all the same.
                number = free.assign(linked.component.name, name, ports) or free.assign(linked.component.name, name)
                result.endpoints[key, name] = IceEndpoint(number)
                result.want(key, name, number)
    for _, linked in sorted(distinct.items()):
        result.implementers.add(linked)
    result.diagnostics += free.diagnostics()
    return result


def _fixed(linked: LinkedComponent, values: LinkedValues | None, disk: Disk) -> Iterable[tuple[str, IceEndpoint]]:
    """The fixed endpoints of a component: those of its own configuration. A compile leaves those that a values document
    does not set as they were."""
    own, flat = chosen(linked, values, disk), flat_config(os.path.dirname(linked.component.path), disk)
    endpoints = (of_flat(flat, linked) if flat is not None else OwnAddresses()).endpoints
    if own.values is not None:
        endpoints |= of_values(own.values).endpoints
    for name, text in endpoints.items():
        if endpoint := parse_endpoint(text.text):
            yield name, endpoint


def _first(linked: LinkedComponent, disk: Disk) -> Iterable[tuple[str, int]]:
    """The ports that rcyaml wrote in a flat config, and that are other ones now."""
    flat = flat_config(os.path.dirname(linked.component.path), disk)
    for name in adapters(linked) if flat is not None else ():
        for key in connections.endpoints(name):
            written = parse_endpoint(unquoted(flat.base.get(key, ""))) if flat is not None else None
            if flat is not None and written is not None and not flat.is_as_written(key):
                yield name, written.port


def _proxy(port: Port, endpoint: IceEndpoint) -> str:
    return f"{port.interface.name.lower()}:{endpoint.reached_at(LOCALHOST)}"
