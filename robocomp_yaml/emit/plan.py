"""The emit plan: files to be, each with its text and its policy. Pure data; `writer` carries it out."""

from __future__ import annotations

from dataclasses import dataclass, field

ALWAYS, ONCE = "always", "once"

CONFIG = "etc/config"


@dataclass(frozen=True, slots=True)
class FilePlan:
    """One file below an output root. `path` is relative, with '/'. `policy` ALWAYS: ours, rewritten whenever it
    changes. ONCE: written if it is missing, then the user's."""

    path: str
    text: str
    policy: str = ALWAYS
    executable: bool = False


@dataclass(frozen=True, slots=True)
class Merge:
    """What becomes of a file of the user: `before` is what it held, and `base` what a later merge starts from."""

    before: bytes
    text: bytes
    base: bytes


@dataclass(slots=True)
class Merges:
    """Merges by real root and path; in a `refused` root nothing may be written."""

    files: dict[tuple[str, str], Merge] = field(default_factory=dict)
    refused: set[str] = field(default_factory=set)


@dataclass(slots=True)
class RootPlan:
    """All that one owner (the path of a document relative to `root`, with '/') puts below the folder `root`.

    `partial` when only some of it was asked for (one target of several): what is not in `files` then stays.
    """

    root: str
    owner: str
    files: list[FilePlan] = field(default_factory=list)
    partial: bool = False
