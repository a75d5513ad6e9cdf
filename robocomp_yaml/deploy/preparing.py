"""From a network as its documents define it to one that can be started: with addresses for names, and with what
protects its processes (the token that controls them, certificates)."""

from __future__ import annotations

from msgspec.structs import replace

from robocomp_yaml.deploy import interfaces, protection
from robocomp_yaml.deploy.own_address import is_name, own_address
from robocomp_yaml.network.network import COMPONENT, ICESTORM, Network, Process
from robocomp_yaml.source.ice_endpoint import spelled_host


def prepared(network: Network, *, create: bool) -> Network:
    """The network with all that its configurations need. With `create`, what is missing is made: a token, certificates.
    Raises OSError."""
    return protection.protected(_reachable(network, network.folder, create=create), create=create)


def prepared_for_run(network: Network, folder: str) -> Network:
    """The network for a run in the foreground, whose configurations are in another folder: without a token. Raises
    OSError."""
    return _reachable(network, folder, create=True)


def _reachable(network: Network, folder: str, *, create: bool) -> Network:
    found = interfaces.resolved(_bound(network))
    if not network.is_tls:
        return found
    from robocomp_yaml.deploy.secured import secured

    return secured(found, folder, create=create)


def _bound(network: Network) -> Network:
    """With IP addresses in the endpoints on which processes listen, instead of the names of their hosts."""
    hosts = network.hosts.values()
    named = {one.name: one.address for one in hosts if is_name(one.address)}
    found = {name: own_address(network.hosts[name], hosts) for name in named}
    processes = {
        name: _at(one, named[one.host], found[one.host]) if one.host in named else one
        for name, one in network.processes.items()
    }
    return replace(network, processes=processes)


def _at(process: Process, name: str, address: str) -> Process:
    """If the address is unknown, the process listens on all addresses, and is published by the name of its host."""
    old, new = f" -h {name} ", f" -h {spelled_host(address)} " if address else " "
    config = process.config
    if config is not None and process.kind in (COMPONENT, ICESTORM):
        lines = [_listening(line, old, new) for line in config.text.split("\n")]
        config = replace(config, text="\n".join(lines))
    elif config is not None:
        for one in process.endpoints:  # a gate
            config = replace(config, text=config.text.replace(repr(one.text), repr(one.text.replace(old, new))))
    endpoints = tuple(replace(one, text=one.text.replace(old, new)) for one in process.endpoints)
    return replace(process, config=config, endpoints=endpoints)


def _listening(line: str, old: str, new: str) -> str:
    key, equals, value = line.partition("=")
    key = key.strip()
    is_it = key.endswith(".Endpoints") or key.startswith("Endpoints.")
    return f"{key}{equals}{value.replace(old, new)}" if is_it and old in f"{value} " else line
