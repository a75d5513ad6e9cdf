"""The real compilers of Slice, asked about many files at once: slice2cpp, slice2py and Ice.loadSlice."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import pytest

LOAD = """
import sys, Ice
for name in sys.argv[1:]:
    print(f"{name}:1: loading", file=sys.stderr, flush=True)
    try:
        Ice.loadSlice("", ["-I.", "--all", "--checksum", name])
    except BaseException as error:
        print(f"{name}:1: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
"""

needs_compilers = pytest.mark.skipif(
    subprocess.run(["which", "slice2cpp", "slice2py"], capture_output=True).returncode != 0,
    reason="Ice's Slice compilers are not installed: apt-get install zeroc-ice-compilers",
)


def complaints(folder: Path, names: Iterable[str]) -> dict[str, list[str]]:
    """What any of the compilers, or Python over what slice2py wrote, says against each of these files of a folder."""
    names, said = list(names), defaultdict(list)
    (folder / "out").mkdir(exist_ok=True)
    for command in (
        ["slice2cpp", "-I.", "--output-dir", "out", *names],
        ["slice2py", "-I.", "--output-dir", "out", *names],
        [sys.executable, "-c", LOAD, *names],
    ):
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
        for line in done.stderr.splitlines():
            if (place := re.match(r"(?:.*/)?([^/:]+\.ice):\d+: (.*)", line)) and place[2] != "loading":
                said[place[1]].append(f"{Path(command[0]).name}: {place[2]}")
        if done.returncode and not said:
            said["?"].append(f"{command[0]} ended with {done.returncode}: {done.stderr[-500:]}")
    for written in (folder / "out").glob("*_ice.py"):
        try:
            compile(written.read_text(encoding="utf-8"), written.name, "exec")
        except SyntaxError as error:
            said[f"{written.stem.removesuffix('_ice')}.ice"].append(f"python: {error}")
    return dict(said)
