"""Renaming: one name of the documents, everywhere."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.api.edited import EditedDocument, write
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import NotRenamed, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.naming.renaming import NameEdit, renamed

if TYPE_CHECKING:
    from robocomp_yaml.api.workspace import Workspace
    from robocomp_yaml.pipeline import Analysis


class Renaming:
    """A name that becomes another one. Nothing is written before `apply`.

    `what` describes the name; `edits` are all changes, `left` are words in code that are spelled like the old name and
    stay; `written` are the files that change.
    """

    def __init__(
        self, before: Workspace, load: Callable[[Mapping[str, bytes]], Workspace], paths: Sequence[str],
        defined: DefinedName, name: str, names: Names | None = None,
    ) -> None:  # fmt: skip
        analysis = before.analysis
        made = renamed(analysis, names or names_of(analysis), defined, name, lambda texts: load(texts).analysis)
        self._paths, self._made = tuple(paths), made
        self._hidden = analysis.hidden
        self.what, self.name = f"{defined.kind} {defined.name}", name
        self.edits: tuple[NameEdit, ...] = made.edits
        self.left: tuple[Span, ...] = made.left
        self.written: tuple[EditedDocument, ...] = self._write(look_only=True)

    def diffs(self) -> Iterator[str]:
        """A unified diff of each file that changes, without secrets."""
        hidden = self._hidden()
        return (one.diff(hidden) for one in self.written)

    def apply(self) -> None:
        """Writes the files. Raises NotRenamed if one of them cannot be written, or has changed meanwhile: then none
        is."""
        for one in self._write(look_only=True):
            if one.reason:
                raise NotRenamed(f"{one.path}: {one.reason}")
        self.written = self._write(look_only=False)

    def _write(self, *, look_only: bool) -> tuple[EditedDocument, ...]:
        changed = ((path, self._made.before[path], after) for path, after in sorted(self._made.after.items()))
        return tuple(write(self._paths, changed, look_only=look_only))


def name_at(names: Names, analysis: Analysis, path: str, line: int, column: int) -> DefinedName:
    """The name at a location. Raises Refused if there is none."""
    document = analysis.documents.get(os.path.realpath(path))
    found = names.at(document.path if document is not None else path, line, column)
    if found is None:
        raise Refused(f"{path}:{line}:{column} is not a name of the documents")
    return found[1]


def name_called(names: Names, text: str) -> DefinedName:
    """The name that a text means: `Speech`, `Speech.say`, `camera.width`, or with its kind before it: `host:left`.
    Raises Refused unless it is one."""
    kind, _, path = text.rpartition(":")
    steps = path.split(".")
    found = [
        one for one in names.defined.values()
        if (not kind or one.kind.replace(" ", "-") == kind) and one.name == steps[-1] and _ends_with(one, steps)
    ]  # fmt: skip
    if len(found) == 1:
        return found[0]
    if not found:
        known = {one.name for one in names.defined.values()}
        raise Refused(f"unknown name '{text}'{meant(steps[-1], sorted(known))}")
    which = ", ".join(
        f"{one.kind.replace(' ', '-')} in {one.span.file}:{one.span.line}:{one.span.column}" for one in found[:8]
    )
    raise Refused(f"'{text}' means several names: {which}; pass one of these locations, or KIND:NAME")


def _ends_with(one: DefinedName, steps: Sequence[str]) -> bool:
    return len(steps) == 1 or one.key[2:][-len(steps) :] == tuple(steps)
