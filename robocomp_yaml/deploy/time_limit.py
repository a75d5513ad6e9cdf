"""How long bringing a network up may take, all in all."""

from __future__ import annotations

import time
from collections.abc import Callable

import msgspec


class TimeLimit(msgspec.Struct, frozen=True):
    """So many `seconds` from `began` on, by a clock that nobody sets; without a limit where they are None."""

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
    """Waits for a condition, and looks at it at least once; whether it held within so many seconds."""
    end = time.monotonic() + within
    while not (holds := condition()) and time.monotonic() < end:
        time.sleep(pause)
    return holds
