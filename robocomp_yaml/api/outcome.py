"""The result of a compile, as data."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors

if TYPE_CHECKING:
    from robocomp_yaml.transactions.changes import Changes

WRITTEN = ("create", "update", "adopt", "edited", "merge")
CHANGED = (*WRITTEN, "remove", "refused")


class File(msgspec.Struct, frozen=True):
    """One file, and what a compile does with it. `root` is the folder of its component, or the workspace's for Slice;
    `path` begins with it. `action` is `create`, `update`, `adopt` (a file that rcyaml did not write), `edited` (a
    generated file that was edited, and is written again), `merge`, `remove`, `refused`, `kept` or `left` (the user's),
    or `unchanged`. `orig` is the path of the backup of an earlier text, `diff` a unified diff if it was requested."""

    root: str
    path: str
    action: str
    orig: str = ""
    diff: str = ""


class Outcome(msgspec.Struct, frozen=True):
    """How many `documents` were read, and how many of them were `asked` for by the user. `left_out` are the requested
    documents that were skipped, by path: True if the document itself has errors. `planned` says that nothing was
    written. `to_build` are the components whose programs are stale now."""

    diagnostics: tuple[Diagnostic, ...]
    files: tuple[File, ...]
    documents: int
    asked: int
    left_out: dict[str, bool]
    planned: bool = False
    to_build: tuple[str, ...] = ()

    @property
    def has_errors(self) -> bool:
        return has_errors(self.diagnostics)

    @property
    def dirty(self) -> bool:
        """Whether a file that users see has changed, or would change."""
        return any(file.action in CHANGED for file in self.files)

    def as_data(self) -> dict[str, Any]:
        return msgspec.to_builtins(self)  # type: ignore[no-any-return]

    @classmethod
    def of_data(cls, data: dict[str, Any], *, planned: bool = False) -> Outcome:
        """The inverse of `as_data`. Raises ValueError if the data has another shape."""
        return msgspec.structs.replace(msgspec.convert(data, cls), planned=planned)

    def settled(self, lasting: Sequence[Diagnostic], changes: Changes) -> Outcome:
        """The outcome of the same compile when it is run again: nothing to write, and only the `lasting` diagnostics.
        It would not report removed files, nor files that have become the user's."""
        generated = {os.path.normpath(path) for path in changes.settled}
        users = {os.path.normpath(path) for path in changes.once}
        files = tuple(
            File(file.root, file.path, "unchanged" if file.path in generated else "kept")
            for file in self.files
            if file.path in generated or file.path in users
        )
        return Outcome(tuple(lasting), files, self.documents, self.asked, self.left_out)
