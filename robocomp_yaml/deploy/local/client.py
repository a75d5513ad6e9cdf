"""The client of a supervisor: requests and answers over its control socket."""

from __future__ import annotations

import asyncio
import itertools
import json
import socket
from typing import Any

from robocomp_yaml.deploy.local.service import LONGEST


class SupervisorGone(Exception):
    """The supervisor ended, or was killed, while something was asked of it."""


class RequestFailed(Exception):
    """The supervisor could not do what was asked; the text says why, in the operating system's words."""


class Client:
    """A connection; many requests may be under way at once."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        self._numbers = itertools.count()
        self._waiting: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._listener = asyncio.create_task(self._listen())

    @classmethod
    async def over(cls, connection: socket.socket) -> Client:
        return cls(*await asyncio.open_unix_connection(sock=connection, limit=LONGEST))

    async def ask(self, do: str, **facts: object) -> dict[str, Any]:
        """The answer. Raises RequestFailed or SupervisorGone."""
        number = next(self._numbers)
        answer = self._waiting[number] = asyncio.get_running_loop().create_future()
        try:
            self._writer.write(json.dumps({"id": number, "do": do, **facts}).encode() + b"\n")
            await self._writer.drain()
            if self._listener.done():
                raise SupervisorGone
            data: dict[str, Any] = await answer
        except ConnectionError as error:
            raise SupervisorGone from error
        finally:
            self._waiting.pop(number, None)
        if "error" in data:
            raise RequestFailed(data["error"])
        return data

    async def _listen(self) -> None:
        try:
            while line := await self._reader.readline():
                data = json.loads(line)
                answer = self._waiting.get(data["id"])
                if answer and not answer.done():
                    answer.set_result(data)
        except ConnectionError:
            pass
        finally:
            for answer in self._waiting.values():
                if not answer.done():
                    answer.set_exception(SupervisorGone())

    async def wait_closed(self) -> None:
        """Until the supervisor is gone."""
        await asyncio.wait([self._listener])

    async def close(self) -> None:
        self._listener.cancel()
        await asyncio.wait([self._listener])
        self._writer.close()
