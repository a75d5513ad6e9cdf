"""Progress on a terminal: lines that are redrawn. Of a deployment: a line for each busy process, and on other outputs a
line for each finished process."""

from __future__ import annotations

import asyncio
import shutil
import sys
import time
from collections.abc import Collection
from typing import Self

from robocomp_yaml.deploy.carry_out import FAILED, GONE, READY, SKIPPED, STARTING, STOPPING, UNCHANGED, ProcessEvent
from robocomp_yaml.diag import terminal

_PERIOD = 0.1
_COLORS = {READY: "32", GONE: "32", FAILED: "31", SKIPPED: "33", UNCHANGED: "33"}
_SHORT = 0.05  # seconds: shorter durations are not shown


class LiveLines:
    """Lines at the end of a terminal, which the next lines replace. A context manager; `pause` removes the lines until
    the next `draw`."""

    def __init__(self, shown: bool) -> None:
        self.is_live = shown and sys.stdout.isatty()
        self.drawn = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.pause()

    def pause(self) -> None:
        """Removes the drawn lines."""
        if self.drawn:
            terminal.erase(self.drawn)
            self.drawn = 0

    def draw(self, lines: Collection[str]) -> None:
        """Draws lines instead of the drawn ones. They are cut: a wrapped line could not be removed."""
        if self.is_live:
            self.pause()
            columns = shutil.get_terminal_size().columns - 1
            terminal.say(*(terminal.cut(line, columns) for line in lines))
            self.drawn = len(lines)


class Progress(LiveLines):
    """The progress of a deployment; `report` gets the events of a call."""

    def __init__(self, shown: bool, color: bool, names: Collection[str]) -> None:
        super().__init__(shown)
        self._shown, self._color = shown, color
        self._width = max(map(terminal.columns, names), default=0)
        self._busy: dict[str, tuple[str, float]] = {}
        self._ticker: asyncio.Task[None] | None = None

    def __exit__(self, *_: object) -> None:
        if self._ticker:
            self._ticker.cancel()
        self._busy.clear()
        self.pause()

    def report(self, event: ProcessEvent) -> None:
        if self.is_live and self._ticker is None:
            self._ticker = asyncio.create_task(self._tick())  # it ends with the event loop
        if event.kind in (STARTING, STOPPING):
            self._busy[event.name] = (event.kind, time.monotonic())
        else:
            self._busy.pop(event.name, None)
            self.pause()
            if self._shown:
                terminal.say(self._line(event.name, event.kind, event.seconds, self._color))
        self._draw_busy()

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(_PERIOD)
            if self._busy and self.drawn:
                self._draw_busy()

    def _draw_busy(self) -> None:
        if not self.is_live:
            return
        room = max(1, shutil.get_terminal_size().lines - 2)
        now = time.monotonic()
        lines = [self._line(name, kind, now - since) for name, (kind, since) in list(self._busy.items())[:room]]
        if len(self._busy) > room:
            lines[-1] = terminal.shown(f"and {len(self._busy) - room + 1} more")
        self.draw(lines)

    def _line(self, name: str, kind: str, seconds: float, color: bool = False) -> terminal.Shown:
        """The line of a process. Seconds are shown on a terminal only, so that the output in files is reproducible."""
        word = terminal.paint(kind, _COLORS.get(kind, ""), color and kind in _COLORS)
        took = f"  {seconds:.1f} s" if self.is_live and seconds > _SHORT else ""
        return terminal.line(terminal.pad(name, self._width), "  ", word, took)
