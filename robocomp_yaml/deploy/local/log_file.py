"""The log of one process: lines with their times, in files of limited size. A full disk loses lines, nothing else."""

from __future__ import annotations

import errno
import os
import time

LIMIT = 10 << 20
"""The maximum size of a log in bytes. One older log is kept as `NAME.log.1`."""

LONGEST = 1 << 16
"""The maximum length of a line in bytes. A longer line is split."""


class LogFile:
    """The output of a process, in any chunks, and notes of rcyaml."""

    def __init__(self, path: str, limit: int = LIMIT) -> None:
        self.path, self.limit = path, limit
        self._rest = b""
        self.lost = 0
        self._file = -1
        self._size = 0

    def write(self, data: bytes) -> None:
        """Adds output of the process. A line is written when it is complete."""
        *whole, self._rest = (self._rest + data).split(b"\n")
        while len(self._rest) > LONGEST:
            whole.append(self._rest[:LONGEST])
            self._rest = self._rest[LONGEST:]
        if whole:
            self._write(whole)

    def note(self, text: str) -> None:
        """Writes a line of rcyaml. An incomplete line of the process is written before it."""
        rest, self._rest = self._rest, b""
        self._write([*([rest] if rest else []), f"rcyaml: {text}".encode(errors="surrogateescape")])

    def restore(self) -> None:
        """Writes the file again if it was deleted while it was open."""
        if self._file < 0 or os.fstat(self._file).st_nlink:
            return
        try:
            os.makedirs(os.path.dirname(self.path), mode=0o700, exist_ok=True)
            with open(f"/proc/self/fd/{self._file}", "rb") as old:
                text = old.read()
            self.close()
            self._append(text)
        except OSError:
            self.close()

    def close(self) -> None:
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _write(self, lines: list[bytes]) -> None:
        # The time is only shown, never used.
        now = time.time()
        stamp = time.strftime(f"%Y-%m-%dT%H:%M:%S.{int(now % 1 * 1000):03}Z ", time.gmtime(now)).encode()
        if self.lost:
            lines = [f"rcyaml: {self.lost} lines are missing here: they could not be written".encode(), *lines]
        texts = [stamp + line.rstrip(b"\r") + b"\n" for line in lines]
        while texts:
            count = self._fitting(texts)
            try:
                self._append(b"".join(texts[:count]))
            except OSError:
                self.lost += len(texts) - bool(self.lost)
                return
            self.lost = 0
            texts = texts[count:]

    def _fitting(self, texts: list[bytes]) -> int:
        """How many of these lines go into one file: at least one."""
        room, count = self.limit - self._size if self._file >= 0 else self.limit, 0
        if room < len(texts[0]):
            room = self.limit
        while count < len(texts) and (room := room - len(texts[count])) >= 0:
            count += 1
        return max(count, 1)

    def _append(self, text: bytes) -> None:
        """Appends to the file. Raises OSError, with nothing written."""
        self._open(len(text))
        written = os.write(self._file, text)
        if written < len(text):  # the disk is full: no partial lines
            os.ftruncate(self._file, os.fstat(self._file).st_size - written)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        self._size += written

    def _open(self, more: int) -> None:
        """Opens the file, or a new one if `more` bytes would make it too large, or if somebody deleted it."""
        if self._file >= 0 and not os.fstat(self._file).st_nlink:
            self.close()
        if self._file >= 0 and self._size + more > self.limit:
            self.close()
            os.replace(self.path, f"{self.path}.1")
        if self._file < 0:
            os.makedirs(os.path.dirname(self.path), mode=0o700, exist_ok=True)
            self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o600)
            self._size = os.fstat(self._file).st_size
