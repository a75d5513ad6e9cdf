"""Proxies of `connect:` that Ice accepts, but that reach nothing, or name an object that nobody serves there."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.addresses import impossible_proxies
from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.network.network import PROXY, Connection, Network, is_loopback
from robocomp_yaml.source.ice_proxy import Proxy, proxy_at


def check(network: Network) -> Iterator[Diagnostic]:
    for connection in network.connections:
        source = network.processes.get(connection.source)
        if connection.target or connection.kind != PROXY or source is None or connection.span == source.span:
            continue  # the proxy of a component's own configuration is checked there
        proxy = proxy_at(connection.proxy)
        if proxy is None:
            continue
        if problem := impossible_proxies.problem(proxy):
            hint = f'such as "{connection.interface.lower()}:tcp -h HOST -p PORT"'
            yield codes.IMPOSSIBLE_PROXY.at(connection.span, port=connection.port, problem=problem, hint=hint)
        yield from _identity(network, connection, proxy)


def _identity(network: Network, connection: Connection, proxy: Proxy) -> Iterator[Diagnostic]:
    """An object that a process of this network does not serve at its port, although it serves others there."""
    here = network.address(network.processes[connection.source])
    for endpoint in proxy.endpoints:
        address = here if not endpoint.host or is_loopback(endpoint.host) else endpoint.host
        for process in network.processes.values():
            at = network.address(process)
            if at != address and not (is_loopback(at) and is_loopback(address)):
                continue
            served = [one.identity for one in process.endpoints if one.port == endpoint.port and one.identity]
            if served and proxy.identity not in served:
                fault = codes.OTHER_IDENTITY.at(
                    connection.span, identity=proxy.identity, target=process.name,
                    served=", ".join(f"'{one}'" for one in served), number=endpoint.port,
                    hint=did_you_mean(proxy.identity, served, otherwise=f"write {served[0]}"),
                )  # fmt: skip
                # RCManager starts such networks, and the error may be one of years.
                yield fault.as_severity(WARNING) if network.processes[connection.source].extra else fault
