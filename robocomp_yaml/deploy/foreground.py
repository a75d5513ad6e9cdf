"""A process in the foreground: it has the terminal of this process, gets its signals, and never outlives it."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress

from robocomp_yaml.deploy.engine import STOP_WITHIN
from robocomp_yaml.deploy.local import procfs, program
from robocomp_yaml.deploy.local.kernel import death_with_this, tie

_NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_TWICE = 0.3  # seconds in which a repeated signal counts as one: some tools signal a group and each process in it
_PATIENCE = 2.0  # seconds that a process has to end after an interruption, before it gets SIGTERM


class Interruptions:
    """The signals that this process receives and that ask it to end. `numbers` has them in their order."""

    def __init__(self) -> None:
        self.numbers: list[int] = []
        self._when = 0.0
        self._event = asyncio.Event()

    @property
    def count(self) -> int:
        return len(self.numbers)

    @contextmanager
    def caught(self) -> Iterator[None]:
        """While the context lasts, these signals end nothing by themselves. Ignored ones stay ignored."""
        loop, before = asyncio.get_running_loop(), {number: signal.getsignal(number) for number in _NUMBERS}
        caught = [number for number in _NUMBERS if before[number] is not signal.SIG_IGN]
        for number in caught:
            loop.add_signal_handler(number, self._note, number)
        try:
            yield
        finally:
            for number in caught:
                loop.remove_signal_handler(number)
                signal.signal(number, before[number])

    def _note(self, number: int) -> None:
        now = time.monotonic()
        if not self.numbers or now > self._when + _TWICE:
            self.numbers.append(number)
            self._when = now
            self._event.set()
            self._event = asyncio.Event()

    async def more_than(self, count: int) -> None:
        """Waits until there are more than so many."""
        while self.count <= count:
            await self._event.wait()


class Foreground:
    """A process in the foreground. `mark` is that of its family (see `procfs.MARK`)."""

    def __init__(self, child: asyncio.subprocess.Process, mark: str) -> None:
        self._child, self._mark = child, mark

    @classmethod
    async def start(
        cls, command: Sequence[str], folder: str, environment: Mapping[str, str], mark: str
    ) -> Foreground:  # fmt: skip
        """Starts a command. Raises OSError."""
        found = program.find(command[0], folder, environment)
        child = await asyncio.create_subprocess_exec(
            *tie(), found, *command[1:], cwd=folder or "/", env={**environment, procfs.MARK: mark},
            preexec_fn=None if tie() else death_with_this(),
        )  # fmt: skip
        return cls(child, mark)

    @property
    def pid(self) -> int:
        return self._child.pid

    async def wait(self) -> int:
        """The exit code; that of a signal is negative. What is left of its family is killed."""
        code = await self._child.wait()
        self._kill_family()
        return code

    async def stop(self, interruptions: Interruptions) -> int:
        """Ends the process, and returns its exit code. It gets the signal that interrupted this process, or SIGTERM
        without one; after a while SIGTERM, and in the end SIGKILL, which the next interruption sends at once."""
        first = interruptions.numbers[0] if interruptions.count else signal.SIGTERM
        if first != signal.SIGINT or not _has_terminal():  # the terminal has sent its signal to the process, too
            self._send(first)
        steps = [(_PATIENCE, signal.SIGTERM)] if first != signal.SIGTERM else []
        ended, count = asyncio.create_task(self.wait()), interruptions.count
        for seconds, number in (*steps, (STOP_WITHIN, signal.SIGKILL)):
            again = asyncio.create_task(interruptions.more_than(count))
            await asyncio.wait((ended, again), timeout=seconds, return_when=asyncio.FIRST_COMPLETED)
            again.cancel()
            if ended.done():
                break
            if again.done() or number == signal.SIGKILL:
                self._kill_family()
                break
            self._send(number)
        return await ended

    def _send(self, number: int) -> None:
        with suppress(ProcessLookupError):
            self._child.send_signal(number)

    def _kill_family(self) -> None:
        for pid in [*procfs.pids()]:
            if procfs.mark_of(pid) == self._mark:
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)


def _has_terminal() -> bool:
    """Whether this process is in the group to which the terminal sends the signal of Ctrl-C."""
    try:
        terminal = os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        return os.tcgetpgrp(terminal) == os.getpgrp()
    except OSError:
        return False
    finally:
        os.close(terminal)
