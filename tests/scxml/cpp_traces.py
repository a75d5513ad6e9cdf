"""What C++'s interpreter makes of all machines of these tests: one program, built by the first test that asks."""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Callable
from dataclasses import asdict

import pytest

import engines
import w3c
from engines import Trace
from random_machines import odd_machines


@pytest.fixture
def in_cpp(tmp_path_factory: pytest.TempPathFactory) -> Callable[[], dict[str, Trace]]:
    """`in_cpp()`: each machine's trace by its name, also in another of pytest-xdist's processes."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "scxml-cpp"

    def traces() -> dict[str, Trace]:
        folder.mkdir(exist_ok=True)
        with (folder / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            kept = folder / "traces.json"
            if not kept.is_file():
                machines = odd_machines(folder / "odd")
                if w3c.FOLDER.is_dir():
                    cases = [w3c.read(name, "cpp", folder / "cases") for name in w3c.names()]
                    machines |= {case.name: case.machine for case in cases if case.machine is not None}
                found = engines.run_cpp(machines, folder / "program")
                kept.write_text(json.dumps({name: asdict(trace) for name, trace in found.items()}))
        return {name: Trace(**trace) for name, trace in json.loads(kept.read_text()).items()}

    return traces
