"""A network with `security: tls`: each process has the properties for TLS, and the certificate of its host."""

from __future__ import annotations

import os

from msgspec.structs import replace

from robocomp_yaml.deploy.authority import Authority, names_at, properties
from robocomp_yaml.deploy.here import folder_on
from robocomp_yaml.deploy.own_address import own_address
from robocomp_yaml.network.network import COMPONENT, ICESTORM, ConfigFile, Network, Process
from robocomp_yaml.source.properties import entry_line

_GATE = "PROPERTIES = {}\n"
_NEW = "new"  # what a plan shows, before the certificates exist


def secured(network: Network, folder: str, *, create: bool) -> Network:
    """With the properties for TLS, and with the key and the certificates of its host beside each configuration, below
    `folder`. With `create`, missing certificates are made. Raises OSError."""
    authority = Authority(network.folder)
    every, used = network.hosts.values(), sorted({one.host for one in network.processes.values() if one.is_secured})
    hosts = {name: names_at(network, name, own_address(network.hosts[name], every)) for name in used}
    if create:
        authority.make(hosts)
    due = authority.due(hosts)
    pems = {name: _NEW if name in due else authority.pem(name) for name in hosts}
    processes = {
        name: _with(one, folder_on(network.hosts[one.host], folder), pems[one.host])
        if one.is_secured and one.config
        else one
        for name, one in network.processes.items()
    }
    return replace(network, processes=processes)


def _with(process: Process, folder: str, pem: str) -> Process:
    config = process.config
    assert config is not None
    made = properties(f"{folder}/{ConfigFile(config.path, '').pem_path}")
    if process.kind in (COMPONENT, ICESTORM):
        lines = "".join(f"{entry_line(key, value)}\n" for key, value in made.items())
        text = f"{config.text.rstrip(os.linesep)}\n{lines}"
    else:
        text = config.text.replace(_GATE, f"PROPERTIES = {made!r}\n", 1)
    return replace(process, config=replace(config, text=text, pem=pem))
