"""Whether the supervisor's children answer while they run: each is asked again and again, over one connection."""

from __future__ import annotations

import asyncio
import struct
from contextlib import suppress
from typing import NamedTuple

from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.local.child import ChildProcess
from robocomp_yaml.deploy.states import RUNNING
from robocomp_yaml.wire import tls
from robocomp_yaml.wire.protocol import OK, Connection, Reply

AUTO, FOREVER = -1.0, 0.0
"""Instead of a time: the worker may show no life for ten periods, at least SILENCE seconds; or for any time."""

SILENCE, PERIODS = 10.0, 10

_AT_START = 0.5  # seconds between two questions until the first answer
_START, _READY = 60.0, 3  # see `deploy.liveness`, which the supervisor does not import
_LATE = 1.0  # seconds: if the supervisor itself was halted for so long, the other processes were, too


class Question(NamedTuple):
    """The address of an object, and the message of the call that it must answer; `pem` is the file with the key and
    the certificates for TLS, or ''."""

    host: str
    port: int
    message: bytes
    pem: str = ""


class AliveWatch:
    """Asks one child until it is cancelled. What has not answered since its start is not missed for a while: it may
    still load its libraries."""

    def __init__(self, child: ChildProcess, question: Question) -> None:
        self._child, self._question = child, question
        self._connection: Connection | None = None
        self._loop = asyncio.get_running_loop()
        self._pid = 0
        self._misses = 0
        self._has_answered = False
        self._patient_until = 0.0

    async def run(self) -> None:
        try:
            due = self._loop.time()
            while alive := self._child.spec["process"].get("alive"):
                pause = alive["every"] if self._has_answered else min(alive["every"], _AT_START)
                due = max(due, self._loop.time() - pause) + pause
                await asyncio.sleep(max(0.0, due - self._loop.time()))
                was_halted = self._loop.time() - due > _LATE
                if self._child.state == RUNNING:
                    await self._look(alive, is_reliable=not was_halted)
        finally:
            self._close()

    async def _look(self, alive: dict[str, float], *, is_reliable: bool) -> None:
        pid = self._child.pid
        if pid != self._pid:
            self._pid, self._misses, self._has_answered, self._patient_until = pid, 0, False, 0.0
            self._close()
        reply = await self._reply(alive["within"])
        if pid != self._child.pid or self._child.state != RUNNING or not is_reliable:
            return
        if reply is not None:
            self._has_answered, self._misses = True, 0
            why = self._silence(reply, alive["worker"])
        else:
            self._misses += self._has_answered or self._is_late()
            why = "it does not answer" if self._misses >= alive["misses"] else ""
        if why and procfs.is_traced(self._child.family()):
            why, self._misses = "", 0  # a debugger halts it
            self._patient_until = self._loop.time() + max(SILENCE, alive["worker"])
        self._child.note_alive(why)
        if why and alive["restarts"]:
            with suppress(TimeoutError):  # it hangs in the kernel
                await self._child.replace()

    def _is_late(self) -> bool:
        """Whether a process should have answered long ago."""
        within: float = self._child.spec["process"]["ready"]["within"]
        return self._loop.time() - self._child.since > max(_START, _READY * within)

    def _silence(self, reply: Reply, limit: float) -> str:
        """Why a process that answers is not alive, or ''. A program without a heartbeat has answered all the same."""
        if limit == FOREVER or reply.status != OK or len(reply.result) < 8 or self._loop.time() < self._patient_until:
            return ""
        age, period = (milliseconds / 1000 for milliseconds in struct.unpack_from("<ii", reply.result))
        if age <= (max(PERIODS * period, SILENCE) if limit == AUTO else limit):
            return ""
        return f"its worker has shown no life for {age:.0f} s"

    async def _reply(self, within: float) -> Reply | None:
        """The answer within so many seconds. A connection that the other end has closed is opened again."""
        host, port, message, pem = self._question
        try:
            async with asyncio.timeout(within):
                if self._connection is not None:
                    try:
                        return await self._connection.answer(message)
                    except OSError:
                        self._close()
                self._connection = await Connection.open(host, port, tls.of_file(pem) if pem else None)
                return await self._connection.answer(message)
        except (OSError, struct.error):
            self._close()
            return None

    def _close(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None
