"""The network of the processes that run, for a deployment whose document cannot be read or is gone."""

from __future__ import annotations

import asyncio
import os

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.engines import LOCAL, make_engine
from robocomp_yaml.network.network import FOLDER, Network, NetworkHost


def stand_in(path: str) -> tuple[Network, str] | None:
    """The network of the running processes of the document at a path, as they were started, and its engine. None if no
    process runs, or neither the document nor the user's list of deployments has the name."""
    document, name = os.path.abspath(path), own_folder.deployment_in(path)
    one = registered.of_document(path)
    if one and name in ("", one.name):
        network, engine = Network(one.name, document, one.folder), one.engine
        network.hosts = {host.name: NetworkHost(host.name, host.address, host.user) for host in one.hosts}
    elif name:
        network, engine = Network(name, document, os.path.join(os.path.dirname(document), FOLDER, name)), LOCAL
    else:
        return None
    return (network, engine) if asyncio.run(_fill(network, engine)) else None


async def _fill(network: Network, name: str) -> bool:
    """Adds what runs. Returns whether anything does."""
    engine = make_engine(name, network)
    if not await engine.open(network, create=False):
        return False
    for process, running in (await engine.observe()).items():
        if running.spec:
            spec = running.spec
            network.processes[process] = spec.process
            network.hosts.setdefault(spec.process.host, NetworkHost(spec.process.host, spec.address))
    await engine.close()
    return True
