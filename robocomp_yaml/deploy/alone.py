"""Components without a deployment, as a network: each with its own configuration, at the addresses that this names."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.addresses.own import adapters
from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.deploy.here import is_local
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.value_files import OwnProperties, own_properties
from robocomp_yaml.link.program import LinkedComponent, Port, Program
from robocomp_yaml.model.deployment import CONFIG as CONFIG_PATH
from robocomp_yaml.network import icestorm
from robocomp_yaml.network.network import (
    LOOPBACK,
    RUNS,
    TOPIC,
    ConfigFile,
    Connection,
    Endpoint,
    Network,
    NetworkHost,
    Process,
    Readiness,
)
from robocomp_yaml.network.processes import how_to_build, own_program
from robocomp_yaml.parameters.hidden import secrets_of
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.ice_endpoint import parse_endpoint
from robocomp_yaml.source.ice_proxy import proxy_at

STORM = "IceStorm"
"""The name of the IceStorm that is started for components whose configuration names one on this machine."""


class Alone(msgspec.Struct):
    """The network of components without a deployment. `first` gives it its name, `root` is the folder of its
    workspace, or that of a component without one."""

    first: LinkedComponent
    root: str
    program: Program
    table: PortTable
    configurations: dict[str, OwnProperties] = {}

    def network(self) -> Network:
        path, name = os.path.abspath(self.first.component.path), self.first.component.name
        folder = f"{os.path.abspath(self.root)}/{RUNS}/{name}"
        linked = {self._name(one): one for one in [self.first, *self.program.components.values()]}
        made: dict[str, Process] = {}
        for each, component in linked.items():
            own = self.configurations[each] = own_properties(component, self.program, self.table)
            made[each] = self._process(each, component, own)
        connections_ = [one for each, it in linked.items() for one in self._connections(made, folder, each, it)]
        for each in linked:
            targets = (one.target for one in connections_ if one.source == each and one.target)
            after = tuple(dict.fromkeys(target for target in targets if target != each))
            made[each] = msgspec.structs.replace(made[each], after=after)
        hosts = {LOOPBACK: NetworkHost(LOOPBACK)}
        return Network(name, path, folder, hosts, made, tuple(connections_), (tuple(made),))

    def _name(self, linked: LinkedComponent) -> str:
        """The name of a component; its folder too, if another component has the same name."""
        name = linked.component.name
        same = [one for one in self.program.components.values() if one.component.name == name]
        if linked is self.first or len(same) < 2:
            return name
        return f"{name}-{os.path.basename(os.path.dirname(os.path.abspath(linked.component.path)))}"

    def _process(self, name: str, linked: LinkedComponent, own: OwnProperties) -> Process:
        folder = os.path.abspath(os.path.dirname(linked.component.path))
        served = tuple(self._served(linked, own))
        return Process(
            name,
            LOOPBACK,
            (f"{folder}/{own_program(linked)}", CONFIG_PATH if own.is_derived else f"{folder}/{CONFIG}"),
            folder,
            config=ConfigFile(f"config/{name}", own.text, own.secrets) if own.is_derived else None,
            endpoints=served,
            ready=Readiness(pings=tuple(f"{one.identity}:{_reached(one)}" for one in served)),
            secrets=secrets_of(linked.parameters),
            component=linked.component.name,
            build=how_to_build(linked),
            span=linked.component.span,
        )

    def _served(self, linked: LinkedComponent, own: OwnProperties) -> Iterator[Endpoint]:
        ports = {port.name: port for port in linked.implements}
        for adapter in adapters(linked):
            text = own.first(connections.endpoints(adapter))
            endpoint = parse_endpoint(text)
            if endpoint is not None:
                port = ports.get(adapter)
                interface, module = (port.interface.name, port.scope.module.name) if port else (COMMON_BEHAVIOR, "")
                yield Endpoint(
                    adapter, interface.lower(), endpoint.port, text, endpoint.protocol, module, linked.component.span
                )

    def _connections(
        self, made: dict[str, Process], folder: str, name: str, linked: LinkedComponent
    ) -> Iterator[Connection]:
        """The connections of a component. Adds the IceStorms that it needs to the processes."""
        own = self.configurations[name]
        for port in linked.requires:
            text = own.proxy(port)
            target = self._server(made, port, text)
            yield Connection(name, port.name, port.interface.name, target, proxy=text, span=port.use.span)
        for is_out, ports in ((True, linked.publishes), (False, linked.subscribes)):
            for port in ports:
                text = own.first(connections.MANAGER)
                target = self._storm(made, folder, text, linked)
                interface = port.interface.name
                yield Connection(name, port.name, interface, target, TOPIC, port.name, is_out, text, port.use.span)

    def _server(self, made: Mapping[str, Process], port: Port, text: str) -> str:
        """The name of the component that serves an interface at the address of a proxy, '' if none does."""
        wanted = local_ports(text)
        for process in made.values():
            for served in process.endpoints:
                is_same = (served.module, served.identity) == (port.scope.module.name, port.interface.name.lower())
                if is_same and served.port in wanted:
                    return process.name
        return ""

    def _storm(self, made: dict[str, Process], folder: str, manager: str, linked: LinkedComponent) -> str:
        """The name of the IceStorm on this machine at the address of a proxy, '' if that names another machine."""
        for number in local_ports(manager):
            name = f"{STORM}-{number}"
            if name not in made:
                span = linked.component.span
                made[name] = icestorm.on_this_machine(name, number, f"{os.path.dirname(folder)}/storm", span)
            return name
        return ""


def local_ports(text: str) -> list[int]:
    """The TCP ports of a proxy that are on this machine."""
    found = proxy_at(text)
    return [one.port for one in found.endpoints if is_local(one.host or LOOPBACK)] if found else []


def _reached(served: Endpoint) -> str:
    endpoint = parse_endpoint(served.text)
    assert endpoint is not None
    host = "" if endpoint.host in ("0.0.0.0", "*", "::") else endpoint.host
    return msgspec.structs.replace(endpoint, host=host).reached_at(LOOPBACK)
