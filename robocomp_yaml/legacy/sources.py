"""Which legacy files a run is about, and what each one's document will be called."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.formats import by_name, candidate
from robocomp_yaml.legacy.rules import Formats, Rules
from robocomp_yaml.link.workspace import root_above
from robocomp_yaml.source.discover import documents_below, kind_of
from robocomp_yaml.transactions import manifest
from robocomp_yaml.transactions.output_root import contents, reason_of

_SKIPPED = frozenset(("node_modules", "__pycache__"))


class LegacyFile(msgspec.Struct, frozen=True):
    """A file to migrate. Its document goes to `folder` below `root`, an output root."""

    path: str
    root: str
    folder: str
    preferred: str = ""
    """The file beside it from which it was made; then it is skipped."""

    def document(self, name: str) -> str:
        return os.path.normpath(os.path.join(self.root, self.folder, name))


class Found(msgspec.Struct):
    files: list[LegacyFile] = []
    folders: list[str] = []
    """The output roots of the folders given: each becomes a workspace."""
    diagnostics: list[Diagnostic] = []

    def workspaces(self) -> list[str]:
        """The folders that are not below another one."""
        real = {folder: os.path.realpath(folder).rstrip("/") + "/" for folder in self.folders}
        return [
            folder for folder, own in real.items()
            if not any(own.startswith(other) and own != other for other in real.values())
        ]  # fmt: skip


def find(paths: Sequence[str], output: str | None, known: Formats) -> Found:
    """The files named, and below the folders named all with a suffix of a legacy format; each once."""
    found = Found()
    seen: set[str] = set()
    for path in paths:
        is_folder = os.path.isdir(path)
        if not is_folder and kind_of(path) is not None and os.path.isfile(path):
            continue  # a document of ours: it may be an older one
        below = list(_below(path, found.diagnostics, known)) if is_folder else [os.path.normpath(path)]
        root = output or (os.path.normpath(path) if is_folder else _root_of(path))
        if is_folder:
            if root not in found.folders:
                found.folders.append(root)
            if not below and next(documents_below(path), None) is None:
                suffixes = "the suffixes are known: " + ", ".join(sorted(_suffixes(known)))
                found.diagnostics.append(codes.NOTHING_FOUND.at(Span(path), hint=suffixes))
        for file in below:
            real = os.path.realpath(file)
            if real not in seen:
                seen.add(real)
                start = (path if is_folder else os.path.dirname(path)) if output else root
                folder = os.path.relpath(os.path.dirname(file) or ".", start or ".")
                found.files.append(LegacyFile(file, root, folder))
    found.files = list(_preferences(found.files, known))
    return found


def _root_of(path: str) -> str:
    folder = os.path.dirname(path)
    return root_above(folder) or folder or "."


def _suffixes(known: Formats) -> set[str]:
    return {suffix for rules in known for suffix in rules.suffixes}


def _below(folder: str, said: list[Diagnostic], known: Formats) -> Iterator[str]:
    """Links to folders are followed, but no folder is entered twice. What `compile` wrote is no source."""

    def closed(error: OSError) -> None:
        said.append(file_codes.UNREADABLE.at(Span(str(error.filename)), reason=reason_of(error)))

    entered: set[tuple[int, int]] = set()
    compiled: set[str] = set()
    for where, folders, names in os.walk(folder, followlinks=True, onerror=closed):
        status = os.stat(where)
        if (status.st_dev, status.st_ino) in entered:
            folders.clear()
            continue
        entered.add((status.st_dev, status.st_ino))
        compiled |= _compiled(where)
        folders[:] = sorted(name for name in folders if name not in _SKIPPED and not name.startswith("."))
        for name in sorted(names):
            path = os.path.normpath(os.path.join(where, name))
            # A config that became a document is a source still, though `compile` now writes it.
            made = path in compiled and (by_name(name, known) is not None or not os.path.exists(f"{path}.yaml"))
            if not name.startswith(".") and not made and candidate(path, known):
                yield path


def _compiled(folder: str) -> set[str]:
    """The files that `compile` wrote into an output root."""
    try:
        files = manifest.read(contents(os.path.join(folder, manifest.PATH))).files
    except (OSError, manifest.Unusable):
        return set()
    return {os.path.normpath(os.path.join(folder, path)) for path in files}


def _preferences(files: Iterable[LegacyFile], known: Formats) -> Iterator[LegacyFile]:
    """A file that has one of the same stem and kind beside it, of a format with a lower rank, was made from that."""
    listed = list(files)
    best: dict[tuple[str, str], tuple[int, str]] = {}
    for file in listed:
        rules = by_name(file.path, known)
        if rules is not None:
            key = (os.path.splitext(file.path)[0], rules.kind)
            best[key] = min(best.get(key, (rules.rank, file.path)), (rules.rank, file.path))
    for file in listed:
        rules = by_name(file.path, known)
        rank, other = best[(os.path.splitext(file.path)[0], rules.kind)] if rules else (0, file.path)
        better = rules is not None and rules.is_made and rank < rules.rank
        yield LegacyFile(file.path, file.root, file.folder, other) if better else file


def names(
    files: Sequence[tuple[LegacyFile, Rules]],
) -> tuple[dict[str, str], list[Diagnostic]]:
    """The document of each file, by the file's path. Where two would meet, the later one keeps its suffix."""
    taken: dict[str, str] = {}
    chosen: dict[str, str] = {}
    said: list[Diagnostic] = []
    for file, rules in sorted(files, key=lambda item: (item[1].rank, item[0].path)):
        base = os.path.basename(file.path)
        stem, suffix = os.path.splitext(base)
        drops = suffix.lower() in rules.suffixes and not rules.keep_suffix
        bare = base == rules.kind  # `config` becomes `config.yaml`
        short = file.document(f"{base}.yaml" if bare else f"{stem if drops else base}{rules.document}")
        own = short if short not in taken else file.document(f"{base}{rules.document}")
        number = 2
        while own in taken:
            own = file.document(f"{base}.{number}{rules.document}")
            number += 1
        if own != short:
            said.append(codes.MEETING.at(Span(file.path), other=taken[short], path=short, own=own))
        taken[own] = file.path
        chosen[file.path] = own
    return chosen, said
