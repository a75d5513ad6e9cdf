"""Diagnostics for `check` about the user's code that exists: those that a compile would report."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.link.program import LinkedComponent, Program

if TYPE_CHECKING:
    from robocomp_yaml.emit.build import Build


def has_code(program: Program) -> bool:
    """Whether a requested component has files of the user."""
    return any(_is_written(program.components[real]) for real in program.requested_components())


def check(program: Program, diagnostics: Sequence[Diagnostic], linker: Linker) -> Iterator[Diagnostic]:
    """The diagnostics about the user's files of components; `diagnostics` are those of the documents."""
    from robocomp_yaml.emit.specific.review import review

    yield from review(plans(program, diagnostics, linker), program.disk).diagnostics


def plans(program: Program, diagnostics: Sequence[Diagnostic], linker: Linker) -> Build:
    """What a compile would write for the requested components that have files of the user."""
    from robocomp_yaml.emit.build import build
    from robocomp_yaml.emit.options import EmitOptions
    from robocomp_yaml.emit.ports import assign

    languages = {program.components[real].component.language.name for real in program.requested_components()}
    options = EmitOptions(
        None, (), frozenset({*languages, "config"}), linker.workspace_of, lambda linked: assign([linked], program.disk),
        only=_is_written,
    )  # fmt: skip
    return build(program, diagnostics, options)


def _is_written(linked: LinkedComponent) -> bool:
    return os.path.isdir(os.path.join(os.path.dirname(linked.component.path), SOURCES))
