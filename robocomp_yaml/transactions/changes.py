"""The changes that a plan makes on the disk, file by file: for reports, `--dry-run`, `--diff` and `--check`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.source.properties import without_secret
from robocomp_yaml.transactions.atomic import FileStep
from robocomp_yaml.transactions.journal import JOURNAL, JOURNAL_DONE
from robocomp_yaml.transactions.manifest import PATH

CREATE, UPDATE, ADOPT, EDITED, MERGE = "create", "update", "adopt", "edited", "merge"
REMOVE, UNCHANGED, KEPT, LEFT, REFUSED = "remove", "unchanged", "kept", "left", "refused"
"""What happens to a file.

EDITED: somebody edited a generated file. The edited version is kept under `orig`, and the file is generated again,
unless no document generates it any more. MERGE: a user's file, merged with a new skeleton. ADOPT: a user's file becomes
a generated one, and is kept under `orig`. KEPT: a user's file, unchanged. LEFT: a user's file, unchanged, which no
document needs any more. REFUSED: unchanged, for the reason that a diagnostic reports.
"""

WRITING = (CREATE, UPDATE, ADOPT, EDITED, MERGE, REMOVE)


class Change(msgspec.Struct, frozen=True):
    """What happens to one file. `path` and `orig` ('' if nothing is kept) can be opened from the working folder.
    `secrets` are the keys of its properties that are never shown."""

    path: str
    action: str
    before: bytes | None = None
    after: bytes | None = None
    orig: str = ""
    secrets: tuple[str, ...] = ()

    def diff(self, *, properties: bool = False) -> str:
        """A unified diff for `patch`, '' if nothing changes. Bytes that are not UTF-8 are kept as surrogates. If the
        file consists of `properties`, secrets are hidden."""
        before, after = ((data or b"").decode("utf-8", "surrogateescape") for data in (self.before, self.after))
        old_name = os.devnull if self.before is None else f"a/{self.path}"
        new_name = os.devnull if self.after is None else f"b/{self.path}"
        text = unified(before, after, old_name, new_name)
        if not properties or not text:
            return text
        old, new, *lines = text.split("\n")
        return "\n".join((old, new, *map(self._shown, lines)))

    def _shown(self, line: str) -> str:
        if line[:1] not in (" ", "+", "-"):
            return line
        return "".join((line[0], *secrets.hidden_lines(without_secret(line[1:], self.secrets), self.secrets)))


class RootChanges(msgspec.Struct, frozen=True):
    """The changes below one output root, with the steps that make them. A `refused` root has no steps.

    `settled` are the generated files, with the digests of their contents after the changes; `once` are the user's
    files, which must exist.
    """

    root: str
    real: str
    changes: tuple[Change, ...] = ()
    steps: tuple[FileStep, ...] = ()
    settled: Mapping[str, str] = {}
    once: tuple[str, ...] = ()
    refused: bool = False

    @property
    def head(self) -> str:
        """What to put before a path in this root, to open it from the working folder."""
        return "" if self.root == "." else os.path.join(self.root, "")

    def as_refused(self) -> RootChanges:
        """The same changes, with nothing written below this root."""
        changes = [replace(c, action=REFUSED, orig="") if c.action in WRITING else c for c in self.changes]
        return replace(self, changes=tuple(changes), steps=(), refused=True)


class Changes(msgspec.Struct, frozen=True):
    """The changes below all roots, with diagnostics."""

    roots: tuple[RootChanges, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    def __iter__(self) -> Iterator[Change]:
        for root in self.roots:
            yield from root.changes

    @property
    def dirty(self) -> bool:
        """Whether a file changes that is not internal."""
        return any(change.action in (*WRITING, REFUSED) for change in self)

    @property
    def has_other_roots(self) -> bool:
        """Whether a folder gets its first manifest, or loses its manifest."""
        steps = (step for root in self.roots for step in root.steps if step.path == PATH)
        return any(step.before is None or step.after is None for step in steps)

    @property
    def settled(self) -> dict[str, str]:
        """The digests of generated files and manifests after the changes, by paths from the working folder."""
        return {
            head + path: hash_ for root in self.roots for head in (root.head,) for path, hash_ in root.settled.items()
        }

    @property
    def once(self) -> list[str]:
        """The user's files, which must exist with any content."""
        return [head + path for root in self.roots for head in (root.head,) for path in root.once]

    @property
    def journals(self) -> list[str]:
        """The paths at which an interrupted commit leaves its journal."""
        return [os.path.join(root.root, name) for root in self.roots for name in (JOURNAL, JOURNAL_DONE)]


def unified(before: str, after: str, old: str, new: str) -> str:
    """The difference of two texts, as a unified diff of the files `old` and `new`."""
    import difflib  # only --diff needs it

    return "".join(difflib.unified_diff(_lines(before), _lines(after), old, new))


def _lines(text: str) -> list[str]:
    """The lines with their ends, as a unified diff shows them: a missing line feed at the end is marked."""
    *lines, last = text.split("\n")
    return [*(f"{line}\n" for line in lines), *([f"{last}\n\\ No newline at end of file\n"] if last else [])]
