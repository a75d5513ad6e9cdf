"""A program without its deployments. Deployments name other documents, and no other document names a deployment, so
that most edits of a deployment leave the rest of the program as it is.

A living analysis keeps the rest as long as the files of the disk and the texts of other documents are the same, and
deployments name the same documents and use the same values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.documents import Document
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import NamedDocuments, Program, Tables
from robocomp_yaml.source.disk import DiskRecord

Kept = tuple[Mapping[Any, Any], ...]
"""What was computed at the first use, until some moment."""


class Undeployed(msgspec.Struct, frozen=True):
    """A program without its deployments, as a linker left it: the linked documents, what was requested of the disk and
    what was computed for them, and all diagnostics."""

    tables: Tables
    documents: Mapping[str, Document]
    diagnostics: Sequence[Diagnostic]
    record: DiskRecord
    kept: Kept


def causes(linker: Linker, named: NamedDocuments) -> tuple[object, ...]:
    """What the program of these documents depends on, apart from the contents of files and from the documents in
    folders, which are recorded."""
    disk = linker.documents.disk
    return (
        disk.version,
        "\n".join(f"{one.path}\t{one.kind}" for one in named.documents),
        "\n".join(f"{one.values}\t{one.component}\t{one.is_completed}" for one in named.values),
        "\n".join(linker.search.extra),
        disk.added,
    )


def linked(linker: Linker, named: NamedDocuments, check: Callable[[Program], Iterable[Diagnostic]]) -> Undeployed:
    """Links and checks the documents that a linker's deployments name, and those that were requested."""
    disk, documents = linker.documents.disk, linker.documents
    deployments = dict(documents.read)
    begin = len(documents.diagnostics), len(linker.diagnostics)
    linker.link_named(named)
    program = linker.linked()
    diagnostics = [*documents.diagnostics[begin[0] :], *linker.diagnostics[begin[1] :], *check(program)]
    linker.diagnostics[begin[1] :] = diagnostics
    del documents.diagnostics[begin[0] :]
    return Undeployed(
        Tables(*map(dict, msgspec.structs.astuple(linker.tables))),
        {real: document for real, document in documents.read.items() if real not in deployments},
        diagnostics,
        disk.record({document.path for document in deployments.values()}),
        kept_of(linker),
    )


def recall(linker: Linker, known: Undeployed) -> None:
    """Continues as if the linker had linked and checked these documents."""
    linker.documents.read |= known.documents
    linker.documents.disk.recall(known.record)
    linker.diagnostics += known.diagnostics
    for table, found in zip(_tables(linker.tables), _tables(known.tables), strict=True):
        table.update(found)
    recall_kept(linker, known.kept)


def kept_of(linker: Linker) -> Kept:
    """What the linker has computed until now. The settings of workspaces are reported if they were read."""
    return tuple(map(dict, _caches(linker)))


def recall_kept(linker: Linker, kept: Kept) -> None:
    """Continues as if the linker had computed this."""
    for cache, found in zip(_caches(linker), kept, strict=True):
        cache.update(found)


def _tables(tables: Tables) -> tuple[dict[str, Any], ...]:
    return tables.modules, tables.components, tables.parameters, tables.values


def _caches(linker: Linker) -> tuple[dict[Any, Any], ...]:
    """What is computed at the first use."""
    return (*linker.workspaces.caches, linker.search.cache, linker.effective)
