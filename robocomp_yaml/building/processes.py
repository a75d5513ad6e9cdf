"""The processes of a build: their output line by line, their cost, and their end."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

import msgspec

_TIME_TO_END = 5.0  # seconds between SIGINT and SIGKILL


class CompletedCommand(msgspec.Struct, frozen=True):
    """The exit code, and the CPU time in seconds, with that of child processes."""

    code: int
    cpu: float


class Processes:
    """Starts processes, each in a session of its own, so that Ctrl-C reaches only rcyaml, which then ends them."""

    def __init__(self) -> None:
        self._running: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._over = False

    def run(
        self, command: Sequence[str], on_line: Callable[[str], None], *, cwd: str | None = None,
        env: Mapping[str, str] | None = None,
    ) -> CompletedCommand:  # fmt: skip
        """Runs a command to its end. `on_line` gets each line of its standard output and standard error. The locale is
        set so that compilers print English, which is parsed. Raises OSError if the command cannot be started,
        KeyboardInterrupt if the build is ending."""
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
        """Ends all processes. No other one is started from now on."""
        with self._lock:
            self._over = True
            running = list(self._running)
        _end(running)


def _end(processes: Sequence[subprocess.Popen[bytes]]) -> None:
    """Interrupts processes, so that compilers remove incomplete files, and then kills them."""
    for number in (signal.SIGINT, signal.SIGKILL):
        for process in processes:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, number)
        until = time.monotonic() + _TIME_TO_END
        while time.monotonic() < until and any(map(_runs, processes)):
            time.sleep(0.02)


def _runs(process: subprocess.Popen[bytes]) -> bool:
    """Whether a process is still running."""
    try:
        return os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None
    except ChildProcessError:
        return False
