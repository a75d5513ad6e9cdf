"""Modules that are imported together must not define the same name, nor become the same Slice file.

Two documents may have modules of the same name if nothing imports both. So an error is reported for each module or
component that is the first to import both, directly or not; not again for those that import it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reachable
from robocomp_yaml.grouping import grouped
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.references import macro
from robocomp_yaml.patterns import pattern

if TYPE_CHECKING:
    from robocomp_yaml.model.component import Component
    from robocomp_yaml.model.interface import Module

Importer = LinkedModule | LinkedComponent

_FILE_NAME = pattern(r"\w[\w.+-]*\Z")


def check(program: Program) -> Iterator[Diagnostic]:
    everybody: list[Importer] = [*program.modules.values(), *program.components.values()]
    imports: list[tuple[Importer, Importer]] = [(imported, one) for one in everybody for imported in one.imports]
    importers = grouped(imports)
    modules = sorted(program.modules.values(), key=lambda linked: linked.module.path)
    by_name = grouped((linked.module.name.lower(), linked) for linked in modules)
    by_file = grouped((macro(linked.module.stem), linked) for linked in modules)
    for linked in modules:
        if not _FILE_NAME.match(linked.module.stem):
            yield codes.FILE_NAME.at(
                linked.module.span, name=linked.module.stem, hint="use letters, digits and underscores"
            )
    for same in (*by_name.values(), *by_file.values()):
        if len(same) > 1:
            yield from _imported_together(same, importers)


def _imported_together(same: list[LinkedModule], importers: dict[Importer, list[Importer]]) -> Iterator[Diagnostic]:
    """Checks each importer that is the first to import two of these modules."""
    seen_by: dict[Importer, dict[LinkedModule, None]] = defaultdict(dict)
    for linked in same:
        itself: list[Importer] = [linked]
        for importer in reachable(itself, lambda importer: importers.get(importer, ())):
            seen_by[importer][linked] = None
    for importer, sees in seen_by.items():
        below = [seen_by.get(imported, {}) for imported in importer.imports]
        if len(sees) > 1 and not any(len(lower) == len(sees) for lower in below):
            first, *others = sees
            for other in others:
                yield from _conflict(importer, first, other)


def _conflict(importer: Importer, one: LinkedModule, other: LinkedModule) -> Iterator[Diagnostic]:
    related = [Related(f"the module of {linked.module.stem}", linked.module.span) for linked in (one, other)]
    first, second = one.module, other.module
    document = importer.component if isinstance(importer, LinkedComponent) else importer.module

    def at(code: Code, hint: str, **facts: Any) -> Diagnostic:
        span = _import_of(document, other) or _import_of(document, one) or document.span
        return code.at(span, hint=hint, related=related, one=first.path, two=second.path, **facts)

    if macro(first.stem) == macro(second.stem):
        yield at(codes.SAME_FILE, "rename one of the documents", file=f"{second.stem}.ice")
    elif first.name != second.name:
        if first.name.lower() == second.name.lower():
            yield at(codes.MODULE_CASE, "use the same spelling, or rename one", name=first.name, second=second.name)
    else:
        names = {definition.name.lower(): definition.name for definition in first.definitions}
        twice = [definition.name for definition in second.definitions if definition.name.lower() in names]
        if twice:
            yield at(codes.REDEFINED, "import only one of them", name=twice[0], module=first.name)


def _import_of(document: Component | Module, linked: LinkedModule) -> Span | None:
    stem = linked.module.stem.lower()
    return next((imported.span for imported in document.imports if imported.stem.lower() == stem), None)
