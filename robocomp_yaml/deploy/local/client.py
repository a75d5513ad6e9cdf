"""The client of a supervisor: it connects to one or starts one, and sends requests over the control socket."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import os
import socket
import subprocess
import sys
from typing import Any

import msgspec

from robocomp_yaml.deploy import registered
from robocomp_yaml.deploy.local import channel, procfs, record
from robocomp_yaml.deploy.local.channel import LONGEST, RESTORE

_LINES = 10
_SPACE = 4096  # bytes
_PATIENCE = 20.0  # seconds: far more than is needed, also on a busy machine


class SupervisorGone(Exception):
    """The supervisor ended, or was killed, during a request."""


class RequestFailed(Exception):
    """A request failed; the text is the reason, in the operating system's words."""


class Client:
    """A connection. Many requests can be pending at a time."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        self._numbers = itertools.count()
        self._waiting: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._listener = asyncio.create_task(self._listen())

    @classmethod
    async def over(cls, connection: socket.socket) -> Client:
        return cls(*await asyncio.open_unix_connection(sock=connection, limit=LONGEST))

    async def hello(self) -> dict[str, Any]:
        """What the supervisor says of itself, which takes no time. Raises TimeoutError if it hangs, RequestFailed or
        SupervisorGone."""
        async with asyncio.timeout(_PATIENCE):
            return await self._answer("hello")

    async def ask(self, do: str, **facts: object) -> dict[str, Any]:
        """The answer to a request. Raises TimeoutError if the supervisor hangs, RequestFailed or SupervisorGone."""
        answer = asyncio.ensure_future(self._answer(do, **facts))
        try:
            while not (await asyncio.wait([answer], timeout=_PATIENCE))[0]:
                await self.hello()
            return answer.result()
        finally:
            answer.cancel()

    async def _answer(self, do: str, **facts: object) -> dict[str, Any]:
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
                data = msgspec.json.decode(line)
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
        """Waits until the supervisor has ended. Raises TimeoutError if it hangs."""
        with contextlib.suppress(SupervisorGone):
            while not (await asyncio.wait([self._listener], timeout=_PATIENCE))[0]:
                await self.hello()

    async def close(self) -> None:
        self._listener.cancel()
        await asyncio.wait([self._listener])
        self._writer.close()


def reach(folder: str) -> socket.socket | None:
    """A connection to the supervisor, None if none runs. Raises TimeoutError if it hangs, and another OSError if the
    folder cannot be opened."""
    return channel.connect(f"{folder}/state", _PATIENCE) if os.path.isdir(f"{folder}/state") else None


async def revived(folder: str) -> socket.socket | None:
    """A connection to a supervisor whose folder was deleted: it writes the folder again. None if none runs."""
    one = registered.of_folder(folder)
    if one is None or not one.is_supervised:
        return None
    os.kill(one.supervisor, RESTORE)
    for _ in range(int(_PATIENCE / 0.02)):
        if connection := reach(folder):
            return connection
        await asyncio.sleep(0.02)
    return None


def last_words(folder: str) -> list[str]:
    """The last lines of the supervisor's own log, which is empty without errors."""
    try:
        with open(f"{folder}/state/supervisor.log", encoding="utf-8", errors="replace") as file:
            return file.read().splitlines()[-_LINES:]
    except OSError:
        return []


async def start(folder: str, *, tied: bool = False) -> socket.socket:
    """A connection to a new supervisor, which ends with this process if it is `tied` to it. Raises OSError with the
    last lines of its log if it does not start."""
    package = os.path.abspath(f"{__file__}/../../../..")
    environment = {**os.environ, procfs.MARK: f"{folder}:"}
    environment["PYTHONPATH"] = os.pathsep.join([package, *filter(None, [environment.get("PYTHONPATH")])])
    # Without site-packages: it uses only the standard library.
    command = [sys.executable, "-S", "-m", "robocomp_yaml.deploy.local.supervisor", folder]
    log = os.open(f"{folder}/state/supervisor.log", os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
    try:
        os.write(log, bytes(_SPACE))  # on a full disk, this fails here, and not in the supervisor
        os.ftruncate(log, 0)
        os.lseek(log, 0, os.SEEK_SET)
        # It goes on when this process ends, which therefore does not wait for it.
        keeper = subprocess.Popen(
            [*command, str(os.getpid())] if tied else command,
            cwd="/", env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
        )  # fmt: skip
        for _ in range(int(_PATIENCE / 0.02)):
            if connection := reach(folder):
                keeper.returncode = 0
                return connection
            if keeper.poll() is not None:
                break
            await asyncio.sleep(0.02)
        keeper.kill()
        keeper.wait()
        raise OSError(0, f"the supervisor does not start: {' '.join(last_words(folder))}")
    finally:
        os.close(log)


async def wait_gone(folder: str) -> None:
    """Waits until the supervisor has removed its record."""
    for _ in range(int(_PATIENCE / 0.02)):
        if not record.is_there(folder):
            return
        await asyncio.sleep(0.02)
