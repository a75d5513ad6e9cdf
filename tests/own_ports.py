"""What other programs of this machine do is nothing to a test: the ports that they have are free to it."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Collection
from pathlib import Path
from typing import Any

import pytest

from robocomp_yaml.deploy.local import procfs


def only(folder: Path | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of all that listens, only what this process started is seen, or a deployment in this folder; without one,
    nothing is, and nobody looks."""
    listeners, connect = procfs.listeners, asyncio.open_connection
    here = os.path.realpath(folder or "")

    def own_listeners(ports: Collection[int]) -> dict[int, list[int]]:
        if folder is None:
            return {}
        found = listeners(ports)
        alive = procfs.table() if found else {}
        deployed = [pid for pid in alive if procfs.mark_of(pid).startswith(here)]
        own = procfs.descendants([os.getpid(), *deployed], alive)
        return {port: pids for port, pids in found.items() if own & set(pids)}

    async def connect_to_own(*address: Any, **how: Any) -> Any:
        _, port = address or how["sock"].getpeername()
        if not own_listeners([port]):
            raise ConnectionRefusedError
        return await connect(*address, **how)

    monkeypatch.setattr(procfs, "listeners", own_listeners)
    monkeypatch.setattr(asyncio, "open_connection", connect_to_own)
