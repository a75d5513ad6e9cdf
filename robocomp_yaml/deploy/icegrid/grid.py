"""An administrator's session with a deployment's registry, in blocking calls."""

from __future__ import annotations

import atexit
import contextlib
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import Ice
import IceGrid

from robocomp_yaml.deploy.engine import STARTED, Line
from robocomp_yaml.deploy.icegrid import settings
from robocomp_yaml.deploy.icegrid.failures import GridFailed, Unreachable
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles, Registry
from robocomp_yaml.deploy.local.log_reader import line_of
from robocomp_yaml.deploy.time_limit import until

_RETRY = 0.01
_READ_WITHIN = 4000  # milliseconds


class GridSession:
    """A session. Its methods are thread-safe, and raise GridFailed."""

    def __init__(self, files: GridFiles, registry: Registry) -> None:
        self.files = files
        data = Ice.InitializationData()
        data.properties = Ice.createProperties()
        for key, value in settings.of_client(files).items():
            data.properties.setProperty(key, value)
        try:
            self.communicator = Ice.initialize(data)
        except Ice.Exception as error:
            raise Unreachable(in_words(error)) from error
        atexit.register(self.communicator.destroy)  # also if a command fails before it closes the session
        try:
            proxy = self.communicator.stringToProxy(settings.registry_proxy(registry))
            self.session = IceGrid.RegistryPrx.uncheckedCast(proxy).createAdminSession("rcyaml", "")
            self.admin = self.session.getAdmin()
            # Calls that only read are fast, unless a host does not answer.
            self._reads = IceGrid.AdminPrx.uncheckedCast(self.admin.ice_invocationTimeout(_READ_WITHIN))
            self._read_session = IceGrid.AdminSessionPrx.uncheckedCast(self.session.ice_invocationTimeout(_READ_WITHIN))
        except Ice.Exception as error:
            self._destroy()
            raise Unreachable(in_words(error)) from error

    def close(self) -> None:
        with contextlib.suppress(Ice.Exception):
            self.session.destroy()
        self._destroy()

    def _destroy(self) -> None:
        atexit.unregister(self.communicator.destroy)
        self.communicator.destroy()

    def has_node(self, host: str) -> bool:
        with _failures(), contextlib.suppress(IceGrid.NodeNotExistException, Ice.InvocationTimeoutException):
            answer: bool = self._reads.pingNode(host)
            return answer
        return False

    def user_of(self, host: str) -> str:
        """The user of a node, whose name is the name of the node's data folder."""
        info = self._call(self.admin.getNodeInfo, host)
        name: str = info.dataDir.rstrip("/").rpartition("/")[2]
        return name

    def descriptor(self, application: str) -> Any:
        """The deployed application, None if there is none."""
        with _failures(), contextlib.suppress(IceGrid.ApplicationNotExistException):
            return self.admin.getApplicationInfo(application).descriptor
        return None

    def deploy(self, descriptor: Any, *, is_new: bool) -> None:
        """Deploys an application. Running servers whose descriptors changed restart; all others go on."""
        if is_new:
            self._call(self.admin.addApplication, descriptor)
        else:
            self._call(self.admin.syncApplication, descriptor)

    def remove(self, application: str) -> None:
        with _failures(), contextlib.suppress(IceGrid.ApplicationNotExistException):
            self.admin.removeApplication(application)

    def states(self, names: Iterable[str]) -> dict[str, tuple[str, int]]:
        """The state and the pid of each server. The state is '' if its node does not answer, or the server is
        unknown."""
        calls = [(name, self._reads.getServerPidAsync(name)) for name in names]
        pids = {name: self._answer(pid, -1) for name, pid in calls}
        # A server with a pid is active, activating or deactivating.
        rest = {name: self._reads.getServerStateAsync(name) for name, pid in pids.items() if pid == 0}
        states = {name: str(self._answer(state, "")) for name, state in rest.items()}
        return {name: (states.get(name, "Active" if pid > 0 else ""), max(pid, 0)) for name, pid in pids.items()}

    def _answer(self, future: Any, missing: Any) -> Any:
        absent = IceGrid.NodeUnreachableException, IceGrid.ServerNotExistException, Ice.InvocationTimeoutException
        with _failures(), contextlib.suppress(*absent):
            return future.result()
        return missing

    def start(self, name: str) -> None:
        try:
            self._call(self.admin.startServer, name)
        except GridFailed:
            # The keeper may have started it.
            if self.states([name])[name][0] not in ("Active", "Activating"):
                raise

    def stop(self, name: str) -> None:
        try:
            self._call(self.admin.stopServer, name)
        except GridFailed:
            if self.states([name])[name][0] != "Inactive":
                raise

    def signal(self, name: str, signal: str) -> None:
        """Sends a signal to a server. One that has just ended is ignored."""
        with contextlib.suppress(GridFailed):
            self._call(self._reads.sendSignal, name, signal)

    def run(self, name: str, within: float) -> bool:
        """Starts a server and waits until it has ended. Returns whether it has, within so many seconds."""
        self.start(name)
        return until(lambda: self.states([name])[name][0] in ("Inactive", ""), within)

    def read(self, name: str, path: str) -> list[str]:
        """The lines of a file of a process, on its host; none if the file is missing."""
        lines: list[str] = []
        with _failures(), contextlib.suppress(IceGrid.FileNotAvailableException):
            iterator = self._read_session.openServerLog(name, path, -1)
            try:
                is_end = False
                while not is_end:
                    is_end, more = iterator.read(1 << 16)
                    lines += more
            finally:
                with contextlib.suppress(Ice.Exception):
                    iterator.destroy()
        return lines

    def printed(self, name: str, log: str) -> list[str]:
        """What the last run of a process has printed, by its log."""
        lines = self.read(name, log)
        starts = [number for number, line in enumerate(lines) if f" {STARTED}" in line]
        return lines[starts[-1] :] if starts else []

    def shut_down_node(self, host: str) -> None:
        with contextlib.suppress(GridFailed):
            self._call(self.admin.shutdownNode, host)

    def shut_down(self) -> None:
        """Ends the registry."""
        with contextlib.suppress(GridFailed):
            self._call(self.admin.shutdown)

    def _call(self, operation: Callable[..., Any], *arguments: Any) -> Any:
        with _failures():
            return operation(*arguments)


@contextlib.contextmanager
def _failures() -> Iterator[None]:
    """Raises GridFailed for errors of IceGrid, and Unreachable if the registry or a node does not answer."""
    try:
        yield
    except IceGrid.NodeUnreachableException as error:
        raise Unreachable(f"the IceGrid node of '{error.name}' does not answer") from error
    except Ice.UserException as error:
        raise GridFailed(in_words(error)) from error
    except Ice.Exception as error:
        raise Unreachable(in_words(error)) from error


def reach(files: GridFiles, registry: Registry, within: float) -> GridSession:
    """A new session, tried for so many seconds. Raises Unreachable."""
    until = time.monotonic() + within
    while True:
        try:
            return GridSession(files, registry)
        except Unreachable:
            if time.monotonic() > until:
                raise
            time.sleep(_RETRY)


def in_words(error: Exception) -> str:
    """The reason that IceGrid reports, else the name of the exception's class."""
    reason = getattr(error, "reason", "") or str(error)
    return " ".join(reason.split()).rstrip(".") or type(error).__name__


class GridReader:
    """Reads a log on another host. Lines that are written while the node does not answer are read later."""

    def __init__(self, grid: GridSession, name: str, host: str) -> None:
        self._grid, self._name, self._path = grid, name, grid.files.on(host).log(name)
        self._seen = self._lines()

    def last(self, count: int) -> list[Line]:
        return [line_of(self._name, text) for text in self._seen[-count:]] if count > 0 else []

    def new(self) -> list[Line]:
        lines = self._lines()
        is_same_file = lines[:1] == self._seen[:1] and len(lines) >= len(self._seen)
        fresh = lines[len(self._seen) :] if is_same_file else lines
        self._seen = lines or self._seen
        return [line_of(self._name, text) for text in fresh]

    def _lines(self) -> list[str]:
        try:
            return [line for line in self._grid.read(self._name, self._path) if line]
        except GridFailed:
            return []
