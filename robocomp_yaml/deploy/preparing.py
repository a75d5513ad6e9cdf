"""From a network as its documents define it to one that can be started: with addresses for names, and with what
protects its processes (the token that controls them, certificates)."""

from __future__ import annotations

import os

from msgspec.structs import replace

from robocomp_yaml.deploy import interfaces, protection
from robocomp_yaml.deploy.here import folder_on
from robocomp_yaml.deploy.own_address import is_name, own_address
from robocomp_yaml.network.network import COMPONENT, ICESTORM, ConfigFile, Network, Process
from robocomp_yaml.source.ice_endpoint import spelled_host
from robocomp_yaml.source.properties import entry_line

_GATE = "PROPERTIES = {}\n"
_NEW = "new"  # what a plan shows, before the certificates exist


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
    return _secured(found, folder, create=create) if network.is_tls else found


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


def _secured(network: Network, folder: str, *, create: bool) -> Network:
    """With the properties for TLS, and with the key and the certificates of its host beside each configuration, below
    `folder`. With `create`, missing certificates are made. Raises OSError."""
    from robocomp_yaml.deploy.authority import Authority, names_at

    authority = Authority(network.folder)
    every, used = network.hosts.values(), sorted({one.host for one in network.processes.values() if one.is_secured})
    hosts = {name: names_at(network, name, own_address(network.hosts[name], every)) for name in used}
    if create:
        authority.make(hosts)
    due = authority.due(hosts)
    pems = {name: _NEW if name in due else authority.pem(name) for name in hosts}
    processes = {
        name: _with_certificate(one, folder_on(network.hosts[one.host], folder), pems[one.host])
        if one.is_secured and one.config
        else one
        for name, one in network.processes.items()
    }
    return replace(network, processes=processes)


def _with_certificate(process: Process, folder: str, pem: str) -> Process:
    from robocomp_yaml.deploy.authority import properties

    config = process.config
    assert config is not None
    made = properties(f"{folder}/{ConfigFile(config.path, '').pem_path}")
    if process.kind in (COMPONENT, ICESTORM):
        lines = "".join(f"{entry_line(key, value)}\n" for key, value in made.items())
        text = f"{config.text.rstrip(os.linesep)}\n{lines}"
    else:
        text = config.text.replace(_GATE, f"PROPERTIES = {made!r}\n", 1)
    return replace(process, config=replace(config, text=text, pem=pem))
