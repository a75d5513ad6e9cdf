"""Processes that tests start and watch, and the ports that they use."""

from __future__ import annotations

import os
import random
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from robocomp_yaml.deploy.local import procfs

PATIENCE = 60.0  # seconds: generous, because the machines that run the tests may be busy; never waited in full
SLACK = 3.0  # seconds that such a machine may take longer than what a component promises


def until(condition: Callable[[], Any], what: str | Callable[[], str], timeout: float = PATIENCE) -> Any:
    """The first true value of `condition`, asked again and again; fails the test after `timeout`."""
    end = time.monotonic() + timeout
    while not (value := condition()):
        if time.monotonic() > end:
            pytest.fail(f"waited {timeout} s in vain: {what() if callable(what) else what}")
        time.sleep(0.02)
    return value


def read_until(stream: int, *texts: bytes) -> bytes:
    """What a pipe or a terminal gives until all texts were in it; fails at its end, and after PATIENCE."""
    seen, end = b"", time.monotonic() + PATIENCE
    while not all(text in seen for text in texts):
        ready, _, _ = select.select([stream], [], [], max(0.0, end - time.monotonic()))
        part = os.read(stream, 1000) if ready else b""
        if not part:
            pytest.fail(f"{texts} are not all in {seen!r}")
        seen += part
    return seen


def kill_left(folder: str) -> None:
    """Kills whatever is left of the deployment that runs from a folder."""
    for _ in range(100):
        left = procfs.marked(folder)
        for pid in left:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        if not left:
            return


@contextmanager
def killed_on_failure(process: subprocess.Popen[Any]) -> Iterator[subprocess.Popen[Any]]:
    """As `with process`, which alone waits for ever for a process whose end the test no longer comes to."""
    with process:
        try:
            yield process
        except BaseException:
            process.kill()
            raise


TRACER = """\
import ctypes, os, sys
SEIZE, INTERRUPT, WAIT_FOR_ALL = 0x4206, 0x4207, 0x40000000
ptrace = ctypes.CDLL(None, use_errno=True).ptrace
ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
for thread in map(int, os.listdir(f"/proc/{sys.argv[1]}/task")):
    if ptrace(SEIZE, thread, None, None) or ptrace(INTERRUPT, thread, None, None):
        sys.exit(ctypes.get_errno())
    os.waitpid(thread, WAIT_FOR_ALL)
print("attached", flush=True)
while True:  # a killed process is there until its tracer has noticed
    os.waitpid(-1, WAIT_FOR_ALL)
"""


@contextmanager
def hanging(*pids: int) -> Iterator[None]:
    """These processes do nothing, as in a debugger: a signal does not let them go on. Skips the test where tracing is
    not allowed."""
    with ExitStack() as tracers:
        for pid in pids:
            tracing = subprocess.Popen([sys.executable, "-c", TRACER, str(pid)], stdout=subprocess.PIPE)
            tracer = tracers.enter_context(tracing)
            tracers.callback(tracer.kill)
            assert tracer.stdout is not None
            if tracer.stdout.readline() != b"attached\n":
                pytest.skip("this machine does not allow tracing")
        yield


@dataclass
class Running:
    """A process that a test started, with what it has printed so far (standard output and error together)."""

    process: subprocess.Popen[bytes]
    chunks: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as stream:
            while chunk := os.read(stream.fileno(), 65536):
                self.chunks.append(chunk)

    @property
    def output(self) -> str:
        return b"".join(self.chunks).decode("utf-8", "replace")

    def wait_for(self, text: str, timeout: float = PATIENCE) -> Running:
        """Until it has printed `text`; fails when it ends without."""

        def printed() -> bool:
            if text in self.output:
                return True
            if self.process.poll() is not None:
                self._reader.join(1)
                if text not in self.output:
                    pytest.fail(f"ended with {self.process.returncode} without printing {text!r}:\n{self.output}")
            return text in self.output

        until(printed, lambda: f"{text!r} in:\n{self.output}", timeout)
        return self

    def exit_code(self, timeout: float = PATIENCE) -> int:
        """Until it ends by itself."""
        try:
            code = self.process.wait(timeout + SLACK)
        except subprocess.TimeoutExpired:
            pytest.fail(f"still running after {timeout + SLACK} s:\n{self.output}")
        self._reader.join(2)
        return code

    def stop(self, number: int = signal.SIGTERM, within: float = 2.0) -> int:
        """Signals it, and fails if it takes longer than `within` to end; the exit code."""
        self.process.send_signal(number)
        return self.exit_code(within)

    def end(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self._reader.join(2)


Start = Callable[..., Running]


class Ports:
    """Free TCP ports, each handed out once.

    They lie below the range that the system gives to outgoing connections, and each process begins at a random place,
    so that test runs side by side do not meet.
    """

    def __init__(self) -> None:
        self._next = random.SystemRandom().randrange(15000, 31000)

    def __call__(self) -> int:
        while True:
            self._next = self._next + 1 if self._next < 31999 else 15000
            with socket.socket() as probe:
                try:
                    probe.bind(("127.0.0.1", self._next))
                except OSError:
                    continue
            return self._next


@dataclass(frozen=True)
class Storm:
    """An IceStorm in icebox: the proxy string of its topic manager, and how it is started."""

    manager: str
    command: tuple[str, ...]

    @staticmethod
    def new(folder: Path, manager_port: int, publish_port: int) -> Storm:
        """One that keeps its configuration and its topics in a folder."""
        (folder / "db").mkdir()
        (folder / "storm.cfg").write_text(
            "IceStorm.InstanceName=IceStorm\n"
            f"IceStorm.TopicManager.Endpoints=tcp -h 127.0.0.1 -p {manager_port}\n"
            f"IceStorm.Publish.Endpoints=tcp -h 127.0.0.1 -p {publish_port}\n"
            f"IceStorm.LMDB.Path={folder}/db\n"
            "IceStorm.LMDB.MapSize=10\n"
        )
        (folder / "box.cfg").write_text(
            f"IceBox.Service.IceStorm=IceStormService,37:createIceStorm --Ice.Config={folder}/storm.cfg\n"
            "IceBox.InheritProperties=1\n"
        )
        manager = f"IceStorm/TopicManager:tcp -h 127.0.0.1 -p {manager_port}"
        return Storm(manager, ("icebox", f"--Ice.Config={folder}/box.cfg"))


def answers(ice: Any, proxy: str) -> bool:
    """Whether the object answers a ping."""
    import Ice

    try:
        ice.stringToProxy(proxy).ice_ping()
    except Ice.Exception:
        return False
    return True
