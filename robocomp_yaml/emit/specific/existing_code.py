"""Diagnostics for `check` about the user's code that exists: those that a compile would report."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.link.workspace import Workspaces
from robocomp_yaml.source.disk import Disk

if TYPE_CHECKING:
    from robocomp_yaml.emit.build import Build

Ports = Callable[[LinkedComponent], PortTable]


def has_code(program: Program) -> bool:
    """Whether a requested component has files of the user."""
    return any(_is_written(program.components[real], program.disk) for real in program.requested_components())


def changed(program: Program, files: Collection[str]) -> list[str] | None:
    """The folders of the components to whose code these files belong, with `/` at the end; None if one of the files is
    no code of a component."""
    folders = {os.path.normpath(_folder(linked)) for linked in program.components.values()}
    found = set()
    for file in files:
        parts = file.split("/")
        heads = ("/".join(parts[:end]) or "." for end, name in enumerate(parts) if name == SOURCES)
        home = next((head for head in heads if head in folders), None)
        if home is None:
            return None
        found.add(f"{home}/" if home != "." else "")
    return sorted(found)


def check(
    program: Program, diagnostics: Sequence[Diagnostic], workspaces: Workspaces, ports: Ports,
    folders: Collection[str] | None = None,
) -> Iterator[Diagnostic]:  # fmt: skip
    """The diagnostics about the user's files of components, or only of those in some folders; `diagnostics` are those
    of the documents, `ports` returns the ports of a component's workspace."""
    from robocomp_yaml.emit.specific.review import review

    built = plans(program, diagnostics, workspaces, ports, folders)
    yield from review(built, program.disk, unsaved=program.disk.unsaved).diagnostics


def plans(
    program: Program, diagnostics: Sequence[Diagnostic], workspaces: Workspaces, ports: Ports,
    folders: Collection[str] | None = None,
) -> Build:  # fmt: skip
    """What a compile would write for the requested components that have files of the user."""
    from robocomp_yaml.emit.build import build
    from robocomp_yaml.emit.options import EmitOptions

    languages = {program.components[real].component.language.name for real in program.requested_components()}
    options = EmitOptions(
        None, (), frozenset({*languages, "config"}), workspaces.of, ports,
        only=lambda linked: _is_written(linked, program.disk) and (folders is None or _slashed(linked) in folders),
    )  # fmt: skip
    return build(program, diagnostics, options)


def _folder(linked: LinkedComponent) -> str:
    return os.path.dirname(linked.component.path) or "."


def _slashed(linked: LinkedComponent) -> str:
    folder = os.path.normpath(_folder(linked))
    return f"{folder}/" if folder != "." else ""


def _is_written(linked: LinkedComponent, disk: Disk) -> bool:
    return disk.ask(os.path.isdir, os.path.join(_folder(linked), SOURCES))
