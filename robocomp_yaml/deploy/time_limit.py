"""Time limits: of a whole operation, and of a wait for a condition."""

from __future__ import annotations

import time
from collections.abc import Callable

import msgspec


class TimeLimit(msgspec.Struct, frozen=True):
    """A limit of `seconds` from the time `began`, by a monotonic clock; None is no limit."""

    seconds: float | None = None
    began: float = msgspec.field(default_factory=time.monotonic)

    @property
    def left(self) -> float | None:
        return None if self.seconds is None else max(0.0, self.began + self.seconds - time.monotonic())

    @property
    def is_over(self) -> bool:
        return self.left == 0.0

    def __str__(self) -> str:
        return f"{self.seconds:g}"


def until(condition: Callable[[], bool], within: float, pause: float = 0.01) -> bool:
    """Waits until a condition holds, and returns whether it did `within` seconds. It is checked at least once, with a
    `pause` in seconds between two checks."""
    end = time.monotonic() + within
    while not (holds := condition()) and time.monotonic() < end:
        time.sleep(pause)
    return holds
