"""A deployment whose document cannot be read: what runs of it on this machine can be seen and stopped still."""

from __future__ import annotations

import asyncio
import os

from robocomp_yaml.deploy.folder import deployment_in
from robocomp_yaml.deploy.local import record
from robocomp_yaml.deploy.local.engine import LocalEngine
from robocomp_yaml.network.network import FOLDER, Host, Network


def stand_in(path: str) -> Network | None:
    """The network of what runs, as it was started; None where nothing does, or the document does not even show its
    name."""
    place, name = os.path.abspath(path), deployment_in(path)
    folder = os.path.join(os.path.dirname(place), FOLDER, name)
    if not name or not record.is_there(folder) or record.was_killed(folder):
        return None
    network = Network(name, place, folder)
    asyncio.run(_look(network))
    return network


async def _look(network: Network) -> None:
    engine = LocalEngine()
    if await engine.open(network, create=False):
        for name, running in (await engine.observe()).items():
            if running.spec:
                network.processes[name] = running.spec.process
                network.hosts[running.spec.process.host] = Host(running.spec.process.host)
    await engine.close()
