"""Which hosts are this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.network.network import LOOPBACK, Network, NetworkHost, is_loopback

if TYPE_CHECKING:
    from robocomp_yaml.deploy.spec import ProcessSpec


def is_local(address: str) -> bool:
    """Whether an address is one of this machine: only those can be bound. False if it cannot be resolved."""
    if address == LOOPBACK:
        return True
    import socket  # most deployments are on one machine

    try:
        family, kind, protocol, _, target = socket.getaddrinfo(address, 0, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as probe:
            probe.bind(target)
    except OSError:
        return False
    return True


def is_here(host: NetworkHost) -> bool:
    """Whether a host is this machine."""
    return not is_behind(host) and is_local(host.address)


def local_host(network: Network) -> str:
    """The name of a used host that is this machine, or ''."""
    used = {process.host for process in network.enabled()}
    return next((host.name for host in network.hosts.values() if host.name in used and is_here(host)), "")


def is_behind(host: NetworkHost) -> bool:
    """Whether a host is another machine, which ssh reaches at a port of this one: a container, a virtual machine, or
    the end of a tunnel."""
    return is_loopback(host.address) and bool(host.ssh.port or host.ssh.jump)


def is_near(spec: ProcessSpec) -> bool:
    """Whether a process runs on this machine."""
    return not spec.is_behind and is_local(spec.address)


def folder_on(host: NetworkHost, folder: str) -> str:
    """The path on a host of a folder of this machine."""
    return folder if not host.folders or is_here(host) else host.there(folder)
