"""What carrying out a plan would do to the disk, file by file: for reports, `--dry-run`, `--diff` and `--check`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.source.properties import without_secret
from robocomp_yaml.transactions.atomic import Step
from robocomp_yaml.transactions.journal import JOURNAL, JOURNAL_DONE

CREATE, UPDATE, ADOPT, EDITED, MERGE = "create", "update", "adopt", "edited", "merge"
REMOVE, UNCHANGED, KEPT, LEFT, REFUSED = "remove", "unchanged", "kept", "left", "refused"
"""What happens to a file.

EDITED: someone changed a generated file; their version is kept under `orig`, ours is written (or, where it is no longer
generated, nothing is). MERGE: it is the user's, with what a new skeleton brings. ADOPT: it was there before rcyaml, and
is kept under `orig` likewise. KEPT: it is the user's, and stays. LEFT: it is the user's, and no document asks for it
any more. REFUSED: it stays as it is, as a diagnostic says.
"""

WRITING = (CREATE, UPDATE, ADOPT, EDITED, MERGE, REMOVE)


class Change(msgspec.Struct, frozen=True):
    """What happens to one file. `path` can be opened from the user's folder, `orig` too ('' where nothing is kept).
    `secrets` are properties in it that are not to be shown."""

    path: str
    action: str
    before: bytes | None = None
    after: bytes | None = None
    orig: str = ""
    secrets: tuple[str, ...] = ()

    def diff(self, *, properties: bool = False) -> str:
        """A unified diff, which `patch` takes: bytes that are no text stay what they are. Where the lines of the file
        are `properties`, secrets in them are hidden."""
        before, after = ((data or b"").decode("utf-8", "surrogateescape") for data in (self.before, self.after))
        found = unified(
            before,
            after,
            os.devnull if self.before is None else f"a/{self.path}",
            os.devnull if self.after is None else f"b/{self.path}",
        )
        if not properties or not found:
            return found
        old, new, *lines = found.split("\n")
        return "\n".join((old, new, *map(self._shown, lines)))

    def _shown(self, line: str) -> str:
        if line[:1] not in (" ", "+", "-"):
            return line
        return "".join((line[0], *secrets.hidden_lines(without_secret(line[1:], self.secrets), self.secrets)))


class RootChanges(msgspec.Struct, frozen=True):
    """The changes below one output root, with the steps that make them. A `refused` root has no steps.

    `settled` are the files that then hold what rcyaml wrote, with their content; `once` those that must only exist.
    """

    root: str
    real: str
    changes: tuple[Change, ...] = ()
    steps: tuple[Step, ...] = ()
    settled: Mapping[str, bytes] = {}
    once: tuple[str, ...] = ()
    refused: bool = False

    def as_refused(self) -> RootChanges:
        """The same where nothing of this root is written."""
        changes = [replace(c, action=REFUSED, orig="") if c.action in WRITING else c for c in self.changes]
        return replace(self, changes=tuple(changes), steps=(), refused=True)


class Changes(msgspec.Struct, frozen=True):
    """What happens below all roots, and what there is to say of it."""

    roots: tuple[RootChanges, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    def __iter__(self) -> Iterator[Change]:
        for root in self.roots:
            yield from root.changes

    @property
    def dirty(self) -> bool:
        """Whether a file that a user sees would change."""
        return any(change.action in (*WRITING, REFUSED) for change in self)

    @property
    def settled(self) -> dict[str, bytes]:
        """What rcyaml's own files hold when all is done, manifests too; paths as the user can open them."""
        return {os.path.join(root.root, path): text for root in self.roots for path, text in root.settled.items()}

    @property
    def once(self) -> list[str]:
        """The user's own files, of which only the presence counts."""
        return [os.path.join(root.root, path) for root in self.roots for path in root.once]

    @property
    def journals(self) -> list[str]:
        """Where an interrupted commit would have left its journal."""
        return [os.path.join(root.root, name) for root in self.roots for name in (JOURNAL, JOURNAL_DONE)]


def unified(before: str, after: str, old: str, new: str) -> str:
    """The difference of two texts, as a unified diff of the files `old` and `new`."""
    import difflib  # asked for with --diff only

    return "".join(difflib.unified_diff(_lines(before), _lines(after), old, new))


def _lines(text: str) -> list[str]:
    """With ends, the last one too: a file without one shows as the text it is."""
    *lines, last = text.split("\n")
    return [*(f"{line}\n" for line in lines), *([f"{last}\n\\ No newline at end of file\n"] if last else [])]
