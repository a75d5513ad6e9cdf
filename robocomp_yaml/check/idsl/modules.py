"""Modules that meet: documents that some importer joins must not define the same name, nor become the same file.

Two documents may have a module of the same name, as long as nobody needs both. So the rules are asked of each module
and component that brings two such documents together, and of none that merely imports it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reached
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.references import macro
from robocomp_yaml.patterns import pattern

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.interface import Module

Importer = LinkedModule | LinkedComponent

_FILE_NAME = pattern(r"\w[\w.+-]*\Z")


def check(program: Program) -> Iterator[Diagnostic]:
    importers: dict[Importer, list[Importer]] = defaultdict(list)
    by_name: dict[str, list[LinkedModule]] = defaultdict(list)
    by_file: dict[str, list[LinkedModule]] = defaultdict(list)
    everybody: list[Importer] = [*program.modules.values(), *program.components.values()]
    for importer in everybody:
        for imported in importer.imports:
            importers[imported].append(importer)
    for linked in sorted(program.modules.values(), key=lambda linked: linked.module.path):
        by_name[linked.module.name.lower()].append(linked)
        by_file[macro(linked.module.stem)].append(linked)
        if not _FILE_NAME.match(linked.module.stem):
            yield codes.FILE_NAME.at(
                linked.module.span, name=linked.module.stem, hint="use letters, digits and underscores"
            )
    for alike in (*by_name.values(), *by_file.values()):
        if len(alike) > 1:
            yield from _meetings(alike, importers)


def _meetings(alike: list[LinkedModule], importers: dict[Importer, list[Importer]]) -> Iterator[Diagnostic]:
    """What is wrong where two of these documents first meet."""
    seen_by: dict[Importer, dict[LinkedModule, None]] = defaultdict(dict)
    for linked in alike:
        itself: list[Importer] = [linked]
        for importer in reached(itself, lambda importer: importers.get(importer, ())):
            seen_by[importer][linked] = None
    for importer, sees in seen_by.items():
        below = [seen_by.get(imported, {}) for imported in importer.imports]
        if len(sees) > 1 and not any(len(lower) == len(sees) for lower in below):
            first, *others = sees
            for other in others:
                yield from _together(importer, first, other)


def _together(importer: Importer, one: LinkedModule, other: LinkedModule) -> Iterator[Diagnostic]:
    related = [Related(f"{linked.module.stem} stands here", linked.module.span) for linked in (one, other)]
    first, second = one.module, other.module
    document = importer.component if isinstance(importer, LinkedComponent) else importer.module

    def at(code: Code, hint: str, **facts: Any) -> Diagnostic:
        span = _import_of(document, other) or _import_of(document, one) or document.span
        return code.at(span, hint=hint, related=related, one=first.path, two=second.path, **facts)

    if macro(first.stem) == macro(second.stem):
        yield at(codes.SAME_FILE, "rename one of the documents", file=f"{second.stem}.ice")
    elif first.name != second.name:
        if first.name.lower() == second.name.lower():
            yield at(codes.MODULE_CASE, "spell both alike, or rename one", name=first.name, second=second.name)
    else:
        names = {definition.name.lower(): definition.name for definition in first.definitions}
        twice = [definition.name for definition in second.definitions if definition.name.lower() in names]
        if twice:
            yield at(codes.REDEFINED, "import only one of them", name=twice[0], module=first.name)


def _import_of(document: Component | Module, linked: LinkedModule) -> Span | None:
    stem = linked.module.stem.lower()
    return next((imported.span for imported in document.imports if imported.stem.lower() == stem), None)
