"""The end of a deployment on hosts that did not answer to `down`: `python -m MODULE FOLDER HOST…`.

`down` starts this process if a host does not answer, and leaves the registry running. As soon as such a host is back,
its processes and its node are ended; after the last one, the registry. The next `up` ends this process.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Sequence
from contextlib import suppress

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy import registered, remains
from robocomp_yaml.deploy.icegrid import daemons
from robocomp_yaml.deploy.icegrid.failures import GridFailed
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.time_limit import until

_MODULE = "robocomp_yaml.deploy.icegrid.ending"
_FILE = "state/icegrid/ending"
_PERIOD = 2.0  # seconds between two checks whether a host is back
_ENDS_WITHIN = 5.0


def begin(files: GridFiles, hosts: Sequence[str]) -> None:
    """Starts the process for these hosts, and notes them in the user's list of deployments."""
    stop(files)
    one = registered.of_folder(files.folder)
    if one:
        with suppress(OSError):
            registered.keep(replace(one, pending=tuple(hosts)))
    path = os.pathsep.join(path for path in sys.path if path)
    command = [sys.executable, "-m", _MODULE, files.folder, *hosts]
    pid = daemons.start_detached(command, files.folder, PYTHONPATH=path)
    own_folder.write(files.folder, _FILE, f"{pid}\n")


def stop(files: GridFiles) -> None:
    """Ends the process, if it runs."""
    pid = daemons.pid_in(files.folder, _FILE)
    if pid is None:
        return
    if pid != os.getpid() and [_MODULE, files.folder] == procfs.command(pid)[2:4]:
        procfs.send(pid, signal.SIGKILL)
        until(lambda: procfs.entry(pid) is None, _ENDS_WITHIN)
    own_folder.remove(files.folder, _FILE)


def main(folder: str, pending: list[str]) -> None:
    from robocomp_yaml.deploy.icegrid import leftovers, start_up
    from robocomp_yaml.deploy.icegrid.grid import GridSession

    files = GridFiles(folder)
    grid = None
    while pending and (registry := files.registry()):
        try:
            grid = grid or GridSession(files, registry)
            leftovers.end_all(grid)
            for host in [host for host in pending if grid.has_node(host) and not leftovers.of_host(files, host)]:
                start_up.end_node(grid, host)
                pending.remove(host)
                if one := registered.of_folder(folder):
                    registered.keep(replace(one, pending=tuple(pending)))
        except (GridFailed, OSError):
            if grid:
                grid.close()
            grid = None
        if pending:
            time.sleep(_PERIOD)
    if grid:
        grid.close()
    start_up.end_here(files)
    own_folder.remove(folder, _FILE)
    registered.forget(folder)
    remains.after_down(folder)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
