"""What is wanted below some folders: files, each with its text and its policy. Pure data; `writer` carries it out."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable

import msgspec

ALWAYS, ONCE = "always", "once"

ANYBODY = 0o066
"""The rights of a file that is nobody's secret."""


class FilePlan(msgspec.Struct, frozen=True):
    """One file below an output root. `path` is relative, with '/'. `policy` ALWAYS: ours, rewritten whenever it
    changes. ONCE: written if it is missing, then the user's. `sources` are documents that it is made of: who cannot
    read those cannot read it. `secrets` are properties in it that are not to be shown. `stated_in` is, of a property
    file, the path of the user's document that says what it holds: where to bring entries that would be lost."""

    path: str
    text: str
    policy: str = ALWAYS
    executable: bool = False
    sources: tuple[str, ...] = ()
    secrets: tuple[str, ...] = ()
    stated_in: str = ""


def rights_of(sources: Iterable[str]) -> int:
    """What others than the owner may do at most with a file that is made of these: nothing where they cannot read one
    of them."""
    rights = ANYBODY
    for source in sources:
        with contextlib.suppress(OSError):
            mode = os.stat(source).st_mode
            rights &= (0o060 if mode & 0o040 else 0) | (0o006 if mode & 0o004 else 0)
    return rights


class Merge(msgspec.Struct, frozen=True):
    """What becomes of a file of the user: `before` is what it held, and `base` what a later merge starts from."""

    before: bytes
    text: bytes
    base: bytes


class Merges(msgspec.Struct):
    """Merges by real root and path; in a `refused` root nothing may be written."""

    files: dict[tuple[str, str], Merge] = {}
    refused: set[str] = set()


class RootPlan(msgspec.Struct, frozen=True):
    """All that one owner (the path of a document relative to `root`, with '/') puts below the folder `root`.

    `partial` when only some of it was asked for (one target of several): what is not in `files` then stays.
    """

    root: str
    owner: str
    files: tuple[FilePlan, ...] = ()
    partial: bool = False
