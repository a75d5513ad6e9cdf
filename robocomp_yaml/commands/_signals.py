"""Exit codes of interrupted runs: Ctrl-C (130), SIGTERM (143), and a closed pipe on standard output (141).

While a command runs, both signals raise KeyboardInterrupt, so that it can clean up. Before and after that, they end the
process at once.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

INTERRUPTED, READER_GONE = 128 + signal.SIGINT, 128 + signal.SIGPIPE


class Terminated(KeyboardInterrupt):
    """SIGTERM was received."""


def code_of(error: BaseException | None) -> int:
    """The exit code of a run that this exception interrupted."""
    return 128 + signal.SIGTERM if isinstance(error, Terminated) else INTERRUPTED


@contextmanager
def handled() -> Iterator[None]:
    """In this context, signals raise KeyboardInterrupt; after it, they end the process at once. Ignored signals stay
    ignored, as in background jobs of shell scripts."""
    numbers = [one for one in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(one) is not signal.SIG_IGN]
    try:
        for number in numbers:
            # asyncio recognizes the handler of Python, and cancels its tasks.
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else _terminate)
        yield
    finally:
        for number in numbers:
            signal.signal(number, _end)


@contextmanager
def hangup_handled() -> Iterator[None]:
    """In this context, the end of the terminal raises KeyboardInterrupt, too."""
    before = signal.getsignal(signal.SIGHUP)
    if before is not signal.SIG_IGN:  # nohup
        signal.signal(signal.SIGHUP, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGHUP, before)


def _terminate(number: int, frame: FrameType | None) -> None:
    raise Terminated


def _end(number: int, frame: FrameType | None) -> None:
    os._exit(128 + number)
