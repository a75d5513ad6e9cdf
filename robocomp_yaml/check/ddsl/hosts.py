"""Addresses of hosts, and TCP ports: wrong and unreachable addresses, and ports of two processes on one host."""

from __future__ import annotations

import ipaddress
import re
import socket
from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.network.network import LOOPBACK, Endpoint, Network, NetworkHost, Process, is_loopback
from robocomp_yaml.source.ice_endpoint import parse_endpoint

_LABEL = re.compile(r"(?!-)[A-Za-z0-9_-]{1,63}(?<!-)\Z")


def check(network: Network) -> Iterator[Diagnostic]:
    yield from _addresses(network)
    yield from _conflicts(network)


def _addresses(network: Network) -> Iterator[Diagnostic]:
    hosts = _declared(network)
    is_far = any(not is_loopback(host.address) for host in hosts)
    for host in hosts:
        problem = _problem(host.address)
        if problem:
            yield codes.BAD_ADDRESS.at(host.span, address=host.address, problem=problem)
        elif is_far and is_loopback(host.address):
            yield codes.LOOPBACK.at(
                host.span, name=host.name, address=host.address, hint="write the address that other hosts use for it"
            )


def unresolved(network: Network) -> Iterator[Diagnostic]:
    """Reports host names that this machine cannot resolve. Name servers are asked, so this is for `--environment`."""
    for host in _declared(network):
        if not _problem(host.address):
            try:
                socket.getaddrinfo(host.address, None)
            except OSError:
                yield codes.NOT_RESOLVED.at(host.span, name=host.name, address=host.address)


def _declared(network: Network) -> list[NetworkHost]:
    return [host for host in network.hosts.values() if host.span.file]


def _problem(address: str) -> str:
    """Why a text is not an address, or ''."""
    if ":" in address or re.fullmatch(r"[0-9.]+", address):
        try:
            found = ipaddress.ip_address(address)
        except ValueError:
            kind = "IPv6" if ":" in address else "IPv4"
            return f"it is not an {kind} address"
        if found.is_unspecified:
            return "it means every address of a machine"
        return "it means many machines" if found.is_multicast else ""
    if len(address) > 253 or not all(map(_LABEL.match, address.removesuffix(".").split("."))):
        return "it is not a valid host name"
    return ""


def _conflicts(network: Network) -> Iterator[Diagnostic]:
    seen: dict[tuple[str, bool, int], list[tuple[str, Process, Endpoint]]] = {}
    named = {name for name, host in network.hosts.items() if host.span.file}
    for process in network.enabled():
        if named and process.host not in named:
            continue  # its host is unknown, which is reported already
        machine = _machine(network.address(process))
        for endpoint in process.listening:
            if not endpoint.port:
                continue
            parsed = parse_endpoint(endpoint.text)
            bound = _machine(parsed.host, keep=True) if parsed and parsed.host else ""
            others = seen.setdefault((machine, endpoint.protocol == "udp", endpoint.port), [])
            for host, other, served in others:
                if not host or not bound or host == bound:
                    yield codes.PORT_CONFLICT.at(
                        endpoint.span,
                        port=endpoint.port,
                        name=_name(process, endpoint),
                        other=_name(other, served),
                        host=f"host '{process.host}'" if network.hosts[process.host].span.file else "this machine",
                        hint=_hint(process, endpoint, served),
                        related=[
                            Related(f"{_name(other, served)} uses it too", served.span),
                            *(Related("set here", one.own_span) for one in (endpoint, served) if one.own_span.file),
                        ],
                    )
                    break
            others.append((bound, process, endpoint))


def _hint(process: Process, endpoint: Endpoint, other: Endpoint) -> str:
    if endpoint.own_span.file:
        return f"set another port for '{process.name}', in its entry: `ports: {{{endpoint.key}: PORT}}`"
    if endpoint.span != other.span:
        return "change one of the two ports"
    if process.component:
        return "remove the port; then rcyaml chooses one for each instance"
    return f"use {{i}}, the number of the instance, in the port: `-p {endpoint.port // 10}{{i}}`"


def _machine(address: str, *, keep: bool = False) -> str:
    """The machine of an address. All loopback addresses are one machine, unless `keep` distinguishes them."""
    if address in (LOOPBACK, "127.0.0.1", "::1") or (is_loopback(address) and not keep):
        return LOOPBACK
    return address


def _name(process: Process, endpoint: Endpoint) -> str:
    return f"'{process.name}' ({endpoint.interface})" if endpoint.interface else f"'{process.name}'"
