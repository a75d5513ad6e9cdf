"""A way to do the tasks: what the user types is done here, counted, and checked over Ice."""

from __future__ import annotations

import difflib
import os
import resource
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
PYTHON = sys.executable  # components run with it, too, if it has Ice
PORTS = {"Speech": 10101, "Mouth": 10102, "Volume": 10103}  # as the files of this folder spell them
ENVIRONMENT = {
    **{key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
    "PATH": f"{Path(PYTHON).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}",
    "QT_QPA_PLATFORM": "offscreen",
}


class Failed(Exception):
    """A command failed, or a task is not done. The message is for the user."""


@dataclass
class Cost:
    """What a task costs its user: lines written or changed, files, commands, and the seconds of processor time of the
    commands. How long a person waits depends on what else the machine does."""

    lines: int = 0
    files: set[str] = field(default_factory=set)
    commands: list[str] = field(default_factory=list)
    seconds: float = 0.0


class Way:
    """A folder in which the tasks are done one after the other, each on the result of the one before, by the method
    `do_TASK`."""

    name = ""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.cost = Cost()
        self.base = free_ports()

    def why_not(self) -> str:
        """Why this way cannot be gone on this machine; '' if it can."""
        return ""

    def prepare(self) -> None:
        raise NotImplementedError

    def running(self, task: str) -> Iterator[dict[str, int]]:
        """Starts what is to be asked, yields its ports, and stops it."""
        raise NotImplementedError

    def stop(self) -> None:
        """Stops the network of the last task, if it still runs."""
        raise NotImplementedError

    def do(self, task: str) -> Cost:
        """Does a task, checks it, and returns what it costs. Raises Failed."""
        self.cost = Cost()
        try:
            getattr(self, f"do_{task}")()
        except BaseException:
            self.stop()
            raise
        with contextmanager(self.running)(task) as ports:
            words = [PYTHON, str(HERE / "ask.py"), task, *(f"{name}={port}" for name, port in ports.items())]
            asked = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
        if asked.returncode:
            raise Failed(f"{self.name}: the task '{task}' is not done: {asked.stdout}{asked.stderr}")
        return self.cost

    # What a user does.

    def write(self, path: str, text: str) -> None:
        """A new file, or a whole new text of one."""
        file = self.folder / path
        before = file.read_text(encoding="utf-8") if file.exists() else ""
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(self.with_ports(text), encoding="utf-8")
        self._count(path, before, text)

    def edit(self, path: str, *changes: tuple[str, str]) -> None:
        """Texts, each with what replaces it."""
        file = self.folder / path
        before = after = file.read_text(encoding="utf-8")
        for old, new in changes:
            if after.count(self.with_ports(old)) != 1:
                raise Failed(f"{path} does not contain this once: {old!r}")
            after = after.replace(self.with_ports(old), self.with_ports(new))
        file.write_text(after, encoding="utf-8")
        self._count(path, before, after)

    def command(self, *words: str, cwd: str = ".", shown: str = "") -> None:
        """A command that the user types, as `shown` if that is shorter than what it stands for."""
        self.cost.commands.append(shown or shlex.join(words))
        before = processor_time()
        self.run(*words, cwd=cwd)
        self.cost.seconds += processor_time() - before

    def _count(self, path: str, before: str, after: str) -> None:
        self.cost.files.add(path)
        for line in difflib.ndiff(before.splitlines(), after.splitlines()):
            self.cost.lines += line.startswith("+ ") and bool(line[2:].strip())

    # What this script does for itself.

    def run(self, *words: str, cwd: str = ".") -> str:
        done = subprocess.run(words, cwd=self.folder / cwd, env=ENVIRONMENT, capture_output=True, text=True)
        if done.returncode:
            raise Failed(f"{self.name}: {shlex.join(words)} failed:\n{done.stdout}{done.stderr}")
        return done.stdout

    def with_ports(self, text: str) -> str:
        for number, port in enumerate(PORTS.values()):
            text = text.replace(str(port), str(self.base + number))
        return text

    def ports(self) -> dict[str, int]:
        return {name: self.base + number for number, name in enumerate(PORTS)}

    def copy(self, source: str) -> None:
        """Files that are given, below the folder, at the ports of this run."""
        for file in sorted((HERE / source).rglob("*")):
            if file.is_file() and "__pycache__" not in file.parts:
                target = self.folder / file.relative_to(HERE / source)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(self.with_ports(file.read_text(encoding="utf-8")), encoding="utf-8")

    @contextmanager
    def program(self, words: Sequence[str], cwd: str, port: int) -> Iterator[None]:
        """A program in the background, as soon as something listens on its port."""
        log = self.folder / "output.log"
        with open(log, "a", encoding="utf-8") as output:
            started = subprocess.Popen(
                words, cwd=self.folder / cwd, env=ENVIRONMENT, stdout=output, stderr=output, start_new_session=True
            )
        try:
            until = time.monotonic() + 30
            while not listens(port):
                if started.poll() is not None or time.monotonic() > until:
                    raise Failed(f"{self.name}: {shlex.join(words)} does not serve:\n{log.read_text(encoding='utf-8')}")
                time.sleep(0.05)
            yield
        finally:
            if started.poll() is None:
                started.send_signal(signal.SIGINT)
                try:
                    started.wait(15)
                except subprocess.TimeoutExpired:
                    started.kill()
                    started.wait()


def processor_time() -> float:
    """Of all processes so far that this one has started and that have ended, and of theirs."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def listens(port: int) -> bool:
    with socket.socket() as one:
        one.settimeout(1)
        return one.connect_ex(("127.0.0.1", port)) == 0


def free_ports() -> int:
    """The first of twenty ports in a row that nobody uses."""
    for first in range(14000 + os.getpid() % 400 * 20, 30000, 20):
        if not any(listens(first + number) for number in range(20)):
            return first
    raise Failed("there are no free ports")


def fresh(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder
