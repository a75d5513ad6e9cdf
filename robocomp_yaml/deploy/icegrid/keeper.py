"""The keeper of one deployment, a server of its own: `python -m robocomp_yaml.deploy.icegrid.keeper FOLDER`.

A process that ends is restarted on its own host, by `run`, without the registry. The keeper does what `run` cannot do,
because the node or `run` itself was killed: it starts each desired process that neither runs nor has ended for good,
with a delay that doubles while this fails. It also ends processes that were moved away from a host which did not answer
at that time. And it starts a successor of the registry's guard, if that was killed.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from contextlib import suppress
from typing import Any

import Ice
import IceGrid

from robocomp_yaml.deploy.here import is_near
from robocomp_yaml.deploy.icegrid import daemons, leftovers
from robocomp_yaml.deploy.icegrid.failures import GridFailed, Unreachable
from robocomp_yaml.deploy.icegrid.grid import GridSession
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.icegrid.status import is_over
from robocomp_yaml.deploy.plan import in_order
from robocomp_yaml.diag import terminal

_PERIOD = 2.0  # seconds between two checks without an event
_SHORTEST, _LONGEST = 0.1, 10.0  # seconds between two tries to start a process


class NodeWatcher(IceGrid.NodeObserver):  # type: ignore[misc]
    """Sets an event when a node or a server changes."""

    def __init__(self, changed: threading.Event) -> None:
        self._changed = changed

    def nodeInit(self, nodes: Any, current: Any = None) -> None:
        self._changed.set()

    def nodeUp(self, node: Any, current: Any = None) -> None:
        self._changed.set()

    def nodeDown(self, name: str, current: Any = None) -> None:
        return

    def updateServer(self, node: str, updatedInfo: Any, current: Any = None) -> None:
        if str(updatedInfo.state) == "Inactive":
            self._changed.set()

    def updateAdapter(self, node: str, updatedInfo: Any, current: Any = None) -> None:
        return


class Keeper:
    """The keeper's loop. `over` ends it."""

    def __init__(self, folder: str) -> None:
        self.files = GridFiles(folder)
        self.over = threading.Event()
        self._changed = threading.Event()
        self._tries: dict[str, tuple[float, float]] = {}

    def run(self) -> None:
        while not self.over.is_set():
            registry = self.files.registry()
            if registry is None:
                return
            try:
                grid = GridSession(self.files, registry)
            except Unreachable:
                self.over.wait(0.2)
                continue
            try:
                self._watch(grid)
            except (GridFailed, Ice.Exception) as error:
                terminal.say(f"the registry does not answer: {error}", err=True)
                self.over.wait(0.2)
            finally:
                grid.close()

    def end(self) -> None:
        self.over.set()
        self._changed.set()

    def _watch(self, grid: GridSession) -> None:
        """Watches until the keeper ends. Raises GridFailed or Ice.Exception if the registry does not answer."""
        adapter = grid.communicator.createObjectAdapter("")
        observer = adapter.addWithUUID(NodeWatcher(self._changed)).ice_getIdentity()
        adapter.activate()
        connection = grid.session.ice_getCachedConnection()
        connection.setAdapter(adapter)
        connection.setCloseCallback(lambda _: self._changed.set())
        nobody = Ice.Identity()
        grid.session.setObserversByIdentity(nobody, observer, nobody, nobody, nobody)
        while not self.over.is_set():
            self._changed.wait(self._pause())
            self._changed.clear()
            if not self.over.is_set():
                self._restart(grid)
                leftovers.end_all(grid)
                with suppress(OSError):  # tried again
                    daemons.succeed_guard(self.files)

    def _pause(self) -> float:
        now = time.monotonic()
        return max(0.0, min([_PERIOD, *(at - now for at, _ in self._tries.values())]))

    def _restart(self, grid: GridSession) -> None:
        desired = self.files.desired()
        specs = {name: spec for name, spec in self.files.specs().items() if spec and name in desired}
        states = grid.states(specs)
        now = time.monotonic()
        for name in in_order({name: spec.process.after for name, spec in specs.items()}):
            if states[name][0] != "Inactive":
                self._tries.pop(name, None)
                continue
            at, delay = self._tries.get(name, (now, _SHORTEST / 2))
            if at > now or is_over(grid, name, specs[name].process.host, is_local=is_near(specs[name])):
                continue
            self._tries[name] = (now + min(2 * delay, _LONGEST), min(2 * delay, _LONGEST))
            if name not in self.files.desired():
                continue  # it was stopped in the meantime
            try:
                grid.start(name)
                terminal.say(f"{name}: restarted", err=True)
            except Unreachable:
                raise
            except GridFailed as error:
                terminal.say(f"{name}: {error}", err=True)
        for name in set(self._tries) - set(specs):
            del self._tries[name]


def main(folder: str) -> None:
    keeper = Keeper(folder)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: keeper.end())
    # The main thread handles signals, and therefore must not block in a call.
    worker = threading.Thread(target=keeper.run, daemon=True)
    worker.start()
    while worker.is_alive():
        worker.join(0.2)
        if keeper.over.is_set():
            worker.join(2)
            return


if __name__ == "__main__":
    main(sys.argv[1])
