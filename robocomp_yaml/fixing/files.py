"""Mended documents on the disk: each is written whole, or stays as it is, and nothing of anybody is lost."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Sequence

import msgspec

from robocomp_yaml.source.inside import stays_inside
from robocomp_yaml.source.regular import regular
from robocomp_yaml.transactions import whole_file


class Written(msgspec.Struct, frozen=True):
    """A document that was fixed, or, with a reason, was not. `before` and `after` are its contents."""

    path: str
    before: bytes
    after: bytes
    reason: str = ""


def write(paths: Sequence[str], changed: Iterable[tuple[str, bytes, bytes]], *, look_only: bool) -> list[Written]:
    """Writes what changed: path, contents that were read, and contents to be. `paths` are what the user asked for."""
    done = []
    for path, before, after in changed:
        reason = _refusal(paths, path, before)
        if not reason and not look_only:
            try:
                whole_file.replace(path, after)
            except OSError as error:
                reason = (error.strerror or str(error)).lower()
        done.append(Written(path, before, after, reason))
    return done


def _refusal(paths: Sequence[str], path: str, before: bytes) -> str:
    """Why a document is left as it is, or ''."""
    real = os.path.realpath(path)
    named = {os.path.realpath(asked) for asked in paths}
    if real not in named and not any(stays_inside(asked, real) for asked in paths if os.path.isdir(asked)):
        return f"a link leads out of what was asked for, to {real}: name that file to have it fixed"
    try:
        if not os.stat(real).st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(real, os.W_OK):
            return "it is read-only"
        with open(real, "rb", opener=regular) as file:
            if file.read() != before:
                return "it was changed meanwhile: check again"
    except OSError as error:
        return (error.strerror or str(error)).lower()
    return ""
