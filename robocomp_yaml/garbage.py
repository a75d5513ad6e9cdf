"""When Python's collector looks for garbage in cycles."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


def collect_seldom() -> None:
    """For a run that is short, and most of whose objects live until its end."""
    gc.set_threshold(200_000, 20, 100)


def collect_often() -> None:
    """From now on, for a process that lasts: it would otherwise keep 200,000 objects that nobody needs."""
    settle()
    gc.set_threshold(5_000, 10, 10)


def settle() -> None:
    """What is not garbage now stays, so that the collector need not visit it any more."""
    gc.collect()
    gc.freeze()


@contextmanager
def uncollected() -> Iterator[None]:
    """Without the collector, which would visit all kept objects while new ones are made."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
