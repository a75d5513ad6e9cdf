"""Mock scripts (`NAME.mock.yaml`) as files: they are read and checked."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source import schema, text
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.tree import Mapping, parse

if TYPE_CHECKING:
    from robocomp_yaml.wire.script import Reader


def read(path: str, disk: Disk) -> tuple[Mapping | None, list[Diagnostic]]:
    """The tree of a script, None if it has not the shape of one, and its diagnostics."""
    raw, faults = disk.read(path)
    decoded, more = text.decode(path, raw) if raw is not None else (None, [])
    root, syntax = parse(path, decoded) if decoded is not None else (None, [])
    misfits = schema.validate("mock", root) if root is not None else []
    return (
        root if isinstance(root, Mapping) and not has_errors(misfits) else None,
        [*faults, *more, *syntax, *misfits],
    )


def reader(analysis: Analysis) -> Reader:
    """The reader of scripts about the interfaces of an analysis. Raises ImportError if Ice for Python is missing."""
    from robocomp_yaml.wire.script import Reader

    errors = (one for one in analysis.diagnostics if one.severity == ERROR)
    return Reader(analysis.program.modules.values(), errors)


def check(analysis: Analysis, include: Iterable[str]) -> Iterator[Diagnostic]:
    """The diagnostics of the requested scripts. Without Ice for Python, only their shape is checked."""
    around: dict[str, Analysis] = {}
    for path in analysis.discovered.scripts:
        root, diagnostics = read(path, analysis.disk)
        yield from diagnostics
        if root is None:
            continue
        workspace = analysis.workspaces.of(path)
        folder = workspace.root if workspace.declared else os.path.dirname(path)
        if folder not in around:
            around[folder] = analysis if _covers(analysis, folder) else analyse([folder or "."], include)
        known = {*analysis.diagnostics}
        try:
            found = reader(around[folder]).of_document(root).diagnostics
        except ImportError:
            continue
        yield from (one for one in found if one not in known)


def _covers(analysis: Analysis, folder: str) -> bool:
    """Whether all documents of a folder were requested."""
    real = os.path.realpath(folder or ".")
    return any(
        os.path.commonpath([real, os.path.realpath(one)]) == os.path.realpath(one)
        for one in analysis.discovered.folders
    )
