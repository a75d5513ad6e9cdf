"""Leftovers: processes that may still run on a host that did not answer when they were moved or removed.

IceGrid forgets a server immediately, and the node does not end it when the host is back. Each such process is noted as
an empty file `left/HOST/PROCESS`, and the keeper ends it as soon as the host answers.
"""

from __future__ import annotations

import contextlib
import os

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy.icegrid import descriptors
from robocomp_yaml.deploy.icegrid.grid import GridSession
from robocomp_yaml.deploy.icegrid.grid_files import KEEPER, GridFiles

_FOLDER = "state/icegrid/left"
_APPLICATION = f"{KEEPER}.left"
_WITHIN = 5.0


def note(files: GridFiles, host: str, name: str) -> None:
    """Notes a process of a host. Raises OSError."""
    own_folder.write(files.folder, f"{_FOLDER}/{host}/{name}", "")


def drop(files: GridFiles, host: str, name: str) -> None:
    """Removes the note: the process will run on that host again, or has been ended."""
    own_folder.remove(files.folder, f"{_FOLDER}/{host}/{name}")


def end_all(grid: GridSession) -> None:
    """Ends the noted processes of all hosts that answer. Raises GridFailed."""
    folder = f"{grid.files.folder}/{_FOLDER}"
    for host in _listed(folder):
        names = _listed(f"{folder}/{host}")
        if names and grid.has_node(host):
            _end(grid, host, names)
            for name in names:
                drop(grid.files, host, name)


def _end(grid: GridSession, host: str, names: list[str]) -> None:
    """Ends processes with a server for this only, in an application of its own, which no command changes."""
    server = descriptors.ender(grid.files, names, grid.user_of(host))
    grid.remove(_APPLICATION)
    grid.deploy(descriptors.application(_APPLICATION, [(host, server)]), is_new=True)
    try:
        grid.run(server.id, _WITHIN)
    finally:
        grid.remove(_APPLICATION)


def _listed(folder: str) -> list[str]:
    with contextlib.suppress(OSError):
        return sorted(os.listdir(folder))
    return []
