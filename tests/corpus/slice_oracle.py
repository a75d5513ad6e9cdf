"""Slice files according to Ice: the checksum of every type that a file and its includes define."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

# One process per file, because loaded types remain in a process; forked, so that Ice is imported once.
_SCRIPT = """
import json, os, sys
import Ice
known = set(Ice.sliceChecksums)
folders, files = json.load(sys.stdin)
for file in files:
    reader, writer = os.pipe()
    if os.fork() == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        try:
            Ice.loadSlice("", ["--checksum", "--all", "--ice", *("-I" + folder for folder in folders), file])
            answer = {name: sum for name, sum in Ice.sliceChecksums.items() if name not in known}
        except Exception:  # RuntimeError if the compiler rejects a file, SyntaxError if its Python is not valid
            answer = None
        os.write(writer, json.dumps(answer).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        print(json.dumps([file, json.loads(pipe.read())]))
    os.wait()
"""


def checksums(files: Iterable[Path], *include: Path) -> dict[str, dict[str, str] | None]:
    """Return by each file's name the checksum of each type, or None where the Slice compiler rejects the file."""
    told = subprocess.run(
        [sys.executable, "-c", _SCRIPT], input=json.dumps([list(map(str, include)), list(map(str, files))]),
        stdout=subprocess.PIPE, text=True, check=True, timeout=300,
    ).stdout  # fmt: skip
    return {Path(file).name: sums for file, sums in map(json.loads, told.splitlines())}
