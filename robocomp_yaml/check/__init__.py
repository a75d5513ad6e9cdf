"""What a schema cannot say: a folder for each kind of document, every module of which may have a
`check(program) -> Iterator[Diagnostic]` (`ddsl`: `check(network)`, see `networks`). The checks of a kind are imported
only where there are documents of it. What a language says of interfaces stands with the language."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import ModuleType

from robocomp_yaml import languages
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Program
from robocomp_yaml.registry import Modules

Check = Callable[[Program], Iterator[Diagnostic]]


def modules_of(kind: str) -> list[ModuleType]:
    """Every module that checks a kind of document, in the order of their names."""
    modules = Modules(f"{__name__}.{kind}", "check")
    return [module for module in map(modules.load, modules.table()) if hasattr(module, "check")]


def checks_of(kind: str) -> list[Check]:
    return [module.check for module in modules_of(kind)]


def checks(program: Program) -> list[Check]:
    """The checks that a program calls for."""
    kinds = {
        "idsl": program.modules,
        "cdsl": program.components,
        "machine": any(linked.machine for linked in program.components.values()),
        "pdsl": program.parameters or program.values,
    }
    found = [check for kind, documents in kinds.items() if documents for check in checks_of(kind)]
    if program.modules:
        spoken = {linked.component.language.name for linked in program.components.values()}
        asked = (one for one in languages.table().values() if one.name in spoken or one.warns_others)
        found += [one.part("checks").check for one in asked if one.has_checks]
    return found
