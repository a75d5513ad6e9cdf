"""The three-way merge of texts: with git if it is installed, else with merge3."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import tempfile

import msgspec
from msgspec.structs import replace

YOURS, BASE, NEW = "yours", "as generated before", "as generated now"
_OPEN, _OLD, _MIDDLE, _CLOSE = (mark * 7 for mark in "<|=>")
LF = "\n"
_SECONDS = 30  # longer than git needs for any file that somebody wrote


class Conflict(msgspec.Struct, frozen=True):
    """Lines that both sides changed: from line `first` to before line `end` of the user's text, from 0. `text` are both
    versions, with conflict markers."""

    first: int
    end: int
    text: str


class Merged(msgspec.Struct, frozen=True):
    """`text` is the merge, with the user's version of each conflict."""

    text: str
    conflicts: tuple[Conflict, ...] = ()


def merge(base: str, yours: str, new: str) -> Merged:
    """Combines the changes from `base` to `yours` with those from `base` to `new`."""
    if new == base or yours == new:
        return Merged(yours)
    if yours == base:
        return Merged(new)
    ended = [f"{text.removesuffix(LF)}{LF}" for text in (base, yours, new)]
    marked = _by_git(*ended) if _git() else None
    merged = _read(marked if marked is not None else _by_library(*ended), ended[1])
    return merged if yours.endswith(LF) else replace(merged, text=merged.text.removesuffix(LF))


@functools.cache
def _git() -> str | None:
    return shutil.which("git")


def _by_git(base: str, yours: str, new: str) -> str | None:
    """The merge, with markers around conflicts; None if git fails."""
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as folder:
        texts = {"yours": yours, "base": base, "new": new}
        for name, text in texts.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(text.encode())
        labels = [word for label in (YOURS, BASE, NEW) for word in ("-L", label)]
        command = [_git() or "git", "merge-file", "-p", "-q", "--diff3", *labels, *texts]
        # The user's configuration of git must not change the result.
        settings = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1", "GIT_DIR": f"{folder}/none"}
        try:
            done = subprocess.run(
                command, cwd=folder, env={**os.environ, **settings}, capture_output=True, timeout=_SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            return None
    return done.stdout.decode() if 0 <= done.returncode < 128 else None


def _by_library(base: str, yours: str, new: str) -> str:
    from merge3 import Merge3

    old, mine, theirs = (text.splitlines(keepends=True) for text in (base, yours, new))
    merged = Merge3(old, mine, theirs).merge_lines(
        name_a=YOURS, name_b=NEW, name_base=BASE, base_marker=_OLD, start_marker=_OPEN, mid_marker=_MIDDLE,
        end_marker=_CLOSE,
    )  # fmt: skip
    return "".join(merged)


def _read(marked: str, yours: str) -> Merged:
    """The merge in a text with conflict markers."""
    mine = yours.splitlines(keepends=True)
    kept: list[str] = []
    conflicts: list[Conflict] = []
    block: list[str] = []
    kept_side: list[str] = []
    side, at = "", 0
    for line in marked.splitlines(keepends=True):
        word = line.rstrip("\r\n")
        if not side and word == f"{_OPEN} {YOURS}":
            block, side, kept_side = [], _OPEN, []
        elif side and word == f"{_OLD} {BASE}":
            side = _OLD
        elif side and word == _MIDDLE:
            side = _MIDDLE
        elif side and word == f"{_CLOSE} {NEW}":
            first = _find(mine, kept_side, at)
            at = first + len(kept_side)
            conflicts.append(Conflict(first, at, "".join([*block, line])))
            kept += kept_side
            side = ""
            continue
        elif side == _OPEN:
            kept_side.append(line)
        elif not side:
            kept.append(line)
            at = _find(mine, [line], at, at) + 1 if line in mine[at:] else at
            continue
        block.append(line)
    return Merged("".join(kept), tuple(conflicts))


def _find(lines: list[str], searched: list[str], start: int, default: int | None = None) -> int:
    """The position at which these lines occur next, from `start`."""
    for at in range(start, len(lines) - len(searched) + 1):
        if lines[at : at + len(searched)] == searched:
            return at
    return start if default is None else default
