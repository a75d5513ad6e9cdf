"""Which interface files belong to a run besides those in its folders, and which of those do not.

RoboComp's own tool copies interfaces into the `src/` or `generated/` of a component. A copy is no source: if the
interface itself is known, its copies are skipped. Otherwise the copy is an interface of the component alone. An
interface that is only in a folder of `-I`, as a legacy file, is migrated into the repository that imports it.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator, Sequence

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.grouping import grouped
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.draft import base_name
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.linking import InterfaceFiles, imports_of
from robocomp_yaml.legacy.rules import Formats
from robocomp_yaml.legacy.sources import LegacyFile
from robocomp_yaml.legacy.workspaces import Workspaces
from robocomp_yaml.link.workspace import ImportSearch
from robocomp_yaml.source.disk import names_in


def from_search_path(
    entries: Sequence[LedgerEntry], search: ImportSearch, known: Formats, homes: Workspaces
) -> Iterator[LedgerEntry]:
    """Yield the legacy interfaces in the folders of the search path that files import, directly or not, and that no
    document and no file of the run defines."""
    interfaces = InterfaceFiles.of((entry.file for entry in entries if not entry.skipped), search)
    todo = deque(entries)
    while todo:
        importer = todo.popleft()
        for imported in imports_of(importer.file):
            stem, document = imported.stem, importer.legacy.document(f"{base_name(importer.file.path)}.yaml")
            match, other_case = search.find(stem, document, homes.of(document))
            is_beside = not importer.legacy.is_pulled and stem.lower() in interfaces.beside(importer.file)
            if stem in interfaces.by_stem or is_beside or (match and not other_case):
                continue
            is_otherwise = match or any(stem.lower() == known.lower() for known in interfaces.by_stem)
            if path := _in_folders(stem, search.extra, exactly=bool(is_otherwise)):
                root = importer.legacy.root
                entry = LedgerEntry(LegacyFile(path, root, _home(homes, root), is_pulled=True), convert(path, known))
                entry.diagnostics = [*entry.file.diagnostics]
                interfaces.add(entry.file)
                todo.append(entry)
                yield entry


def note_pulled(entries: Iterable[LedgerEntry]) -> Iterator[Diagnostic]:
    """Yield a note for each folder of the search path with interfaces that are migrated, too."""
    pulled = (entry.file.path for entry in entries if entry.legacy.is_pulled)
    for folder, paths in grouped((os.path.dirname(path), path) for path in pulled).items():
        names = some([base_name(path) for path in paths])
        yield codes.FROM_SEARCH_PATH.at(Span(paths[0]), count=len(paths), folder=folder, names=names)


def _in_folders(stem: str, folders: Iterable[str], *, exactly: bool) -> str | None:
    """The legacy interface of this name in one of the folders; unless `exactly`, also in another case."""
    names = [(folder, stem + suffix) for folder in folders for suffix in (".idsl", ".ice")]
    paths = [os.path.join(folder, name) for folder, name in names]
    if not exactly:
        paths += [
            os.path.join(folder, known) for folder, name in names for known in sorted(names_in(folder))
            if known.lower() == name.lower()
        ]  # fmt: skip
    return next((path for path in paths if os.path.isfile(path)), None)


def _home(homes: Workspaces, root: str) -> str:
    """Return the folder of a workspace for interfaces from elsewhere, relative to its root."""
    inside = (os.path.relpath(folder, root) for folder in homes.of(os.path.join(root, "x")).interfaces)
    return next((folder for folder in inside if not folder.startswith(os.pardir)), "interfaces")


def skip_copies(entries: Sequence[LedgerEntry], interfaces: InterfaceFiles, known: Workspaces) -> Iterator[Diagnostic]:
    """Mark the copies as skipped that have an original, and those that no document imports. Yield one note for all."""
    copies = {file.path for files in interfaces.copies.values() for file in files}
    for entry in entries:
        path = entry.file.path
        if path not in copies or entry.skipped or entry.legacy.is_named:
            continue
        stem = base_name(path)
        if interfaces.original(stem, known.of(entry.legacy.document(os.path.basename(path)))):
            entry.skipped, entry.diagnostics = True, []
            interfaces.copies.pop(stem, None)
    needed = set(_imported(entries, copies, interfaces))
    for entry in entries:
        path = entry.file.path
        if path in copies and path not in needed and not entry.skipped and not entry.legacy.is_named:
            entry.skipped, entry.diagnostics = True, []
    if skipped := [entry.file.path for entry in entries if entry.file.path in copies and entry.skipped]:
        yield codes.COPIES.at(Span(skipped[0]), count=len(skipped), files=some(skipped))


def _imported(entries: Sequence[LedgerEntry], copies: set[str], interfaces: InterfaceFiles) -> Iterator[str]:
    """Yield the paths of the files that documents import, directly or not."""
    todo = [entry.file for entry in entries if not entry.skipped and entry.file.path not in copies]
    seen: set[str] = set()
    while todo:
        file = todo.pop()
        for imported in imports_of(file):
            target = interfaces.imported(file, imported.stem)
            if target is not None and target.path not in seen:
                seen.add(target.path)
                todo.append(target)
                yield target.path
