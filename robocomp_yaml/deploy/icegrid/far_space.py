"""Space for new configurations on other hosts, which is reserved before anything that runs is changed."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Mapping, Sequence

from robocomp_yaml.deploy.here import is_near
from robocomp_yaml.deploy.icegrid.grid_files import GridFiles
from robocomp_yaml.deploy.spec import ProcessSpec

_WRITE = 'head -c "$2" /dev/zero >"$1/.space"; code=$?; rm -f "$1/.space"; exit $code'
_WITHIN = 10.0  # seconds

Run = Callable[[ProcessSpec, tuple[str, ...], float], int]
"""Runs a command beside a process for so many seconds, and returns its exit code."""


def reserve(files: GridFiles, specs: Sequence[ProcessSpec], running: Mapping[str, ProcessSpec], run: Run) -> None:
    """Writes as much as the configurations of `specs` that replace those of `running` processes, once on each host, and
    removes it. Raises OSError if there is no space."""
    sizes: dict[str, int] = {}
    beside: dict[str, ProcessSpec] = {}
    for spec in specs:
        if not is_near(spec) and (known := running.get(spec.name)):
            beside[spec.process.host] = known
            size = sum(len(text.encode(errors="surrogateescape")) for text in spec.config_files.values())
            sizes[spec.process.host] = sizes.get(spec.process.host, 0) + size
    for host, known in beside.items():
        command = ("bash", "-c", _WRITE, "bash", f"{files.on(host).folder}/config", str(sizes[host]))
        if known.process.host == host and run(known, command, _WITHIN):
            raise OSError(errno.ENOSPC, f"{os.strerror(errno.ENOSPC)} on the host '{host}'", files.folder)
