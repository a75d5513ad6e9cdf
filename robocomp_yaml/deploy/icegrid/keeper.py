"""The keeper of one deployment, a server of its own: `python -m robocomp_yaml.deploy.icegrid.keeper FOLDER`.

A process that ends is started again on its own host, by `run`, with or without a registry. What only somebody outside
can mend is the keeper's: the node or the `run` script of a process was killed. It starts what is wanted and neither
runs nor ended for good, with a delay that doubles while that fails. And it ends what is left on a host that did not
answer when it was moved away from there.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from typing import Any

import Ice
import IceGrid

from robocomp_yaml.deploy.icegrid import leftovers
from robocomp_yaml.deploy.icegrid.grid import GridFailed, GridSession, Unreachable
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.icegrid.status import is_over
from robocomp_yaml.deploy.local.obstacles import is_here
from robocomp_yaml.deploy.plan import in_order
from robocomp_yaml.diag import terminal

_PERIOD = 2.0  # seconds between two looks without an event
_SHORTEST, _LONGEST = 0.1, 10.0  # seconds between two tries to start a process


class NodeWatcher(IceGrid.NodeObserver):  # type: ignore[misc]
    """Notes that something changed."""

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
    """`over` is set when the keeper is to end."""

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
        """Until the keeper is to end. Raises GridFailed or Ice.Exception when the registry is gone."""
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
                self._bring_back(grid)
                leftovers.end_all(grid)

    def _pause(self) -> float:
        now = time.monotonic()
        return max(0.0, min([_PERIOD, *(at - now for at, _ in self._tries.values())]))

    def _bring_back(self, grid: GridSession) -> None:
        wanted = self.files.wanted()
        specs = {name: spec for name, spec in self.files.specs().items() if spec and name in wanted}
        states = grid.states(specs)
        now = time.monotonic()
        for name in in_order({name: spec.process.after for name, spec in specs.items()}):
            if states[name][0] != "Inactive":
                self._tries.pop(name, None)
                continue
            at, delay = self._tries.get(name, (now, _SHORTEST / 2))
            if at > now or is_over(grid, name, here=is_here(specs[name].address)):
                continue
            self._tries[name] = (now + min(2 * delay, _LONGEST), min(2 * delay, _LONGEST))
            if name not in self.files.wanted():
                continue  # it was stopped meanwhile
            try:
                grid.start(name)
                terminal.say(f"{name}: started again", err=True)
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
    # Signals are seen by the main thread, which must not be deep in a call then.
    worker = threading.Thread(target=keeper.run, daemon=True)
    worker.start()
    while worker.is_alive():
        worker.join(0.2)
        if keeper.over.is_set():
            worker.join(2)
            return


if __name__ == "__main__":
    main(sys.argv[1])
