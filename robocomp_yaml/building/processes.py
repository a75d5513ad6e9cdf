"""Processes that a build starts: what they say line by line, what they cost, and that they end with it."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

import msgspec

_POLITE = 5.0  # seconds that a process has to end when it is interrupted, before it is killed


class CompletedCommand(msgspec.Struct, frozen=True):
    """`cpu` are seconds, of the process and all that it waited for."""

    code: int
    cpu: float


class Processes:
    """Starts them, each in a session of its own: Ctrl-C reaches rcyaml alone, which ends them one and all."""

    def __init__(self) -> None:
        self._running: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._over = False

    def run(
        self, command: Sequence[str], on_line: Callable[[str], None], *, cwd: str | None = None,
        env: Mapping[str, str] | None = None,
    ) -> CompletedCommand:  # fmt: skip
        """Runs a command to its end; what it writes, on standard error too, goes to `on_line`. Compilers speak English,
        so that it is known what they say. Raises OSError where it cannot be started."""
        with self._lock:
            if self._over:
                raise KeyboardInterrupt
            process = subprocess.Popen(
                command, cwd=cwd, env={**os.environ, "LC_ALL": "C.UTF-8", **(env or {})}, stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
            self._running.add(process)
        try:
            assert process.stdout is not None
            for raw in process.stdout:
                on_line(raw.decode("utf-8", "surrogateescape").rstrip("\r\n"))
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        except BaseException:
            _end([process])
            with suppress(OSError):
                process.wait()
            raise
        finally:
            if process.stdout is not None:
                process.stdout.close()
            with self._lock:
                self._running.discard(process)
        return CompletedCommand(process.returncode, used.ru_utime + used.ru_stime)

    def end(self) -> None:
        """Ends all of them; none is started any more."""
        with self._lock:
            self._over = True
            running = list(self._running)
        _end(running)


def _end(processes: Sequence[subprocess.Popen[bytes]]) -> None:
    """Interrupted first, so that compilers leave no halves behind."""
    for number in (signal.SIGINT, signal.SIGKILL):
        for process in processes:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, number)
        until = time.monotonic() + _POLITE
        while time.monotonic() < until and any(map(_runs, processes)):
            time.sleep(0.02)


def _runs(process: subprocess.Popen[bytes]) -> bool:
    """Whether it is still there; one that has ended is buried."""
    try:
        return os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None
    except ChildProcessError:
        return False
