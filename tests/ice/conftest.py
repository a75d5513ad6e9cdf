"""What the tests over real Ice share: free ports, processes that always end, an IceStorm, a client's communicator.

Language-neutral: the tests of the Python and of the C++ target use the same fixtures.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

PATIENCE = 20.0  # seconds: generous, because the machines that run the tests may be busy; never waited in full


def until(condition: Callable[[], Any], what: str | Callable[[], str], timeout: float = PATIENCE) -> Any:
    """The first true value of `condition`, asked again and again; fails the test after `timeout`."""
    end = time.monotonic() + timeout
    while not (value := condition()):
        if time.monotonic() > end:
            pytest.fail(f"waited {timeout} s in vain: {what() if callable(what) else what}")
        time.sleep(0.02)
    return value


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
            code = self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            pytest.fail(f"still running after {timeout} s:\n{self.output}")
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


@pytest.fixture
def start() -> Iterator[Start]:
    """`start(command, cwd=…, env={…})`: a process that is killed at the end of the test, if it still runs."""
    started: list[Running] = []

    def start_process(command: Sequence[str | Path], cwd: Path | None = None, env: dict[str, str] | None = None) -> Running:
        process = subprocess.Popen(
            [str(word) for word in command],
            cwd=cwd,
            env={**os.environ, "PYTHONUNBUFFERED": "1", **(env or {})},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        started.append(Running(process))
        return started[-1]

    yield start_process
    for running in started:
        running.end()


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


@pytest.fixture(scope="session")
def free_port() -> Ports:
    """`free_port()`: a TCP port that nobody uses."""
    return Ports()


@pytest.fixture(scope="session")
def ice() -> Iterator[Any]:
    """A client's communicator; the test is skipped where Python has no Ice."""
    Ice = pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    data.properties.setProperty("Ice.Override.ConnectTimeout", "2000")
    data.properties.setProperty("Ice.Default.InvocationTimeout", "10000")
    communicator = Ice.initialize(data)
    yield communicator
    communicator.destroy()


@dataclass(frozen=True)
class Storm:
    """A running IceStorm: the proxy string of its topic manager."""

    manager: str


@pytest.fixture(scope="session")
def icestorm(ice: Any, free_port: Ports, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Storm]:
    """A real IceStorm in icebox, one for the session (of each xdist worker)."""
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    folder = tmp_path_factory.mktemp("icestorm")
    (folder / "db").mkdir()
    manager_port, publish_port = free_port(), free_port()
    (folder / "storm.cfg").write_text(
        "IceStorm.InstanceName=IceStorm\n"
        f"IceStorm.TopicManager.Endpoints=tcp -h 127.0.0.1 -p {manager_port}\n"
        f"IceStorm.Publish.Endpoints=tcp -h 127.0.0.1 -p {publish_port}\n"
        "IceStorm.LMDB.Path=db\n"
        "IceStorm.LMDB.MapSize=10\n"
    )
    (folder / "box.cfg").write_text(
        "IceBox.Service.IceStorm=IceStormService,37:createIceStorm --Ice.Config=storm.cfg\nIceBox.InheritProperties=1\n"
    )
    process = subprocess.Popen(
        ["icebox", "--Ice.Config=box.cfg"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    running = Running(process)
    storm = Storm(f"IceStorm/TopicManager:tcp -h 127.0.0.1 -p {manager_port}")
    until(lambda: answers(ice, storm.manager), lambda: f"IceStorm:\n{running.output}")
    yield storm
    process.terminate()
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        running.end()


def answers(ice: Any, proxy: str) -> bool:
    """Whether the object answers a ping."""
    import Ice

    try:
        ice.stringToProxy(proxy).ice_ping()
    except Ice.Exception:
        return False
    return True
