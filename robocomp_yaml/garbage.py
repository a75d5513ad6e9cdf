"""When Python's collector looks for garbage in cycles."""

from __future__ import annotations

import gc


def collect_seldom() -> None:
    """For a run that is short, and most of whose objects live until its end."""
    gc.set_threshold(200_000, 20, 100)


def collect_often() -> None:
    """From now on, for a process that lasts: it would otherwise keep 200,000 objects that nobody needs. What there is
    now stays, and is not visited any more."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(5_000, 10, 10)
