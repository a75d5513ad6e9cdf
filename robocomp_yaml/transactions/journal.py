"""The journal of a running commit, with which this process or the next one can roll it back.

A commit first writes the journal. It stages each new file beside its target as `.rcyaml-PID-N.new`, and gives the
existing file a second name, `.rcyaml-PID-N.old`. Then it moves the new files into place. The commit is complete when
the journal is renamed to JOURNAL_DONE.
"""

from __future__ import annotations

import contextlib
import json
import os
import re

import msgspec

from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions.output_root import STATE, Root, contents

JOURNAL = f"{STATE}/journal.json"
JOURNAL_DONE = f"{STATE}/journal.done"
_STAGED = r"\.rcyaml-[0-9]+-[0-9]+\.(new|old)"
PART = "~"
"""The suffix of an incomplete copy."""


class Mark(msgspec.Struct, frozen=True):
    """One file of a commit. Paths are relative to the root, '' for none. `hash` is the digest of the new content, ''
    if the file is deleted. `created`: the path did not exist before."""

    path: str
    new: str
    old: str
    orig: str
    hash: str
    created: bool


class Journal(msgspec.Struct, frozen=True):
    """`folders` are those that the commit creates, the outermost first."""

    marks: tuple[Mark, ...]
    folders: tuple[str, ...] = ()

    def save(self, root: str) -> None:
        """Creates the file of the journal. Raises OSError."""
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        with os.fdopen(os.open(os.path.join(root, JOURNAL), flags, 0o666), "w", encoding="utf-8") as file:
            file.write(json.dumps(msgspec.to_builtins(self)))


def load(root: str) -> tuple[Journal | None, bool]:
    """The journal that an interrupted commit left, and whether that commit was complete."""
    for name, done in ((JOURNAL, False), (JOURNAL_DONE, True)):
        try:
            journal = msgspec.convert(json.loads(contents(os.path.join(root, name))), Journal)
        except FileNotFoundError:
            continue
        except (OSError, ValueError, RecursionError):
            # The process died while it wrote the journal, before it changed anything else.
            journal = Journal(())
        return journal if _is_valid(journal, Root(root)) else Journal(()), done
    return None, False


def _is_valid(journal: Journal, root: Root) -> bool:
    """Whether a commit can have written this journal. A journal from a repository must not move or delete files that
    rcyaml did not write."""
    for mark in journal.marks:
        names = (mark.path, mark.new, mark.old, mark.orig)
        if not mark.path:
            return False
        if not all(not name or re.fullmatch(_STAGED, os.path.basename(name)) for name in (mark.new, mark.old)):
            return False
        if mark.orig and not mark.orig.startswith(f"{mark.path}.orig"):
            return False
        if any(name and root.status(name, read=False).outside for name in names):
            return False
    return all(not root.status(name, read=False).outside for name in journal.folders)


def put_back(root: str, journal: Journal) -> None:
    """Rolls a commit back, whatever part of it was done. A file that was changed since is kept."""
    for mark in reversed(journal.marks):
        _undo(root, mark)
    for folder in reversed(journal.folders):
        with contextlib.suppress(OSError):
            os.rmdir(os.path.join(root, folder))
    _drop(os.path.join(root, JOURNAL))
    _drop(os.path.join(root, JOURNAL_DONE))


def clean_up(root: str, journal: Journal) -> None:
    """Removes the earlier files of a complete commit, and the folders that it left empty. New files are in place."""
    for mark in journal.marks:
        if mark.old:
            _drop(os.path.join(root, mark.old))
        if not mark.hash:
            _remove_empty_folders(root, mark.path)
    _drop(os.path.join(root, JOURNAL_DONE))
    with contextlib.suppress(OSError):
        os.rmdir(os.path.join(root, STATE))


def _undo(root: str, mark: Mark) -> None:
    target, new, old, orig = (
        os.path.join(root, name) if name else "" for name in (mark.path, mark.new, mark.old, mark.orig)
    )
    if old and os.path.lexists(old):
        if _changed_since(target, old, mark.hash):
            if not (orig and os.path.lexists(orig)):
                os.replace(old, free_name(target))
        else:
            os.replace(old, target)
            if orig and os.path.lexists(orig) and _same(orig, target):
                os.unlink(orig)
    elif mark.created and new and not os.path.lexists(new) and _digest_of(target) == mark.hash:
        os.unlink(target)
    # If both are names of one file, os.replace does nothing, and the second name remains.
    for name in (old, old + PART, orig + PART, new):
        if name not in ("", PART):
            _drop(name)


def _changed_since(target: str, old: str, new_hash: str) -> bool:
    """Whether the target was changed after the commit stopped: it has neither the old nor the new content."""
    return os.path.lexists(target) and not _same(target, old) and _digest_of(target) != new_hash


def _same(one: str, other: str) -> bool:
    if os.path.samestat(os.lstat(one), os.lstat(other)):
        return True
    if os.path.islink(one) or os.path.islink(other):
        return os.path.islink(one) and os.path.islink(other) and os.readlink(one) == os.readlink(other)
    return _digest_of(one) == _digest_of(other)


def _digest_of(path: str) -> str:
    try:
        return digest(contents(path))
    except OSError:
        return ""


def free_name(path: str) -> str:
    """A free name under which the file at `path` can be kept: `.orig`, or the first of `.orig.1`, `.orig.2`, …"""
    name, number = f"{path}.orig", 0
    while os.path.lexists(name):
        number += 1
        name = f"{path}.orig.{number}"
    return name


def _drop(path: str) -> None:
    with contextlib.suppress(FileNotFoundError):
        os.unlink(path)


def _remove_empty_folders(root: str, path: str) -> None:
    folder = os.path.dirname(path)
    with contextlib.suppress(OSError):
        while folder:
            os.rmdir(os.path.join(root, folder))
            folder = os.path.dirname(folder)
