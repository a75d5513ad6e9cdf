"""One process under the supervisor: started, watched, started again when it ends by itself, and ended for good."""

from __future__ import annotations

import asyncio
import functools
import os
import signal
import subprocess
from collections import deque
from collections.abc import Collection
from contextlib import suppress
from typing import Any

from robocomp_yaml.deploy.local import procfs, program
from robocomp_yaml.deploy.local.kernel import OpenFiles, die_with, tie
from robocomp_yaml.deploy.local.log_file import LogFile

RUNNING, WAITING, GIVEN_UP, ENDED, STOPPED = "running", "waiting", "given up", "ended", "stopped"
_NEVER, _ALWAYS = "no", "always"

_AFTER_KILL = 5.0  # seconds in which the kernel removes what was killed, unless it hangs in the kernel itself
_CHUNK = 1 << 16

Spec = dict[str, Any]  # a `deploy.spec.Spec` as data: the supervisor imports as little as it can


class ChildProcess:
    """`spec` is what it was started with, or will be. `root` is the pid of its last run, as long as something of that
    may be left. Times are the loop's, which no change of the clock moves."""

    def __init__(self, spec: Spec, mark: str, log: LogFile, families: procfs.Families, files: OpenFiles) -> None:
        self.spec, self.mark, self.log, self._families, self._files = spec, mark, log, families, files
        self.state, self.pid, self.restarts, self.last_exit = STOPPED, 0, 0, ""
        self.root = 0
        self.lock = asyncio.Lock()
        self._loop = asyncio.get_running_loop()
        self.since = self._loop.time()
        self._environment: dict[str, str] = {}
        self._failures: deque[float] = deque()
        self._timer: asyncio.TimerHandle | None = None
        self._exited = asyncio.Event()
        self._output = -1
        self._is_stopping = False

    def start(self, environment: dict[str, str]) -> None:
        """Raises OSError where it cannot be started."""
        if self.pid:
            return
        self._cancel_timer()
        self._environment = environment
        self._failures.clear()
        self.restarts, self.last_exit = 0, ""
        self._spawn()

    async def stop(self, within: float) -> None:
        """Asks it and its group to end; kills what of its family is left after so many seconds. Raises TimeoutError
        where even that does not end them."""
        self._cancel_timer()
        if not self.pid:
            self._turn(STOPPED)
            return
        self._is_stopping = True
        try:
            self._ask_to_end()
            deadline = self._loop.time() + within
            try:
                await asyncio.wait_for(self._exited.wait(), within)
            except TimeoutError:
                self.log.say(f"did not end within {within:g} s: killed")
            while members := self._families.recent(self.root):
                if self._loop.time() > deadline + _AFTER_KILL:
                    raise TimeoutError
                if self._loop.time() > deadline:
                    _signal(members, signal.SIGKILL)
                await asyncio.sleep(0.02)
            await asyncio.wait_for(self._exited.wait(), _AFTER_KILL)
        finally:
            self._is_stopping = False
        self.root = 0
        self._turn(STOPPED)

    def _ask_to_end(self) -> None:
        """Its group, and what has left that; one that was halted goes on, so that it can end."""
        members = self._families.recent(self.root)
        alive = self._families.alive
        for number in (signal.SIGTERM, signal.SIGCONT):
            with suppress(ProcessLookupError):
                os.killpg(self.root, number)
            _signal([pid for pid in members if alive[pid].group != self.root], number)

    def on_exit(self, status: int) -> None:
        """The process ended. What else it had started ends with it, so that nothing of it stands in the way."""
        self._read_all()
        self.pid = 0
        code = os.waitstatus_to_exitcode(status)
        self.last_exit = _in_words(code)
        self._exited.set()
        if self._is_stopping:
            self.log.say(f"stopped: {self.last_exit}")
            return
        _signal(self._families.now().get(self.root, set()), signal.SIGKILL)
        self.root = 0
        self._after_end(is_failure=code != 0)

    def _after_end(self, *, is_failure: bool) -> None:
        """What the policy says of a process that ended by itself."""
        rule = self.spec["process"]["restart"]
        if rule["policy"] != _ALWAYS and not is_failure:
            self.log.say(f"ended by itself: {self.last_exit}")
            self._turn(ENDED)
            return
        if rule["policy"] == _NEVER:
            self.log.say(f"ended by itself: {self.last_exit}; it is not to be started again")
            self._turn(GIVEN_UP)
            return
        now = self._loop.time()
        self._failures.append(now)
        while now - self._failures[0] > rule["window"]:
            self._failures.popleft()
        count = len(self._failures)
        if count > rule["tries"]:
            self.log.say(
                f"given up: it ended {count} times within {rule['window']:g} s, the last time with {self.last_exit}"
            )
            self._turn(GIVEN_UP)
            return
        delay = min(rule["delay"] * 2 ** (count - 1), rule["longest"])
        self.log.say(f"ended by itself: {self.last_exit}; starting again in {delay:g} s")
        self._turn(WAITING)
        self._timer = self._loop.call_later(delay, self._restart)

    def _restart(self) -> None:
        self._timer = None
        self.restarts += 1
        try:
            self._spawn()
        except OSError as error:
            self.last_exit = error.strerror or str(error)
            self._after_end(is_failure=True)

    def _spawn(self) -> None:
        command, folder = self.spec["command"], self.spec["process"]["cwd"]
        files = [(one["name"], one["file"]) for one in self.spec["process"]["env"] if one["file"]]
        environment = {**self._environment, **program.variables(files), procfs.MARK: self.mark}
        found = program.find(command[0], folder, environment)
        ours, theirs = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        os.set_blocking(theirs, True)
        try:
            started = subprocess.Popen(
                [*tie(), found, *command[1:]], cwd=folder or "/", env=environment, stdin=subprocess.DEVNULL,
                stdout=theirs, stderr=theirs, start_new_session=True,
                preexec_fn=None if tie() else functools.partial(die_with, os.getpid()),
            )  # fmt: skip
        except BaseException:
            os.close(ours)
            raise
        finally:
            os.close(theirs)
        self._files.restore(started.pid)
        started.returncode = 0  # it is the supervisor that waits for all children, not this object
        self.pid = self.root = started.pid
        self._output = ours
        self._exited.clear()
        self._turn(RUNNING)
        self.log.say(f"started, pid {self.pid}")
        self._loop.add_reader(ours, self._read)

    def _read(self) -> bool:
        """Takes some of what it wrote; whether there may be more at once."""
        try:
            data = os.read(self._output, _CHUNK)
        except BlockingIOError:
            return False
        if data:
            self.log.take(data)
            return True
        self._close_output()
        return False

    def _read_all(self) -> None:
        while self._output >= 0 and self._read():
            pass
        if self._output >= 0:  # something that it started still holds the other end
            self._close_output()

    def _close_output(self) -> None:
        self._loop.remove_reader(self._output)
        os.close(self._output)
        self._output = -1

    def _cancel_timer(self) -> None:
        if self._timer:
            self._timer.cancel()
            self._timer = None

    def _turn(self, state: str) -> None:
        self.state, self.since = state, self._loop.time()


def _signal(members: Collection[int], number: int) -> None:
    for pid in members:
        with suppress(ProcessLookupError):
            os.kill(pid, number)


def _in_words(code: int) -> str:
    """How a process ended: 'exit code 3', or the name of a signal."""
    if code >= 0:
        return f"exit code {code}"
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"
