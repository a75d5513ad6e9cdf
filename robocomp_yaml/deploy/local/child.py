"""One process of the supervisor, which starts, restarts and stops it."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
from collections import deque
from collections.abc import Collection
from contextlib import suppress
from typing import Any

from robocomp_yaml.deploy.local import procfs, program
from robocomp_yaml.deploy.local.kernel import OpenFiles, death_with_this, tie
from robocomp_yaml.deploy.local.log_file import LogFile
from robocomp_yaml.deploy.states import ENDED, ENDS, GIVEN_UP, RUNNING, STOPPED, WAITING
from robocomp_yaml.network import limit_words

_NEVER, _ALWAYS = "no", "always"

_AFTER_KILL = 5.0  # seconds in which the kernel removes a killed process, unless that hangs in the kernel
_PORT_DELAY = 0.5  # seconds between the first two checks whether a port is free
_REPLACED_WITHIN = 3.0  # seconds in which a process that is not alive may end in order
_CHUNK = 1 << 16

SpecData = dict[str, Any]  # a `deploy.spec.ProcessSpec` as data, because the supervisor imports as little as possible


class ChildProcess:
    """`spec` is what it was started with, or will be. `root` is the pid of its last run, as long as descendants of that
    can be running. `policy` is the restart policy that applies, which also depends on the process's role. `not_alive`
    says why a running process is not alive. Times are those of the event loop, a monotonic clock."""

    def __init__(self, spec: SpecData, mark: str, log: LogFile, families: procfs.Families, files: OpenFiles) -> None:
        self.spec, self.mark, self.log, self._families, self._files = spec, mark, log, families, files
        self.state, self.pid, self.restarts, self.last_exit = STOPPED, 0, 0, ""
        self.policy: str = spec["process"]["restart"]["policy"]
        self.root = 0
        self.not_alive = ""
        self.lock = asyncio.Lock()
        self._loop = asyncio.get_running_loop()
        self.since = self._loop.time()
        self._environment: dict[str, str] = {}
        self._failures: deque[float] = deque()
        self._ends: deque[float] = deque(maxlen=ENDS)
        self._timer: asyncio.TimerHandle | None = None
        self._exited = asyncio.Event()
        self._output = -1
        self.is_stopping = False
        self._is_replaced = False
        self._taken = 0  # tries to restart it while its ports were used

    @property
    def spread(self) -> float | None:
        """Seconds between the last ends by itself; None if there were fewer than ENDS."""
        return self._ends[-1] - self._ends[0] if len(self._ends) == ENDS else None

    @property
    def lost_lines(self) -> int:
        return self.log.lost

    def start(self, environment: dict[str, str]) -> None:
        """Starts the process, if it does not run. Raises OSError."""
        if self.pid:
            return
        self._cancel_timer()
        self._environment = environment
        self._failures.clear()
        self._ends.clear()
        self._taken = 0
        self.restarts, self.last_exit = 0, ""
        self._spawn()

    async def stop(self, within: float) -> None:
        """Sends SIGTERM to the process and its family, and SIGKILL to those that run after `within` seconds. Raises
        TimeoutError if even that does not end them."""
        self._cancel_timer()
        if not self.pid:
            self._set_state(STOPPED)
            return
        self.is_stopping = True
        try:
            self._terminate()
            deadline = self._loop.time() + within
            try:
                await asyncio.wait_for(self._exited.wait(), within)
            except TimeoutError:
                self.log.note(f"did not end within {within:g} s: killed")
            while members := self._families.recent(self.root):
                if self._loop.time() > deadline + _AFTER_KILL:
                    raise TimeoutError
                if self._loop.time() > deadline:
                    _signal(members, signal.SIGKILL)
                await asyncio.sleep(0.02)
            await asyncio.wait_for(self._exited.wait(), _AFTER_KILL)
        finally:
            self.is_stopping = False
        self.root = 0
        self._set_state(STOPPED)

    def family(self) -> set[int]:
        """The pids of the process and its descendants."""
        return self._families.recent(self.root)

    def note_alive(self, why_not: str) -> None:
        """Sets whether the process is alive, and logs a change."""
        if bool(why_not) != bool(self.not_alive):
            self.log.note(f"not alive: {why_not}" if why_not else "alive again")
        self.not_alive = why_not

    async def replace(self) -> None:
        """Ends a process that is not alive. That counts as a failure, so that the restart policy applies; if the policy
        does not restart it, it is not ended."""
        async with self.lock:
            if self.spec["process"]["restart"]["policy"] == _NEVER or self.state != RUNNING or not self.pid:
                return
            self._is_replaced = True
            self._terminate()
            try:
                await asyncio.wait_for(self._exited.wait(), _REPLACED_WITHIN)
            except TimeoutError:
                _signal([self.root], signal.SIGKILL)
                await asyncio.wait_for(self._exited.wait(), _AFTER_KILL)

    def _terminate(self) -> None:
        """Sends SIGTERM to the process group, and to members of the family outside it. SIGCONT lets a halted one
        end."""
        members = self._families.recent(self.root)
        alive = self._families.alive
        for number in (signal.SIGTERM, signal.SIGCONT):
            with suppress(ProcessLookupError):
                os.killpg(self.root, number)
            _signal([pid for pid in members if alive[pid].group != self.root], number)

    def on_exit(self, status: int) -> None:
        """Called when the process has ended. Its descendants are killed, so that they do not keep ports or files."""
        self._read_all()
        self.pid = 0
        code = os.waitstatus_to_exitcode(status)
        self.last_exit = _in_words(code)
        self._exited.set()
        if self.is_stopping:
            self.log.note(f"stopped: {self.last_exit}")
            return
        _signal(self._families.now().get(self.root, set()), signal.SIGKILL)
        self.root = 0
        if self._is_replaced:
            self.last_exit = f"not alive: {self.not_alive}"
        self._after_end(is_failure=code != 0 or self._is_replaced)

    def _after_end(self, *, is_failure: bool) -> None:
        """Applies the restart policy to a process that ended by itself."""
        rule, now = self.spec["process"]["restart"], self._loop.time()
        self._ends.append(now)
        if self.policy != _ALWAYS and not is_failure:
            self.log.note(f"ended by itself: {self.last_exit}")
            self._set_state(ENDED)
            return
        if self.policy == _NEVER:
            self.log.note(f"ended by itself: {self.last_exit}; not restarted")
            self._set_state(GIVEN_UP)
            return
        self._failures.append(now)
        while now - self._failures[0] > rule["window"]:
            self._failures.popleft()
        count = len(self._failures)
        if count > rule["tries"]:
            self.log.note(
                f"given up: it ended {count} times within {rule['window']:g} s, the last time with {self.last_exit}"
            )
            self._set_state(GIVEN_UP)
            return
        delay = min(rule["delay"] * 2 ** (count - 1), rule["longest"])
        self.log.note(f"ended by itself: {self.last_exit}; restarting in {delay:g} s")
        self._set_state(WAITING)
        self._timer = self._loop.call_later(delay, self._restart)

    def _restart(self) -> None:
        self._timer = None
        if pids := procfs.listeners(self._ports()):
            self._wait_for_ports(pids)
            return
        self._taken = 0
        self.restarts += 1
        try:
            self._spawn()
        except OSError as error:
            self.last_exit = error.strerror or str(error)
            self._after_end(is_failure=True)

    def _ports(self) -> set[int]:
        process = self.spec["process"]
        served = {one["port"] for one in process["endpoints"] if one["port"] and one["protocol"] != "udp"}
        return served | {process["ready"]["port"]} - {None}

    def _wait_for_ports(self, taken: dict[int, list[int]]) -> None:
        """Waits until the ports of the process are free: it would only fail again, and be given up."""
        delay = min(_PORT_DELAY * 2**self._taken, self.spec["process"]["restart"]["longest"])
        if self._taken == 0:
            port, pids = next(iter(taken.items()))
            who = f"{procfs.command_line(pids[0])} (pid {pids[0]})" if pids else "a program of another user"
            self.last_exit = f"port {port} is used by {who}"
            self.log.note(f"{self.last_exit}: waiting until it is free")
        self._taken += 1
        self._timer = self._loop.call_later(delay, self._restart)

    def _spawn(self) -> None:
        command, folder = self.spec["command"], self.spec["process"]["cwd"]
        files = [(one["name"], one["file"]) for one in self.spec["process"]["env"] if one["file"]]
        environment = {**self._environment, **program.variables(files), procfs.MARK: self.mark}
        found = program.find(command[0], folder, environment)
        prefix = limit_words.words(self.spec["process"].get("limits", {}))
        output, written = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        os.set_blocking(written, True)
        try:
            started = subprocess.Popen(
                [*tie(), *prefix, found, *command[1:]], cwd=folder or "/", env=environment, stdin=subprocess.DEVNULL,
                stdout=written, stderr=written, start_new_session=True,
                preexec_fn=None if tie() else death_with_this(),
            )  # fmt: skip
        except BaseException:
            os.close(output)
            raise
        finally:
            os.close(written)
        self._files.restore(started.pid)
        started.returncode = 0  # the supervisor waits for all children, not this object
        self.pid = self.root = started.pid
        self._output = output
        self._exited.clear()
        self._set_state(RUNNING)
        self.log.note(f"started, pid {self.pid}")
        self._loop.add_reader(output, self._read)

    def _read(self) -> bool:
        """Reads a part of the output into the log. Returns whether there can be more."""
        try:
            data = os.read(self._output, _CHUNK)
        except BlockingIOError:
            return False
        if data:
            self.log.write(data)
            return True
        self._close_output()
        return False

    def _read_all(self) -> None:
        while self._output >= 0 and self._read():
            pass
        if self._output >= 0:  # a descendant still has the other end
            self._close_output()

    def _close_output(self) -> None:
        self._loop.remove_reader(self._output)
        os.close(self._output)
        self._output = -1

    def _cancel_timer(self) -> None:
        if self._timer:
            self._timer.cancel()
            self._timer = None

    def _set_state(self, state: str) -> None:
        self.not_alive, self._is_replaced = "", False
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
