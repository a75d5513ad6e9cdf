"""Runs instead of the C++ compiler in builds of tests: an object that was compiled once, in any folder, is reused.

As a program: `kept_objects.py FOLDER COMPILER WORD…`, of which FOLDER is where objects are kept, for a week since they
were last of use. An object is known by its source after the preprocessor, and by the compiler and its words without
paths. What the compiler refused is not kept, and with `-Werror` it refuses what it warns of.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

_BEFORE_A_PATH = ("-o", "-c", "-I", "-isystem", "-MF", "-MT", "-MQ")
_WITH_A_PATH = ("-I", "-isystem", "-fmacro-prefix-map")
_WEEK = 7 * 24 * 3600


def compile_or_copy(folder: Path, command: list[str]) -> int:
    """The compiler's exit code."""
    made = Path(command[command.index("-o") + 1])
    text = subprocess.run(_preprocess(command), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    if text.returncode:
        return subprocess.run(command).returncode  # it prints its errors
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / hashlib.sha256(_identity(command) + text.stdout).hexdigest()
    with kept.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if kept.is_file():
            os.utime(kept)
            shutil.copyfile(kept, made)
            return 0
        code = subprocess.run(command).returncode
        if code == 0:
            part = kept.with_suffix(".part")
            shutil.copyfile(made, part)
            os.replace(part, kept)
            _forget_the_old(folder)
        return code


def _preprocess(command: list[str]) -> list[str]:
    """Writes the text to standard output, without the paths of its folder, and the dependencies to their file."""
    end = command.index("-o")
    return [*command[:end], *command[end + 2 :], "-E", "-P"]


def _identity(command: list[str]) -> bytes:
    compiler = os.stat(os.path.realpath(shutil.which(command[0]) or command[0]))
    words = [
        word for before, word in pairwise(command)
        if before not in _BEFORE_A_PATH and word not in _BEFORE_A_PATH and not word.startswith(_WITH_A_PATH)
    ]  # fmt: skip
    return repr((compiler.st_size, compiler.st_mtime_ns, words)).encode()


def _forget_the_old(folder: Path) -> None:
    for path in folder.iterdir():
        try:
            if path.stat().st_mtime < time.time() - _WEEK:
                path.unlink()
        except FileNotFoundError:
            continue  # another process has stored it first


if __name__ == "__main__":
    sys.exit(compile_or_copy(Path(sys.argv[1]), sys.argv[2:]))
