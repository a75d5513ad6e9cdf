"""Documents in the normal layout, as data."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from robocomp_yaml.api.edited import EditedDocument, write
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.source import text
from robocomp_yaml.source.discover import WORKSPACE_FILE, discover
from robocomp_yaml.source.formatting import Unformattable, formatted, same_content
from robocomp_yaml.source.tree import parse


class Formatting:
    """What formatting documents comes to. Nothing is written before `apply`.

    `documents` are the paths of those that were looked at, `written` those that change (with a reason those that
    cannot be written, or laid out), `diagnostics` what keeps others from being understood.
    """

    def __init__(self, paths: Sequence[str]) -> None:
        self._paths = tuple(paths)
        named = [path for path in paths if os.path.basename(path) == WORKSPACE_FILE and os.path.isfile(path)]
        found = discover([path for path in paths if path not in named])
        settings = {
            os.path.normpath(os.path.join(folder, WORKSPACE_FILE)) for folder in found.folders
        }  # fmt: skip
        self.documents = (*found.documents, *named, *sorted(path for path in settings if os.path.isfile(path)))
        self.diagnostics: tuple[Diagnostic, ...] = found.diagnostics
        self._unformattable: list[EditedDocument] = []
        self._changed = list(self._laid_out())
        self.written = self._write(look_only=True)

    @property
    def has_errors(self) -> bool:
        return has_errors(self.diagnostics) or any(one.reason for one in self.written)

    def diffs(self) -> Iterator[str]:
        """A unified diff of each document that changes, with secrets hidden."""
        from robocomp_yaml.pipeline import analyse  # which parameters are secret, other documents say

        hidden = analyse(self._paths).hidden() if self.written else Hidden()
        return (one.diff(hidden) for one in self.written if not one.reason)

    def apply(self) -> None:
        """Writes the documents, each whole or not at all; one that was changed meanwhile, or cannot be written, stays
        as it is."""
        self.written = self._write(look_only=False)

    def _write(self, *, look_only: bool) -> tuple[EditedDocument, ...]:
        return (*write(self._paths, self._changed, look_only=look_only), *self._unformattable)

    def _laid_out(self) -> Iterator[tuple[str, bytes, bytes]]:
        for path in self.documents:
            raw, faults = text.read_bytes(path)
            if raw is None:
                self.diagnostics += tuple(faults)
                continue
            after, faults = layout(path, raw)
            self.diagnostics += tuple(faults)
            if isinstance(after, Unformattable):
                self._unformattable.append(EditedDocument(path, raw, raw, str(after)))
            elif after is not None and after != raw:
                yield path, raw, after


def layout(path: str, raw: bytes) -> tuple[bytes | Unformattable | None, list[Diagnostic]]:
    """A document in the normal layout, or why there is none: what is wrong with it, or what cannot be laid out."""
    before, faults = text.decode(path, raw)
    if before is None:
        return None, faults
    tree, faults = parse(path, before)
    if tree is None:
        return (b"" if not before.strip() else None), [one for one in faults if before.strip()]
    if has_errors(faults):
        return None, faults
    try:
        after = formatted(before)
    except Unformattable as error:
        return error, []
    if not same_content(tree, parse(path, after)[0]):
        return Unformattable("it would not say the same"), []
    return after.encode(), []
