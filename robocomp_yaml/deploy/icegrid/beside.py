"""A command run beside a process, on its host: a server of its own, for as long as it takes."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable, Collection
from typing import Any

from msgspec.structs import replace

from robocomp_yaml.deploy.icegrid import descriptors
from robocomp_yaml.deploy.icegrid.grid import Grid, GridFailed
from robocomp_yaml.deploy.icegrid.status import told
from robocomp_yaml.deploy.local.obstacles import is_here
from robocomp_yaml.deploy.spec import Spec
from robocomp_yaml.network.network import NEVER, PROGRAM, Restart

_TIMED_OUT, _NOT_FOUND, _UNKNOWN = 124, 127, 1
_CODE = "exit code "


def run_beside(
    grid: Grid, spec: Spec, command: tuple[str, ...], within: float, lock: threading.Lock,
    deploy: Callable[[Collection[str], list[tuple[str, Any]]], None],
) -> int:  # fmt: skip
    """Its exit code; `deploy` replaces servers, under the lock."""
    host, here = spec.process.host, is_here(spec.address)
    name = f"{spec.name}.ready"
    process = replace(spec.process, name=name, kind=PROGRAM, config=None, folders=(), restart=Restart(NEVER))
    own = replace(spec, process=process, command=command)
    server = descriptors.server(grid.places, own, grid.user_of(host), 0, is_here=here)
    with lock:
        deploy([name], [(host, server)])
    try:
        if not grid.run(name, within):
            grid.stop(name)
            return _TIMED_OUT
        last = told(grid, name, here=here)
        code = last.last_exit.removeprefix(_CODE) if last else ""
        return int(code) if code.isdigit() else _UNKNOWN
    except GridFailed:
        return _NOT_FOUND
    finally:
        with lock:
            deploy([name], [])
        if here:
            for path in (grid.places.status(name), grid.places.log(name)):
                with contextlib.suppress(OSError):
                    os.unlink(path)
