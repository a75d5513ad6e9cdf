"""Events of a deployment, for all that listen, and as the text that browsers read (server-sent events)."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import AsyncIterator
from typing import Any

import msgspec

STATES, DOCUMENTS, PROGRESS, HAPPENED = "states", "documents", "progress", "happened"
_WAITING = 1000  # events that a listener may be behind
_KEPT = 500  # of what happened
_PULSE = 15.0  # seconds without an event after which a comment shows that the connection lives


class ServerEvent(msgspec.Struct, frozen=True):
    kind: str
    data: Any

    @property
    def text(self) -> str:
        """As in https://html.spec.whatwg.org/multipage/server-sent-events.html; JSON is one line."""
        return f"event: {self.kind}\ndata: {json.dumps(self.data, ensure_ascii=True)}\n\n"


class Events:
    """The events of one deployment. `past` is what happened, the earliest first."""

    def __init__(self) -> None:
        self.past: deque[dict[str, Any]] = deque(maxlen=_KEPT)
        self._listeners: set[asyncio.Queue[ServerEvent | None]] = set()

    @property
    def has_listeners(self) -> bool:
        return bool(self._listeners)

    def send(self, kind: str, data: Any) -> None:
        for queue in list(self._listeners):
            if queue.qsize() >= _WAITING:
                queue.put_nowait(None)  # it reads no more: its connection ends, and a browser connects again
                self._listeners.discard(queue)
            else:
                queue.put_nowait(ServerEvent(kind, data))

    def happened(self, name: str, text: str) -> None:
        """Something happened to a process, or, with the name '', to the deployment."""
        one = {"time": round(time.time(), 3), "name": name, "text": text}
        self.past.append(one)
        self.send(HAPPENED, one)

    def end(self) -> None:
        """Ends all connections."""
        for queue in self._listeners:
            queue.put_nowait(None)

    async def listen(self, *first: ServerEvent) -> AsyncIterator[str]:
        """The texts of these events, and of all that follow."""
        queue: asyncio.Queue[ServerEvent | None] = asyncio.Queue()
        self._listeners.add(queue)
        try:
            for event in first:
                yield event.text
            while True:
                try:
                    found = await asyncio.wait_for(queue.get(), _PULSE)
                except TimeoutError:
                    yield ": still here\n\n"
                    continue
                if found is None:
                    return
                yield found.text
        finally:
            self._listeners.discard(queue)
