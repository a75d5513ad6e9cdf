"""Logs read back: the last lines of several processes in the order of their times, and those that come."""

from __future__ import annotations

import asyncio
import heapq
import os
from collections.abc import AsyncGenerator, Iterator, Sequence
from typing import BinaryIO

from robocomp_yaml.deploy.engine import Line

_PERIOD = 0.1  # seconds between two looks at logs that are followed
_BLOCK = 1 << 16
_STAMP = len("2026-11-21T10:02:03.123Z")


class LogReader:
    """One process's log, read from where it ends when this is made, across rotations."""

    def __init__(self, folder: str, name: str) -> None:
        self.name, self.path = name, f"{folder}/logs/{name}.log"
        self._rest = b""
        self._file = self._open()
        if self._file:
            self._file.seek(0, os.SEEK_END)

    def last(self, count: int) -> list[Line]:
        """The last lines before the place from which it is read on."""
        if count <= 0 or not self._file:
            return []
        lines = _last_lines(self._file, count)
        if len(lines) < count:
            try:
                with open(f"{self.path}.1", "rb") as older:
                    older.seek(0, os.SEEK_END)
                    lines = _last_lines(older, count - len(lines)) + lines
            except OSError:
                pass
        return [self._line(line) for line in lines]

    def new(self) -> Iterator[Line]:
        """The lines that came since the last call."""
        while True:
            file, self._file = self._file, None
            if file is None:
                file = self._open()
                if file is None:
                    return
            text = self._rest + file.read()
            *lines, self._rest = text.split(b"\n")
            yield from map(self._line, lines)
            self._file = file
            if not self._was_replaced(file):
                return
            file.close()
            self._file = None

    def close(self) -> None:
        if self._file:
            self._file.close()

    def _was_replaced(self, file: BinaryIO) -> bool:
        try:
            return not os.path.samestat(os.fstat(file.fileno()), os.stat(self.path))
        except FileNotFoundError:
            return False

    def _open(self) -> BinaryIO | None:
        try:
            return open(self.path, "rb")  # noqa: SIM115 (closed by `close`, or when it was replaced)
        except OSError:
            return None

    def _line(self, line: bytes) -> Line:
        text = line.decode("utf-8", "replace")
        return Line(self.name, text[_STAMP + 1 :], text[:_STAMP])


async def merged(readers: Sequence[LogReader], last: int, follow: bool) -> AsyncGenerator[Line, None]:
    """The lines of all, by time; those of one process always in their own order, whatever the clock did."""
    try:
        for line in _by_time([reader.last(last) for reader in readers]):
            yield line
        while follow:
            for line in _by_time([list(reader.new()) for reader in readers]):
                yield line
            await asyncio.sleep(_PERIOD)
    finally:
        for reader in readers:
            reader.close()


def _by_time(parts: Sequence[Sequence[Line]]) -> Iterator[Line]:
    return heapq.merge(*parts, key=lambda line: line.time)


def _last_lines(file: BinaryIO, count: int) -> list[bytes]:
    """The last whole lines before the file's position, which stays."""
    end = position = file.tell()
    text = b""
    while position and text.count(b"\n") <= count:
        position = max(0, position - _BLOCK)
        file.seek(position)
        text = file.read(end - position)
    file.seek(end)
    return text.split(b"\n")[:-1][-count:]
