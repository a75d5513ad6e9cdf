"""The IP addresses of hosts that a document names.

A process must listen on an address, because a name can mean another one on its own host: Debian's /etc/hosts has
127.0.1.1 for the machine's own name, which no other host reaches.
"""

from __future__ import annotations

import functools
import ipaddress
import socket
from collections.abc import Iterable

from robocomp_yaml.network.network import LOOPBACK, NetworkHost, is_loopback


def is_name(address: str) -> bool:
    try:
        ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return not is_loopback(address)
    return False


def own_address(host: NetworkHost, hosts: Iterable[NetworkHost]) -> str:
    """The IP address of a host, or that of its entry if it is one. A name that means this machine itself is the address
    from which this machine reaches the first of the other hosts; '' if there is none, or the name is unknown."""
    if not is_name(host.address):
        return host.address
    found = _addresses(host.address)
    outside = [one for one in found if not is_loopback(one)]
    if outside or not found:
        return outside[0] if outside else ""
    others = (one.address for one in hosts if one.name != host.name and one.address != LOOPBACK)
    towards = (address for other in others if not is_loopback(address := towards_address(other)))
    return next(towards, "")


def towards_address(address: str) -> str:
    """The local address of the route to another address, a loopback address if there is none. Nothing is sent."""
    try:
        family = socket.getaddrinfo(address, 9, type=socket.SOCK_DGRAM)[0][0]
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((address, 9))
            found: str = probe.getsockname()[0]
            return found
    except OSError:
        return "127.0.0.1"


@functools.cache
def _addresses(name: str) -> list[str]:
    """The addresses of a name, IPv4 first, as Ice prefers it."""
    try:
        found = socket.getaddrinfo(name, None, type=socket.SOCK_STREAM)
    except OSError:
        return []
    ordered = sorted({(family != socket.AF_INET, str(target[0])) for family, _, _, _, target in found})
    return [address for _, address in ordered]
