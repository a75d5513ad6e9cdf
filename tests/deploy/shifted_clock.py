"""A clock that a test sets for the processes that it starts (see shifted_clock.c). The machine's clock is not
changed."""

from __future__ import annotations

import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

_SOURCE = Path(__file__).with_suffix(".c")


@dataclass(frozen=True)
class Clock:
    """`environment` is for processes with this clock."""

    path: Path
    environment: dict[str, str]

    def set(self, hours: float) -> None:
        """Sets the difference to the machine's clock."""
        with open(self.path, "r+b") as file:
            file.write(struct.pack("=q", int(hours * 3600)))


def make_clock(folder: Path) -> Clock:
    """Skips the test if the clock cannot be compiled."""
    compiler = shutil.which("cc")
    if compiler is None or sys.platform != "linux":
        pytest.skip("no C compiler here: the clock cannot be shifted for single programs")
    library, path = folder / "shifted_clock.so", folder / "shifted_clock"
    subprocess.run([compiler, "-O1", "-shared", "-fPIC", "-o", library, _SOURCE, "-ldl"], check=True)
    path.write_bytes(bytes(8))
    return Clock(path, {"LD_PRELOAD": str(library), "SHIFTED_CLOCK": str(path)})
