"""A component's four lists with the interfaces that their entries name."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import meaning, suggest
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.component import Use
from robocomp_yaml.model.interface import Interface

_VERBS = {
    "implements": "implements",
    "requires": "requires",
    "publishes": "publishes",
    "subscribes": "subscribes to",
}


def link_ports(linked: LinkedComponent, importable: Callable[[str], str | None]) -> Iterator[Diagnostic]:
    """Fills the component's ports; a name that cannot be resolved makes it `broken`. `importable` says which document
    to import for an interface, where one is known."""
    component = linked.component
    for list_, verb in _VERBS.items():
        ports = []
        for use in getattr(component, list_):
            found = list(_lookup(linked, use))
            if len(found) == 1:
                ports.append(Port(use, found[0][1], found[0][0]))
                continue
            if found:
                names = " or ".join(f"{scope.module.name}.{interface.name}" for scope, interface in found)
                yield codes.AMBIGUOUS_INTERFACE.at(use.span, name=use.interface, hint=f"write {names}")
            elif not linked.broken or not _may_be_missing(linked):
                yield codes.UNKNOWN_INTERFACE.at(
                    use.span,
                    component=component.name,
                    verb=verb,
                    name=use.interface,
                    hint=_hint(linked, use, importable, {other.interface for other in getattr(component, list_)}),
                )
            tie(linked, broken=True)
        tie(linked, **{list_: tuple(ports)})


def _lookup(linked: LinkedComponent, use: Use) -> Iterator[tuple[LinkedModule, Interface]]:
    qualifier, _, name = use.interface.rpartition(".")
    for scope in linked.imports:
        if qualifier in ("", scope.module.name, scope.module.stem):
            for interface in scope.module.all_interfaces:
                if interface.name == name:
                    yield scope, interface
                    break


def _may_be_missing(linked: LinkedComponent) -> bool:
    """Whether an import that could not be used may define what is not found."""
    return len(linked.imports) < len({imported.text for imported in linked.component.imports})


def _hint(linked: LinkedComponent, use: Use, importable: Callable[[str], str | None], given: set[str]) -> Hint:
    """`given` are the interfaces that stand beside it; another use of one has a name of its own."""
    name = use.interface.rpartition(".")[2]
    document = importable(name)
    imported = {scope.module.stem for scope in linked.imports}
    if document and document not in imported:
        return Hint(f"add '{document}' to `imports`", imports=document)
    where = {i.name: scope.module.path for scope in linked.imports for i in scope.module.all_interfaces}
    meant = suggest(name, (one for one in where if one not in given))
    if meant:
        return meaning(name, meant, more=f" ({where[meant]})", safe=meant.lower() == name.lower())
    if meant := suggest(name, given & where.keys()):
        return Hint(f"'{meant}' is there already")
    return Hint(f"the imported modules define: {', '.join(where)}" if where else "import the module that defines it")
