"""The logs of processes on other hosts, read through their IceGrid nodes."""

from __future__ import annotations

import asyncio
import heapq
from collections.abc import AsyncGenerator, Iterable, Sequence
from typing import Protocol

from robocomp_yaml.deploy.engine import Line
from robocomp_yaml.deploy.icegrid.grid import Grid, GridFailed

_PERIOD = 0.2  # seconds between two looks at logs that are followed
_STAMP = len("2026-11-21T10:02:03.123Z")


class Reader(Protocol):
    """What reads one process's log from where it was when this was made."""

    def last(self, count: int) -> list[Line]: ...

    def new(self) -> Iterable[Line]: ...


class GridReader:
    """The log of a process on another host. What is written while its node does not answer is read later."""

    def __init__(self, grid: Grid, name: str, path: str) -> None:
        self.name, self._grid, self._path = name, grid, path
        self._seen = self._lines()

    def last(self, count: int) -> list[Line]:
        return [self._line(text) for text in self._seen[-count:]] if count > 0 else []

    def new(self) -> list[Line]:
        lines = self._lines()
        is_same_file = lines[:1] == self._seen[:1] and len(lines) >= len(self._seen)
        fresh = lines[len(self._seen) :] if is_same_file else lines
        self._seen = lines or self._seen
        return [self._line(text) for text in fresh] if lines else []

    def _lines(self) -> list[str]:
        try:
            return [line for line in self._grid.read(self.name, self._path) if line]
        except GridFailed:
            return []

    def _line(self, text: str) -> Line:
        return Line(self.name, text[_STAMP + 1 :], text[:_STAMP])


async def merged(readers: Sequence[Reader], last: int, follow: bool) -> AsyncGenerator[Line, None]:
    """The lines of all, by time as their hosts tell it; the calls that wait do so beside the event loop."""
    for line in heapq.merge(*(reader.last(last) for reader in readers), key=lambda line: line.time):
        yield line
    while follow:
        parts = await asyncio.to_thread(lambda: [list(reader.new()) for reader in readers])
        for line in heapq.merge(*parts, key=lambda line: line.time):
            yield line
        await asyncio.sleep(_PERIOD)
