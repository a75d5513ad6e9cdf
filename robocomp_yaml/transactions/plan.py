"""Plans: the files to write below some folders, with text and policy. Pure data, which `writer` applies."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable

import msgspec

ALWAYS, ONCE = "always", "once"

ANYBODY = 0o066
"""The permissions of others for a file without secrets."""


class FilePlan(msgspec.Struct, frozen=True):
    """One file below an output root. `path` is relative, with '/'. `policy` ALWAYS: a generated file, rewritten when it
    changes. ONCE: written if it is missing, then the user's. `sources` are the documents that the file is made of: who
    cannot read one of them cannot read the file. `secrets` are the keys of its properties that are never shown.
    `stated_in`, for a property file, is the path of the user's document from which the file is generated. Properties
    that would be lost, `users`, have to be moved to that document; as long as there are any, the file stays. `base` are
    those of its properties that no document states, and `beside` is the text of another property file that programs
    read before it. `accepted`, for code of the user, is code with signatures that are right, too. `takes_over`: another
    tool may have written the file, which is overwritten, and kept as `.orig`."""

    path: str
    text: str
    policy: str = ALWAYS
    executable: bool = False
    sources: tuple[str, ...] = ()
    secrets: tuple[str, ...] = ()
    stated_in: str = ""
    users: tuple[str, ...] = ()
    base: str = ""
    beside: str = ""
    accepted: str = ""
    takes_over: bool = False


def rights_of(sources: Iterable[str]) -> int:
    """The permissions that group and others may have at most for a file made of these documents: none if they cannot
    read one of the documents."""
    rights = ANYBODY
    for source in sources:
        with contextlib.suppress(OSError):
            mode = os.stat(source).st_mode
            rights &= (0o060 if mode & 0o040 else 0) | (0o006 if mode & 0o004 else 0)
    return rights


class Merge(msgspec.Struct, frozen=True):
    """The merge of a user's file: `before` is its content so far, `base` what a later merge starts from."""

    before: bytes
    text: bytes
    base: bytes


class Merges(msgspec.Struct, frozen=True):
    """Merges by real root and path. Nothing may be written into a `refused` root."""

    files: dict[tuple[str, str], Merge] = {}
    refused: set[str] = set()


class RootPlan(msgspec.Struct, frozen=True):
    """All files that one owner (the path of a document relative to `root`, with '/') has below the folder `root`.

    `partial`: only some of them were requested (one target of several). The others are kept.
    """

    root: str
    owner: str
    files: tuple[FilePlan, ...] = ()
    partial: bool = False
