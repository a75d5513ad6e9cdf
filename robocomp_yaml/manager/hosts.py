"""The commands of the manager about hosts: what a host has of the network, and bringing it what it lacks."""

from __future__ import annotations

import asyncio
from typing import Any

from starlette.requests import Request

from robocomp_yaml.manager.access import OPERATE, READ
from robocomp_yaml.manager.commands import ONE, Command, Served, body_of, reading
from robocomp_yaml.manager.events import PROGRESS
from robocomp_yaml.manager.requests import PushRequest


async def _push(served: Served, request: Request) -> Any:
    wanted, watcher = await body_of(request, PushRequest), served.watcher(request)
    events, loop = watcher.events, asyncio.get_running_loop()

    def report(host: str, path: str) -> None:
        loop.call_soon_threadsafe(events.send, PROGRESS, {"action": "push", "host": host, "path": path})

    events.happened("", f"push {' '.join(wanted.hosts)}".rstrip())
    done = await asyncio.to_thread(watcher.managed.push, wanted.hosts, report)
    events.happened("", f"push: {'done' if done['ok'] else 'failed'}")
    return done


COMMANDS = (
    Command("GET", f"{ONE}/availability", READ, "Which processes a host could run, and what it lacks for each.",
            reading(lambda managed, query: managed.available(query.get("host", ""))), query=(("host", "The name of the host."),)),
    Command("POST", f"{ONE}/push", OPERATE, "Bring to hosts what their processes need.", _push, PushRequest),
)  # fmt: skip
