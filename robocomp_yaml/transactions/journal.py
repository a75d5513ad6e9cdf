"""The journal of a running commit: enough to put an output root back as it was, by this process or by the next one.

A commit writes the journal first, stages each new file beside its target as `.rcyaml-PID-N.new`, gives what stands
there a second name `.rcyaml-PID-N.old`, and only then moves files into place. Renaming the journal to JOURNAL_DONE is
the moment from which the new state counts.
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
"""Ends the name of a copy that is not complete yet."""


class Mark(msgspec.Struct, frozen=True):
    """One file of a commit; paths are relative to the root, '' where there is none. `hash` is that of the new
    content. `created` when nothing stood at the path before."""

    path: str
    new: str
    old: str
    orig: str
    hash: str
    created: bool


class Journal(msgspec.Struct, frozen=True):
    """`folders` are those that the commit makes, outer ones first."""

    marks: tuple[Mark, ...]
    folders: tuple[str, ...] = ()

    def save(self, root: str) -> None:
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        with os.fdopen(os.open(os.path.join(root, JOURNAL), flags, 0o666), "w", encoding="utf-8") as file:
            file.write(json.dumps(msgspec.to_builtins(self)))


def load(root: str) -> tuple[Journal | None, bool]:
    """The journal that a dead commit left here, and whether that commit had come to its end."""
    for name, done in ((JOURNAL, False), (JOURNAL_DONE, True)):
        try:
            journal = msgspec.convert(json.loads(contents(os.path.join(root, name))), Journal)
        except FileNotFoundError:
            continue
        except (OSError, ValueError, RecursionError):
            # Cut short: the process died while it wrote the journal, before it touched anything else.
            journal = Journal(())
        return journal if _is_sound(journal, Root(root)) else Journal(()), done
    return None, False


def _is_sound(journal: Journal, root: Root) -> bool:
    """Whether a commit can have written this. One that came with somebody's repository shall move and remove no file
    that is not ours."""
    for mark in journal.marks:
        names = (mark.path, mark.new, mark.old, mark.orig)
        if not mark.path:
            return False
        if not all(not name or re.fullmatch(_STAGED, os.path.basename(name)) for name in (mark.new, mark.old)):
            return False
        if mark.orig and not mark.orig.startswith(f"{mark.path}.orig"):
            return False
        if any(name and root.look(name, read=False).outside for name in names):
            return False
    return all(not root.look(name, read=False).outside for name in journal.folders)


def put_back(root: str, journal: Journal) -> None:
    """Undoes all that the journal names, whatever part of it was done. A file that someone changed since is kept."""
    for mark in reversed(journal.marks):
        _undo(root, mark)
    for folder in reversed(journal.folders):
        with contextlib.suppress(OSError):
            os.rmdir(os.path.join(root, folder))
    _drop(os.path.join(root, JOURNAL))
    _drop(os.path.join(root, JOURNAL_DONE))


def clean_up(root: str, journal: Journal) -> None:
    """Removes what a finished commit needs no more, and the folders that it left empty."""
    for mark in journal.marks:
        for name in (mark.new, mark.old):
            if name:
                _drop(os.path.join(root, name))
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
    # Where both are names of one file, replacing does nothing and leaves the second name.
    for name in (old, old + PART, orig + PART, new):
        if name not in ("", PART):
            _drop(name)


def _changed_since(target: str, old: str, new_hash: str) -> bool:
    """Whether someone wrote the target after the commit stopped: it is neither what was there nor what came."""
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
    """A name under which what stands at `path` can be kept: `.orig`, or the first of `.orig.1`, … that is free."""
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
