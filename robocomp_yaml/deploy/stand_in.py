"""A deployment whose document cannot be read: what runs of it on this machine can be seen and stopped still."""

from __future__ import annotations

import asyncio
import os
import re

from robocomp_yaml.deploy.local import record
from robocomp_yaml.deploy.local.engine import LocalEngine
from robocomp_yaml.network.network import FOLDER, Host, Network
from robocomp_yaml.source.heading import root_of, text_at_top

_NAME = re.compile(r"""^["']?deployment["']?[ \t]*:[ \t]*["']?([_A-Za-z][-A-Za-z0-9_]*)""", re.MULTILINE)


def stand_in(path: str) -> Network | None:
    """The network of what runs, as it was started; None where nothing does, or the document does not even show its
    name."""
    name = _name(path)
    place = os.path.abspath(path)
    folder = os.path.join(os.path.dirname(place), FOLDER, name)
    if not name or not record.is_there(folder) or record.was_killed(folder):
        return None
    network = Network(name, place, folder)
    asyncio.run(_look(network))
    return network


def _name(path: str) -> str:
    """The deployment's name; where the document is no YAML (any more), what looks like it."""
    said = text_at_top(root_of(path), "deployment")
    if said:
        return said if _NAME.fullmatch(f"deployment: {said}") else ""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            found = _NAME.search(file.read())
    except OSError:
        return ""
    return found[1] if found else ""


async def _look(network: Network) -> None:
    engine = LocalEngine()
    if await engine.open(network, create=False):
        for name, running in (await engine.observe()).items():
            if running.spec:
                network.processes[name] = running.spec.process
                network.hosts[running.spec.process.host] = Host(running.spec.process.host)
    await engine.close()
