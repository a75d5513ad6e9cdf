"""The network of the processes that run, for a deployment whose document cannot be read or is gone."""

from __future__ import annotations

import asyncio
import os

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import history, registered
from robocomp_yaml.deploy.engine import EngineHangs
from robocomp_yaml.deploy.engines import LOCAL, make_engine
from robocomp_yaml.deploy.ownership import NotOwn
from robocomp_yaml.network.network import FOLDER, Network, NetworkHost


def stand_in(path: str) -> tuple[Network, str] | None:
    """The network of the running processes of the document at a path, as they were started, and its engine; without
    one, that of the last `up` that was all ready. The path can also be the deployment's own folder. None if there was
    none, or neither the document nor the user's list of deployments has the name."""
    one = registered.of_folder(path) or registered.of_document(path)
    document, name = os.path.abspath(path), own_folder.deployment_in(path)
    if one and one.folder == document:
        document, name = one.document, one.name
    if one and name in ("", one.name):
        hosts = {known.name: known.host for known in one.hosts}
        network, engine = Network(one.name, document, one.folder, hosts), one.engine
    elif name:
        network, engine = Network(name, document, os.path.join(os.path.dirname(document), FOLDER, name)), LOCAL
    else:
        return None
    running = asyncio.run(_with_processes(network, engine))
    if running is None and (entries := history.read(network.folder)):  # after a power cut
        running = history.network_of(network.name, document, network.folder, entries[-1], network)
    return (running, engine) if running is not None else None


async def _with_processes(network: Network, name: str) -> Network | None:
    """The network with what runs; None if nothing does. What does not answer may still be ended, and that of another
    user is refused later: then it has no processes."""
    engine = make_engine(name, network)
    try:
        if not await engine.open(network, create=False):
            return None
    except (EngineHangs, NotOwn):
        return network
    specs = {process: one.spec for process, one in (await engine.observe()).items() if one.spec}
    await engine.close()
    hosts = {spec.process.host: NetworkHost(spec.process.host, spec.address) for spec in specs.values()}
    processes = {process: spec.process for process, spec in specs.items()}
    return replace(network, hosts={**hosts, **network.hosts}, processes=processes)
