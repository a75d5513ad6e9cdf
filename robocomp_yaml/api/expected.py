"""Where the components of a workspace expect the servers of interfaces, and IceStorm: by their own configurations, and
in the deployments around."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.addresses.interface_comparison import HasInterface
from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.here import is_local
from robocomp_yaml.emit.value_files import own_properties
from robocomp_yaml.link.program import LinkedComponent, Port
from robocomp_yaml.network.assigned_ports import STORM_PORT
from robocomp_yaml.network.draft import MANAGER, STORM_INSTANCE
from robocomp_yaml.network.network import LOOPBACK, PROXY, TOPIC, Connection, Network
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.ice_endpoint import IceEndpoint, parse_endpoint
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.wire.addresses import Address, Topic

_HERE = "127.0.0.1"
STORM = f"{STORM_INSTANCE}/{MANAGER}:tcp -h {_HERE} -p {STORM_PORT}"
"""The topic manager that a component expects by default."""


class Expectations:
    """What the components and deployments of an analysis expect on this machine."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        self._table: PortTable | None = None

    def servers(self, served: HasInterface) -> list[Address]:
        """Where an interface is expected: by each component that requires it, else where a component serves it."""
        module, interface = served.scope.module.name, served.interface.name
        found: dict[Address, list[str]] = {}
        for proxy, user in self._proxies(module, interface):
            for address in _addresses(proxy):
                users = found.setdefault(address, [])
                if user not in users:
                    users.append(user)
        made = [msgspec.structs.replace(address, users=tuple(users)) for address, users in found.items()]
        return made or [Address(self._usual(served), interface.lower())]

    def topics(self, module: str, interface: str) -> list[Topic]:
        """Through which IceStorm, and by which name, components subscribe to a topic."""
        found: dict[Topic, None] = {}
        for linked in self._components():
            own = own_properties(linked, self._analysis.program, self._ports())
            for port in _of(linked.subscribes, module, interface):
                prefix, name = own.first((connections.prefix(port.name),)), own.first((port.name,))
                topic = connections.topic(prefix, name, interface)
                found[Topic(own.first(connections.MANAGER) or STORM, topic)] = None
        for _, network, one, subscribed in self._connections(TOPIC):
            if not one.is_out and subscribed is not None and _is(subscribed, module, interface):
                proxy = network.processes[one.target].ready.pings[0] if one.target else one.proxy
                found[Topic(proxy, one.topic)] = None
        # the same proxy can be written in several ways
        distinct = {(str(_addresses(topic.manager)), topic.name): topic for topic in found}
        return list(distinct.values()) or [Topic(STORM, interface)]

    def _proxies(self, module: str, interface: str) -> Iterator[tuple[str, str]]:
        """The proxies of those who require an interface, each with who that is."""
        for linked in self._components():
            ports = _of(linked.requires, module, interface)
            own = own_properties(linked, self._analysis.program, self._ports()) if ports else None
            for port in ports:
                if own is not None and own.proxy(port):
                    yield own.proxy(port), linked.component.name
        for path, network, one, required in self._connections(PROXY):
            if required is not None and _is(required, module, interface):
                user = f"{one.source} of {shown_path(path)}"
                yield (_of_target(network, one, interface) if one.target else one.proxy), user

    def _components(self) -> list[LinkedComponent]:
        return sorted(self._analysis.program.components.values(), key=lambda one: one.component.path)

    def _connections(self, kind: str) -> Iterator[tuple[str, Network, Connection, Port | None]]:
        """The connections of a kind in all deployments that no other one includes, each with its port."""
        for real, network in self._analysis.networks.items():
            linked = self._analysis.program.deployments[real]
            if linked.is_included:
                continue
            for one in network.connections:
                instance = linked.instances.get(one.source)
                component = instance.component if instance is not None else None
                ports = (*component.requires, *component.publishes, *component.subscribes) if component else ()
                found = next((port for port in ports if port.name == one.port), None)
                if one.kind == kind:
                    yield linked.deployment.path, network, one, found

    def _usual(self, served: HasInterface) -> str:
        """The endpoint at which a component of the workspace serves an interface, else the default of a proxy."""
        for linked, port in self._ports().implementers.of(served):
            endpoint = self._ports().endpoint(linked, port.name)
            return IceEndpoint(endpoint.port, endpoint.protocol, endpoint.host or _HERE).reached_at(_HERE)
        return IceEndpoint(self._ports().proposed(served.interface.name)).reached_at(_HERE)

    def _ports(self) -> PortTable:
        if self._table is None:
            self._table = self._analysis.addresses.all()
        return self._table


def _of(ports: tuple[Port, ...], module: str, interface: str) -> list[Port]:
    return [port for port in ports if _is(port, module, interface)]


def _is(port: Port, module: str, interface: str) -> bool:
    return (port.scope.module.name, port.interface.name) == (module, interface)


def _of_target(network: Network, one: Connection, interface: str) -> str:
    """The proxy to a process of the network."""
    process = network.processes[one.target]
    for served in process.endpoints:
        endpoint = parse_endpoint(served.text)
        if served.identity == interface.lower() and endpoint is not None:
            return f"{served.identity}:{endpoint.reached_at(network.address(process))}"
    return ""


def _addresses(proxy: str) -> list[Address]:
    """The addresses of a proxy that are on this machine, for a server."""
    found = proxy_at(proxy)
    return [
        Address(IceEndpoint(one.port, _protocol(one), _host(one)).reached_at(_HERE), found.identity)
        for one in (found.endpoints if found else ())
        if found and one.port and is_local(one.host or LOOPBACK)
    ]


def _protocol(endpoint: IceEndpoint) -> str:
    return "tcp" if endpoint.protocol == "default" else endpoint.protocol


def _host(endpoint: IceEndpoint) -> str:
    return "" if endpoint.host == LOOPBACK else endpoint.host
