"""A terminal for tests: `rcyaml` on a pty, and what of its output would command one."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from conftest import ROOT
from robocomp_yaml.diag.terminal import shown

OURS = re.compile(r"\x1b\[[0-9;]*m|\x1b\[[0-9]+A\x1b\[J")
"""Our own colours, and the taking away of what is drawn."""

COMMAND = (sys.executable, "-m", "robocomp_yaml")


def environment(**more: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm", "COLUMNS": "200", **more}


def on_terminal(
    folder: Path, *args: str | bytes, act: Callable[[subprocess.Popen[bytes], int, bytes], None] | None = None,
    **more: str,
) -> tuple[int, str]:  # fmt: skip
    """The exit code of `rcyaml ARGS` and all that it writes to its terminal. `act` is called whenever something was
    written: it may type or send signals."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [*COMMAND, *args], cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, env=environment(**more),
        start_new_session=True,
    )  # fmt: skip
    os.close(theirs)
    seen = b""
    try:
        while True:
            try:
                seen += os.read(ours, 1 << 16)
            except OSError:  # the terminal was closed
                break
            if act:
                act(process, ours, seen)
        return process.wait(60), seen.decode("utf-8", "surrogateescape").replace("\r\n", "\n")
    finally:
        os.close(ours)
        if process.poll() is None:
            process.kill()
            process.wait()


def foreign(text: str, *, colors: bool = True) -> list[str]:
    """The lines of an output that hold what a terminal must not be given; our own colours may be there, if `colors`."""
    plain = OURS.sub("", text) if colors else text
    return [line for line in plain.split("\n") if line != shown(line, tabs=True)]
