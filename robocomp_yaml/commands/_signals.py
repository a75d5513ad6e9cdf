"""How a run ends that somebody ends: Ctrl-C (130), SIGTERM (143), and a reader of its output that had enough (141).

While a command works, both signals raise KeyboardInterrupt, so that what it began is put back; before and after, they
end the process at once.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

INTERRUPTED, READER_GONE = 128 + signal.SIGINT, 128 + signal.SIGPIPE


class Terminated(KeyboardInterrupt):
    """Somebody asked the process to end with SIGTERM."""


def code_of(error: BaseException | None) -> int:
    """The exit code of a run that this interrupted."""
    return 128 + signal.SIGTERM if isinstance(error, Terminated) else INTERRUPTED


@contextmanager
def handled() -> Iterator[None]:
    """Signals raise KeyboardInterrupt in here, and end the process at once from then on. One that is ignored stays so,
    as of what a script runs in the background."""
    numbers = [one for one in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(one) is not signal.SIG_IGN]
    try:
        for number in numbers:
            # That of Python is known to asyncio, which cancels what it runs.
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else _terminate)
        yield
    finally:
        for number in numbers:
            signal.signal(number, _end)


def _terminate(number: int, frame: FrameType | None) -> None:
    raise Terminated


def _end(number: int, frame: FrameType | None) -> None:
    os._exit(128 + number)
