"""What a compile came to, as data."""

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
    """One file and what becomes of it. `root` is the folder of its component, or the workspace's for Slice; `path`
    begins with it. `action` is `create`, `update`, `adopt` (a file that rcyaml did not write), `edited` (a generated
    file that was edited, and is written again), `merge`, `remove`, `refused`, `kept` or `left` (the user's), or
    `unchanged`. `orig` is where an earlier text is kept, `diff` a unified diff where it was asked for."""

    root: str
    path: str
    action: str
    orig: str = ""
    diff: str = ""


class Outcome(msgspec.Struct, frozen=True):
    """`documents` were looked at, `asked` of them named by the user; of these, some were `left_out`, by path: whether
    they have errors themselves. `planned` when nothing was written, since only a look was wanted. `to_build` are the
    components whose programs are older now than what they are made of."""

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
        """Whether a file that a user sees changed, or would."""
        return any(file.action in CHANGED for file in self.files)

    def as_data(self) -> dict[str, Any]:
        return msgspec.to_builtins(self)  # type: ignore[no-any-return]

    @classmethod
    def of_data(cls, data: dict[str, Any], *, planned: bool = False) -> Outcome:
        """The inverse of `as_data`. Raises ValueError."""
        return msgspec.structs.replace(msgspec.convert(data, cls), planned=planned)

    def settled(self, lasting: Sequence[Diagnostic], changes: Changes) -> Outcome:
        """The outcome of the same run made again: nothing left to write, and only the `lasting` diagnostics. What is
        gone, or is the user's alone from now on, it would not see."""
        ours = {os.path.normpath(path) for path in changes.settled}
        users = {os.path.normpath(path) for path in changes.once}
        files = tuple(
            File(file.root, file.path, "unchanged" if file.path in ours else "kept")
            for file in self.files
            if file.path in ours or file.path in users
        )
        return Outcome(tuple(lasting), files, self.documents, self.asked, self.left_out)
