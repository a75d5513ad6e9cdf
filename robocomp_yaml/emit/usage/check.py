"""The diagnostics about the use that a component's code makes of its worker: reads src/, and judges it."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.emit.usage.judge import judge
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.transactions.output_root import Root

_LARGEST = 1_000_000  # bytes of a file, and
_MOST = 400  # files: more are not code that somebody wrote for this component


class UserSources(msgspec.Struct):
    """The code below src/: the texts by their paths there, and the names in all folders, by the paths for users."""

    texts: dict[str, str] = {}
    names: dict[str, list[str]] = {}


def sources(
    root: Root, suffixes: Collection[str], disk: Disk, instead: Mapping[str, bytes]
) -> UserSources | None:  # fmt: skip
    """The code of a component; `instead` has contents by paths below the root. None if there is too much, or if some
    cannot be read, so that nothing is certain."""
    found = UserSources()
    folders = [SOURCES]
    while folders:
        folder = folders.pop()
        try:
            found.names[root.shown(folder)] = names = sorted(os.listdir(f"{root.real}/{folder}"))
        except OSError:
            return None
        for name in names:
            path = f"{folder}/{name}"
            if name.startswith(".") or name == "__pycache__":
                continue
            if name.rpartition(".")[2] not in suffixes or "." not in name:
                if os.path.isdir(f"{root.real}/{path}") and not os.path.islink(f"{root.real}/{path}"):
                    folders.append(path)
                continue
            if root.status(path, read=False).problem or len(found.texts) >= _MOST:
                return None
            data, _ = disk.read(root.shown(path), _LARGEST)
            if data is None:
                return None
            try:
                found.texts[path.removeprefix(f"{SOURCES}/")] = instead.get(path, data).decode()
            except UnicodeDecodeError:
                return None
    return found


def check(linked: LinkedComponent, root: Root, found: UserSources) -> Iterator[Diagnostic]:
    """The diagnostics about the code of a component."""
    language = linked.component.language.target
    part = language.part("usage")
    offer = part.offer(linked)
    usage = part.read(found.texts, linked, offer)
    for one in judge(linked, usage, offer, config.existing(root.real)):
        yield _shown(one, root)


def _shown(diagnostic: Diagnostic, root: Root) -> Diagnostic:
    """The diagnostic with the paths that users see, not those below src/."""

    def shown(span: Span) -> Span:
        return replace(span, file=root.shown(f"{SOURCES}/{span.file}"))

    fixes = tuple(
        replace(fix, edits=tuple(Edit(shown(edit.span), edit.text) for edit in fix.edits)) for fix in diagnostic.fixes
    )
    return replace(diagnostic, span=shown(diagnostic.span), fixes=fixes)
