"""Edited documents: each is written completely or not at all, and never over a change of somebody else."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.regular import whole
from robocomp_yaml.transactions import whole_file
from robocomp_yaml.transactions.changes import unified


class EditedDocument(msgspec.Struct, frozen=True):
    """A document that changes. `before` and `after` are its contents; `reason` says why it was not written, '' if it
    was."""

    path: str
    before: bytes
    after: bytes
    reason: str = ""

    def diff(self, hidden: Hidden) -> str:
        """A unified diff, without secrets."""
        before, after = (content.decode("utf-8", "surrogateescape") for content in (self.before, self.after))
        return hidden.without(unified(before, after, f"a/{self.path}", f"b/{self.path}"))


def write(
    paths: Sequence[str], changed: Iterable[tuple[str, bytes, bytes]], *, look_only: bool
) -> Iterator[EditedDocument]:
    """Writes what changed: path, content that was read, new content. `paths` are the requested ones."""
    for path, before, after in changed:
        try:
            reason = _refusal(paths, path, before)
            if not reason and not look_only:
                whole_file.replace(path, after)
        except OSError as error:
            reason = reason_of(error)
        yield EditedDocument(path, before, after, reason)


def _refusal(paths: Sequence[str], path: str, before: bytes) -> str:
    """Why a document is not written, or ''. Raises OSError if it cannot be read."""
    real = os.path.realpath(path)
    named = {os.path.realpath(one) for one in paths}
    if real not in named and not any(stays_inside(one, real) for one in paths if os.path.isdir(one)):
        return f"a link leads to {real}, outside the requested paths: pass that file to have it changed"
    if not os.stat(real).st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(real, os.W_OK):
        return "it is read-only"
    return "" if whole(real)[0] == before else "it has changed meanwhile: run the check again"
