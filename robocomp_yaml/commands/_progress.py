"""Progress of a deployment: on a terminal a line for each process that is busy, else a line for each that is done."""

from __future__ import annotations

import asyncio
import shutil
import sys
import time
from collections.abc import Collection
from types import TracebackType

from robocomp_yaml.deploy.carry_out import FAILED, GONE, READY, SKIPPED, STARTING, STOPPING, Event
from robocomp_yaml.diag import terminal

_PERIOD = 0.1
_COLORS = {READY: "32", GONE: "32", FAILED: "31", SKIPPED: "33"}
_SHORT = 0.05  # seconds that are not worth telling


class Progress:
    """Use it as a context around a call; `report` takes its events, `pause` leaves the terminal to others until the
    next one."""

    def __init__(self, shown: bool, color: bool, names: Collection[str]) -> None:
        self._shown, self._color = shown, color
        self._is_live = shown and sys.stdout.isatty()
        self._width = max(map(terminal.columns, names), default=0)
        self._busy: dict[str, tuple[str, float]] = {}
        self._drawn = 0
        self._ticker: asyncio.Task[None] | None = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._ticker:
            self._ticker.cancel()
        self._busy.clear()
        self.pause()

    def report(self, event: Event) -> None:
        if self._is_live and self._ticker is None:
            self._ticker = asyncio.create_task(self._tick())  # it ends with the loop, if not before
        if event.kind in (STARTING, STOPPING):
            self._busy[event.name] = (event.kind, time.monotonic())
        else:
            self._busy.pop(event.name, None)
            self.pause()
            if self._shown:
                terminal.say(self._line(event.name, event.kind, event.seconds, self._color))
        self._draw()

    def pause(self) -> None:
        """Takes away what is drawn of the busy ones."""
        if self._drawn:
            terminal.erase(self._drawn)
            self._drawn = 0

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(_PERIOD)
            if self._busy and self._drawn:
                self._draw()

    def _draw(self) -> None:
        if not self._is_live:
            return
        self.pause()
        room = max(1, shutil.get_terminal_size().lines - 2)
        now = time.monotonic()
        columns = shutil.get_terminal_size().columns - 1  # a line that wraps would be two to take away
        busy = list(self._busy.items())[:room]
        lines = [terminal.cut(self._line(name, kind, now - since), columns) for name, (kind, since) in busy]
        if len(self._busy) > room:
            lines[-1] = terminal.shown(f"and {len(self._busy) - room + 1} more")
        terminal.say(*lines)
        self._drawn = len(lines)

    def _line(self, name: str, kind: str, seconds: float, color: bool = False) -> terminal.Shown:
        """Seconds are for those who watch; a file of output is the same each time."""
        word = terminal.paint(kind, _COLORS.get(kind, ""), color and kind in _COLORS)
        took = f"  {seconds:.1f} s" if self._is_live and seconds > _SHORT else ""
        return terminal.line(terminal.pad(name, self._width), "  ", word, took)
