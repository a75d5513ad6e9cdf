"""The commands of the manager that say what can be changed, and of which types the values are."""

from __future__ import annotations

import asyncio
from typing import Any

from starlette.requests import Request

from robocomp_yaml.manager.access import READ
from robocomp_yaml.manager.commands import ONE, Command, Served


async def _entries(served: Served, request: Request) -> Any:
    return await asyncio.to_thread(served.watcher(request).managed.entries)


async def _process(served: Served, request: Request) -> Any:
    managed = served.watcher(request).managed
    return await asyncio.to_thread(managed.process, request.query_params.get("name", ""))


COMMANDS = (
    Command("GET", f"{ONE}/entries", READ, "The entries with their ports, and what could be added.", _entries),
    Command("GET", f"{ONE}/process", READ, "The types of a process' parameters and of its methods' arguments.",
            _process, query=(("name", "The process."),)),
)  # fmt: skip
