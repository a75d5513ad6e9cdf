"""Discover the legacy files of a run, and assign a document to each."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.diag.span import Span
from robocomp_yaml.grouping import grouped
from robocomp_yaml.legacy.formats import by_name, is_legacy_file
from robocomp_yaml.legacy.rules import Formats, Rules
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.source.discover import documents_below, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.migrated import is_migrated
from robocomp_yaml.transactions import manifest
from robocomp_yaml.transactions.output_root import contents

_SKIPPED = frozenset(("node_modules", "__pycache__"))


class LegacyFile(msgspec.Struct, frozen=True):
    """A file to migrate. Its document is written to `folder` below `root`, an output root."""

    path: str
    root: str
    folder: str
    is_named: bool = False
    """Whether the file itself was passed, not a folder that contains it."""
    is_pulled: bool = False
    """Whether the file is in the search path, and migrated because another file imports it."""
    preferred: str = ""
    """The file in the same folder that this one was generated from; then this one is skipped."""

    @property
    def start(self) -> str:
        """The folder of the source that corresponds to the output root."""
        folder = os.path.dirname(self.path)
        return os.path.normpath(os.path.join(folder, os.path.relpath(os.curdir, self.folder)))

    def document(self, name: str) -> str:
        return os.path.normpath(os.path.join(self.root, self.folder, name))


class LegacyFiles(msgspec.Struct, frozen=True):
    files: list[LegacyFile] = []
    folders: list[str] = []
    """The output roots of the folders that were passed: each becomes a workspace."""
    interfaces: list[str] = []
    """Folders outside of the output roots, to which links in the folders lead: nothing is written there, so that they
    are part of the search path only."""
    diagnostics: list[Diagnostic] = []

    def workspaces(self) -> list[str]:
        """Return the folders that are not below another one."""
        real = {folder: os.path.realpath(folder).rstrip("/") + "/" for folder in self.folders}
        return [
            folder for folder, own in real.items()
            if not any(own.startswith(other) and own != other for other in real.values())
        ]  # fmt: skip


def discover(paths: Sequence[str], output: str | None, known: Formats) -> LegacyFiles:
    """Return the files that `paths` name, and all legacy files below the folders that they name; each once."""
    discovered = LegacyFiles()
    seen: set[str] = set()
    for path in paths:
        is_folder = os.path.isdir(path)
        if not is_folder and kind_of(path) is not None and os.path.isfile(path):
            continue  # a document, possibly of an earlier version
        outside = None if output else discovered.interfaces
        below = list(_below(path, discovered.diagnostics, known, outside)) if is_folder else [os.path.normpath(path)]
        root = output or (os.path.normpath(path) if is_folder else root_for(path))
        if is_folder:
            if root not in discovered.folders:
                discovered.folders.append(root)
            if not below and next(documents_below(path), None) is None:
                suffixes = sorted({suffix for rules in known for suffix in rules.suffixes})
                hint = f"legacy files have the suffixes {', '.join(suffixes)}"
                discovered.diagnostics.append(codes.NOTHING_FOUND.at(Span(path), hint=hint))
        for file in below:
            real = os.path.realpath(file)
            if real not in seen:
                seen.add(real)
                start = (path if is_folder else os.path.dirname(path)) if output else root
                folder = os.path.relpath(os.path.dirname(file) or ".", start or ".")
                discovered.files.append(LegacyFile(file, root, folder, is_named=not is_folder))
    discovered.files[:] = _preferences(discovered.files, known)
    return discovered


def root_for(path: str) -> str:
    """Return the root of the workspace that contains a file, or the file's folder."""
    folder = os.path.dirname(path)
    return root_above(folder) or folder or "."


def _below(
    folder: str, diagnostics: list[Diagnostic], known: Formats, outside: list[str] | None = None
) -> Iterator[str]:
    """Yield the legacy files below a folder. Links are followed last, so that a document is written beside the file
    itself and not beside a link to it, and no folder is entered twice. Files that `compile` generated are skipped. What
    links lead to outside of the folder is added to `outside`, unless that is None."""

    def report(error: OSError) -> None:
        diagnostics.append(file_codes.UNREADABLE.at(Span(str(error.filename)), reason=reason_of(error)))

    entered: set[tuple[int, int]] = set()
    compiled: set[str] = set()
    linked: list[str] = []
    inside = os.path.join(os.path.realpath(folder), "")
    todo = deque([folder])
    disk = Disk()
    while todo:
        start = todo.popleft()
        is_outside = outside is not None and not os.path.join(os.path.realpath(start), "").startswith(inside)
        for where, folders, names in os.walk(start, onerror=report):
            status = os.stat(where)
            if (status.st_dev, status.st_ino) in entered:
                folders.clear()
                continue
            entered.add((status.st_dev, status.st_ino))
            compiled |= _compiled(where)
            folders[:] = sorted(name for name in folders if name not in _SKIPPED and not name.startswith("."))
            todo += [path for name in folders if os.path.islink(path := os.path.join(where, name))]
            if outside is not None and is_outside:
                outside.append(os.path.normpath(where))
                continue
            for name in sorted(names):
                path = os.path.normpath(os.path.join(where, name))
                if name.startswith(".") or (path in compiled and not _is_source(path, known, disk)):
                    continue
                if is_legacy_file(path, known):
                    if os.path.islink(path):
                        linked.append(path)
                    else:
                        yield path
    yield from linked


def _is_source(path: str, known: Formats, disk: Disk) -> bool:
    """Whether a file that `compile` generated is a config that was migrated: it remains the source of its document."""
    rules = by_name(os.path.basename(path), known)
    if rules is not None and rules.kind != "config":
        return False
    stems = dict.fromkeys((path, os.path.splitext(path)[0]))
    documents = (f"{path}.yaml", *(f"{stem}.config.yaml" for stem in stems))
    return any(is_migrated(document, disk) for document in documents)


def _compiled(folder: str) -> set[str]:
    """Return the files that `compile` generated into an output root."""
    try:
        files = manifest.read(contents(os.path.join(folder, manifest.PATH))).files
    except (OSError, manifest.Unusable):
        return set()
    return {os.path.normpath(os.path.join(folder, path)) for path in files}


def _preferences(files: Sequence[LegacyFile], known: Formats) -> Iterator[LegacyFile]:
    """Mark files that were generated from another one: with the same stem and kind, of a format with a lower rank."""
    named = [(file, by_name(file.path, known)) for file in files]
    by_stem = grouped(
        ((os.path.splitext(file.path)[0], rules.kind), (rules.rank, file.path)) for file, rules in named if rules
    )
    for file, rules in named:
        if rules is not None and rules.is_made:
            rank, other = min(by_stem[(os.path.splitext(file.path)[0], rules.kind)])
            yield replace(file, preferred=other) if rank < rules.rank else file
        else:
            yield file


def assign_documents(
    files: Sequence[tuple[LegacyFile, Rules]],
) -> tuple[dict[str, str], list[Diagnostic]]:
    """Return the path of each file's document, by the file's path. Of two files with the same document, the later one
    keeps its suffix."""
    by_document: dict[str, str] = {}
    by_file: dict[str, str] = {}
    diagnostics: list[Diagnostic] = []
    for file, rules in sorted(files, key=lambda item: (item[1].rank, item[0].path)):
        base = os.path.basename(file.path)
        stem, suffix = os.path.splitext(base)
        drops = suffix.lower() in rules.suffixes and not rules.keep_suffix
        bare = base == rules.kind  # `config` becomes `config.yaml`
        short = file.document(f"{base}.yaml" if bare else f"{stem if drops else base}{rules.document}")
        document = short if short not in by_document else file.document(f"{base}{rules.document}")
        number = 2
        while document in by_document:
            document = file.document(f"{base}.{number}{rules.document}")
            number += 1
        if document != short:
            diagnostics.append(codes.MEETING.at(Span(file.path), other=by_document[short], path=short, own=document))
        by_document[document] = file.path
        by_file[file.path] = document
    return by_file, diagnostics
