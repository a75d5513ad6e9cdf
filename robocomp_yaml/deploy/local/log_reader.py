"""Reading logs: the last lines of several processes, ordered by time, and all further lines."""

from __future__ import annotations

import asyncio
import heapq
import os
from collections.abc import AsyncGenerator, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import BinaryIO, Protocol

from robocomp_yaml.deploy.engine import Line

_PERIOD = 0.1  # seconds between two reads of logs that are followed
_BLOCK = 1 << 16
_STAMP = len("2026-11-21T10:02:03.123Z")


class LineReader(Protocol):
    """Reads the log of one process. New lines are those after the creation of the reader."""

    def last(self, count: int) -> list[Line]: ...

    def new(self) -> Iterable[Line]: ...


def line_of(name: str, text: str) -> Line:
    return Line(name, text[_STAMP + 1 :], text[:_STAMP])


class LogReader:
    """Reads a log on this machine, across rotations. No file is open between two reads."""

    def __init__(self, folder: str, name: str) -> None:
        self.name, self.path = name, f"{folder}/logs/{name}.log"
        self._rest = b""
        self._inode, self._offset = 0, 0
        with suppress(OSError):
            status = os.stat(self.path)
            self._inode, self._offset = status.st_ino, status.st_size

    def last(self, count: int) -> list[Line]:
        """The last lines before the new ones."""
        lines: list[bytes] = []
        for path, end in ((self.path, self._offset), (f"{self.path}.1", -1)):
            if len(lines) < count and self._inode:
                with suppress(OSError), open(path, "rb") as file:
                    lines = _last_lines(file, end, count - len(lines)) + lines
        return [self._line(line) for line in lines]

    def new(self) -> Iterator[Line]:
        """The lines since the last call."""
        with suppress(OSError), open(self.path, "rb") as file:
            inode = os.fstat(file.fileno()).st_ino
            if inode != self._inode:
                self._rest += self._end_of_older()
                self._inode, self._offset = inode, 0
            file.seek(self._offset)
            text = file.read()
            self._offset += len(text)
            *lines, self._rest = (self._rest + text).split(b"\n")
            yield from map(self._line, lines)

    def _end_of_older(self) -> bytes:
        """The rest of the log that was read before the rotation."""
        with suppress(OSError), open(f"{self.path}.1", "rb") as file:
            if os.fstat(file.fileno()).st_ino == self._inode:
                file.seek(self._offset)
                return file.read()
        return b""

    def _line(self, line: bytes) -> Line:
        return line_of(self.name, line.decode("utf-8", "replace"))


async def merged(
    readers: Sequence[LineReader], last: int, follow: bool, *, is_far: bool = False
) -> AsyncGenerator[Line, None]:
    """The lines of all logs, ordered by time. Lines of one process keep their order, also if the clock was set. With
    `is_far`, logs are read in a thread, because that waits for other hosts."""

    def new() -> list[list[Line]]:
        return [list(reader.new()) for reader in readers]

    parts = [reader.last(last) for reader in readers]
    while True:
        for line in heapq.merge(*parts, key=lambda line: line.time):
            yield line
        if not follow:
            return
        await asyncio.sleep(2 * _PERIOD if is_far else _PERIOD)
        parts = await asyncio.to_thread(new) if is_far else new()


def _last_lines(file: BinaryIO, end: int, count: int) -> list[bytes]:
    """The last complete lines before `end`; -1 is the end of the file."""
    if end < 0:
        end = file.seek(0, os.SEEK_END)
    position, text = end, b""
    while position and text.count(b"\n") <= count:
        position = max(0, position - _BLOCK)
        file.seek(position)
        text = file.read(end - position)
    return text.split(b"\n")[:-1][-count:] if count else []
