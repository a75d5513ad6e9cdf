"""Addresses of hosts: what is none, and what the others cannot reach."""

from __future__ import annotations

import ipaddress
import re
import socket
from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost, is_loopback

_LABEL = re.compile(r"(?!-)[A-Za-z0-9_-]{1,63}(?<!-)\Z")


def check(network: Network) -> Iterator[Diagnostic]:
    hosts = _declared(network)
    is_far = any(not is_loopback(host.address) for host in hosts)
    for host in hosts:
        problem = _problem(host.address)
        if problem:
            yield codes.BAD_ADDRESS.at(host.span, address=host.address, problem=problem)
        elif is_far and is_loopback(host.address):
            yield codes.LOOPBACK.at(
                host.span, name=host.name, address=host.address, hint="give it the address by which the others reach it"
            )


def unresolved(network: Network) -> Iterator[Diagnostic]:
    """Names that this machine cannot resolve: a question to the network, so it is asked only when wanted."""
    for host in _declared(network):
        if not _problem(host.address):
            try:
                socket.getaddrinfo(host.address, None)
            except OSError:
                yield codes.NOT_RESOLVED.at(host.span, name=host.name, address=host.address)


def _declared(network: Network) -> list[NetworkHost]:
    return [host for host in network.hosts.values() if host.span.file]


def _problem(address: str) -> str:
    """Why a text is no address, or ''."""
    if ":" in address or re.fullmatch(r"[0-9.]+", address):
        try:
            found = ipaddress.ip_address(address)
        except ValueError:
            kind = "IPv6" if ":" in address else "IPv4"
            return f"it is no {kind} address"
        if found.is_unspecified:
            return "it stands for every address of a machine"
        return "it stands for many machines" if found.is_multicast else ""
    if len(address) > 253 or not all(map(_LABEL.match, address.removesuffix(".").split("."))):
        return "it is no name of a machine"
    return ""
