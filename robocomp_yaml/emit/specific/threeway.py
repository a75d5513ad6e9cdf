"""The three-way merge of texts: git's where there is git, else merge3's."""

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
_SECONDS = 30  # more than git takes for any file that someone wrote


class Conflict(msgspec.Struct, frozen=True):
    """Lines that both sides changed: where they stand in the user's text (from 0, the line behind them), and how."""

    first: int
    end: int
    text: str


class Merged(msgspec.Struct, frozen=True):
    """`text` is the merge, with the user's side of each conflict."""

    text: str
    conflicts: tuple[Conflict, ...] = ()


def merge(base: str, yours: str, new: str) -> Merged:
    """What became of `base` in both. A line that only one side changed is as that side has it."""
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
    """The merge with marks around conflicts; None where git does not do it."""
    with tempfile.TemporaryDirectory(prefix="rcyaml-") as folder:
        texts = {"yours": yours, "base": base, "new": new}
        for name, text in texts.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(text.encode())
        labels = [word for label in (YOURS, BASE, NEW) for word in ("-L", label)]
        command = [_git() or "git", "merge-file", "-p", "-q", "--diff3", *labels, *texts]
        # What the user configured for other merges does not count here.
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
    """A text with marks: the user's side of it, and each conflict."""
    mine = yours.splitlines(keepends=True)
    kept: list[str] = []
    conflicts: list[Conflict] = []
    block: list[str] = []
    ours: list[str] = []
    side, at = "", 0
    for line in marked.splitlines(keepends=True):
        word = line.rstrip("\r\n")
        if not side and word == f"{_OPEN} {YOURS}":
            block, side, ours = [], _OPEN, []
        elif side and word == f"{_OLD} {BASE}":
            side = _OLD
        elif side and word == _MIDDLE:
            side = _MIDDLE
        elif side and word == f"{_CLOSE} {NEW}":
            first = _find(mine, ours, at)
            at = first + len(ours)
            conflicts.append(Conflict(first, at, "".join([*block, line])))
            kept += ours
            side = ""
            continue
        elif side == _OPEN:
            ours.append(line)
        elif not side:
            kept.append(line)
            at = _find(mine, [line], at, at) + 1 if line in mine[at:] else at
            continue
        block.append(line)
    return Merged("".join(kept), tuple(conflicts))


def _find(lines: list[str], wanted: list[str], start: int, default: int | None = None) -> int:
    """Where these lines stand next."""
    for at in range(start, len(lines) - len(wanted) + 1):
        if lines[at : at + len(wanted)] == wanted:
            return at
    return start if default is None else default
