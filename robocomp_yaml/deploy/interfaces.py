"""Network interfaces in `listen:`, such as wlan0. A name there is an interface if its host has one of that name, else
the name of an address; so it is resolved on the host itself: by this module on this machine, by `run` on others.
"""

from __future__ import annotations

import contextlib
import fcntl
import ipaddress
import re
import socket
import struct
from collections.abc import Mapping
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.deploy.here import is_here, is_near
from robocomp_yaml.deploy.own_address import is_name
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import PROGRAM, Network, Process
from robocomp_yaml.source.ice_endpoint import spelled_host

_HOST = re.compile(r" -h ([^\s\":]+)(?= |$)")
_LONGEST = 15  # Linux's limit for the name of an interface
_GET_ADDRESS = 0x8915  # SIOCGIFADDR

NO_ADDRESS = "that interface has no address: is it connected?"


def names_of(process: Process, address: str) -> list[str]:
    """The names on which a process listens, besides that of its host, which has this address."""
    endpoints = process.endpoints if process.kind != PROGRAM else ()  # a program listens where it wants
    found = (host for endpoint in endpoints for host in _HOST.findall(endpoint.text))
    return [name for name in dict.fromkeys(found) if name != address and is_name(name)]


def known() -> list[str]:
    """The interfaces of this machine."""
    return [name for _, name in socket.if_nameindex()]


def address_of(name: str) -> str:
    """The address of an interface of this machine, IPv4 first, as Ice prefers it; '' if it has none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked, contextlib.suppress(OSError):
        answer = fcntl.ioctl(asked, _GET_ADDRESS, struct.pack("256s", name.encode()[:_LONGEST]))
        return socket.inet_ntoa(answer[20:24])
    with contextlib.suppress(OSError), open("/proc/net/if_inet6", encoding="ascii") as file:
        for digits, _, _, scope, _, device in map(str.split, file):
            if device == name and scope == "00":  # global
                return str(ipaddress.IPv6Address(bytes.fromhex(digits)))
    return ""


def resolved(network: Network) -> Network:
    """The network with addresses instead of the interfaces on which the processes of this machine listen, also where
    others call them."""
    names = {one.name: names_of(one, network.hosts[one.host].address) for one in network.processes.values()}
    if not any(names.values()):
        return network
    here = {name for name, host in network.hosts.items() if is_here(host)}
    changes, every = dict[tuple[str, int], str](), known()
    for process in network.processes.values():
        found = {name: address_of(name) for name in names[process.name] if process.host in here and name in every}
        ports = [endpoint.port for endpoint in process.endpoints]
        changes |= {(name, port): at for name, at in found.items() for port in (*ports, 0) if at}
    return replace(network, processes={name: _changed(one, changes) for name, one in network.processes.items()})


def _changed(process: Process, changes: Mapping[tuple[str, int], str]) -> Process:
    """With addresses in its endpoints, and where it calls."""
    texts = [process.config.text if process.config else "", *(endpoint.text for endpoint in process.endpoints)]
    own = {key: at for key, at in changes.items() if any(f" -h {key[0]} -p {key[1]}" in text for text in texts)}

    def new(data: Any) -> Any:
        if isinstance(data, dict):
            return {key: new(value) for key, value in data.items()}
        if isinstance(data, list | tuple):
            return [new(value) for value in data]
        return with_address(data, own) if isinstance(data, str) else data

    return msgspec.convert(new(msgspec.to_builtins(process)), Process) if own else process


def with_address(text: str, changes: Mapping[tuple[str, int], str]) -> str:
    """A text with addresses instead of these interfaces with these ports. On an address on which it listens anyway, an
    adapter cannot listen twice."""
    for (name, port), address in changes.items():
        end = f" -p {port}(?![0-9])"
        old, new = f" -h {re.escape(name)}{end}", f" -h {spelled_host(address)} -p {port}"
        for protocol in ("tcp", "ssl") if re.search(f"{re.escape(new)}(?![0-9])", text) else ():
            text = re.sub(f":{protocol}{old}|{protocol}{old}:", "", text)
        text = re.sub(old, new, text)
    return text


def obstacle(spec: ProcessSpec) -> Diagnostic | None:
    """What prevents a process of this machine from listening where it should."""
    every: list[str] = []
    for name in names_of(spec.process, spec.address) if is_near(spec) else ():
        every = every or known()
        if name in every:
            reason = NO_ADDRESS
        else:
            with contextlib.suppress(OSError):
                socket.getaddrinfo(name, None, type=socket.SOCK_STREAM)
                continue
            reason = missing(every)
        return deploying.NO_INTERFACE.at(
            spec.process.span, name=spec.name, listen=name, where="this machine", reason=reason
        )
    return None


def missing(known_ones: list[str]) -> str:
    return f"neither an interface nor an address has this name there; the interfaces are {', '.join(known_ones)}"
