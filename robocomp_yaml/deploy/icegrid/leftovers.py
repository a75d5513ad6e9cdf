"""Leftovers: processes that may still run on a host that did not answer when they were moved or removed.

IceGrid forgets a server immediately, and the node does not end it when the host is back. Each such process is noted as
an empty file `left/HOST/PROCESS`, and the keeper ends it as soon as the host answers.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from typing import Any

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy.icegrid import descriptors
from robocomp_yaml.deploy.icegrid.failures import GridFailed
from robocomp_yaml.deploy.icegrid.grid import GridSession
from robocomp_yaml.deploy.icegrid.grid_files import KEEPER, GridFiles
from robocomp_yaml.network.network import PEM

_FOLDER = "state/icegrid/left"
_APPLICATION = f"{KEEPER}.left"
_WITHIN = 5.0


def note(files: GridFiles, host: str, name: str) -> None:
    """Notes a process of a host. Raises OSError."""
    own_folder.write(files.folder, f"{_FOLDER}/{host}/{name}", "")


def drop(files: GridFiles, host: str, name: str) -> None:
    """Removes the note: the process will run on that host again, or has been ended."""
    own_folder.remove(files.folder, f"{_FOLDER}/{host}/{name}")


def of_host(files: GridFiles, host: str) -> list[str]:
    return _listed(f"{files.folder}/{_FOLDER}/{host}")


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
    _run(grid, host, descriptors.ender(grid.files.on(host), names, grid.user_of(host)))


def _run(grid: GridSession, host: str, server: Any) -> None:
    grid.remove(_APPLICATION)
    grid.deploy(descriptors.application(_APPLICATION, [(host, server)]), is_new=True)
    try:
        grid.run(server.id, _WITHIN)
    finally:
        grid.remove(_APPLICATION)


def clean(
    grid: GridSession, host: str, names: Iterable[str] = (), *, everything: bool = False, with_key: bool = False
) -> None:  # fmt: skip
    """Removes configurations from a host that answers: those of these processes, or `everything`. `with_key` also
    removes the key of its node, which runs on without the file. A failure is ignored."""
    files = grid.files.on(host)
    own = f"{files.root}/nodes/{host}"
    paths = [f"{files.folder}/config/{name}{end}" for name in names for end in ("", PEM)]
    paths += [f"{files.folder}/config"] if everything else []
    paths += [f"{own}/key.pem", f"{own}/certificate.pem", f"{own}/settings"] if with_key else []
    if not paths:
        return
    with contextlib.suppress(GridFailed):
        _run(grid, host, descriptors.cleaner(paths, grid.user_of(host)))


def _listed(folder: str) -> list[str]:
    with contextlib.suppress(OSError):
        return sorted(os.listdir(folder))
    return []
