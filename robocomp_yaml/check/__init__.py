"""Checks: rules that a schema cannot express. There is a folder for each kind of document, in which a module may have a
`check(program) -> Iterator[Diagnostic]` (`ddsl`: `check(network)`, see `networks`). The checks of a kind are imported
only if the program has documents of it. A language's own checks are in the language's folder. Plug-ins add checks, for
the documents of the workspaces that name them."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping
from functools import cache
from typing import Any, TypeVar

from robocomp_yaml import languages
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.link.program import Program
from robocomp_yaml.plugins import CHECKS, LANGUAGES, Plugin, Plugins
from robocomp_yaml.registry import Modules

_Item = TypeVar("_Item")
Check = Callable[[Any], Iterator[Diagnostic]]


@cache
def checks_of(kind: str) -> list[Check]:
    """The checks of a kind of document, in the order of their modules' names."""
    return [module.check for module in Modules(f"{__name__}.{kind}", "check").every() if hasattr(module, "check")]


def repeated(items: Iterable[_Item], key: Callable[[_Item], Hashable]) -> Iterator[tuple[_Item, _Item]]:
    """Each item with the key of an earlier item, as the pair (first item with the key, item)."""
    first: dict[Hashable, _Item] = {}
    for item in items:
        other = first.setdefault(key(item), item)
        if other is not item:
            yield other, item


def check_documents(program: Program) -> Iterator[Diagnostic]:
    """The diagnostics of rcyaml's own checks of documents other than deployments."""
    for kind, documents in _kinds(program).items():
        for check in checks_of(kind) if documents else ():
            yield from check(program)
    if program.modules:
        used = _languages(program)
        for language in languages.table().values():
            if language.has_checks and (language.name in used or language.warns_others):
                yield from language.part("checks").check(program)


def _kinds(program: Program) -> dict[str, object]:
    return {
        "idsl": program.modules,
        "cdsl": program.components,
        "machine": any(linked.machine for linked in program.components.values()),
        "pdsl": program.parameters or program.values,
        "flat": program.components and _has_flat_config(program),
    }


def _has_flat_config(program: Program) -> bool:
    from robocomp_yaml.link.flat_configs import flat_config  # interfaces alone have none

    folders = (os.path.dirname(linked.component.path) for linked in program.components.values())
    return any(flat_config(folder, program.disk) is not None for folder in folders)


def _languages(program: Program) -> set[str]:
    return {linked.component.language.name for linked in program.components.values()}


def checks_of_plugins(program: Program, plugins: Iterable[Plugins]) -> list[Check]:
    """The checks that the plug-ins of a program's workspaces add for its documents."""
    found: list[Check] = []
    if not any(one.active for one in plugins):
        return found
    kinds, used = _kinds(program), _languages(program)
    for plugin in {one.name: one for each in plugins for one in each.active}.values():
        for name, check in plugin_checks(plugin, kinds, used):
            found.append(_in_its_workspaces(plugin, name, check))
    return found


def plugin_checks(
    plugin: Plugin, kinds: Mapping[str, object], used: Collection[str] = ()
) -> Iterator[tuple[str, Check]]:  # fmt: skip
    """The checks of a plug-in for documents of these kinds and components in the `used` languages, with their names."""
    for (kind, name), module in plugin.modules.items():
        if kind == CHECKS and kinds.get(module.KIND):
            yield f"check '{name}'", module.check
        elif kind == LANGUAGES and kinds.get("idsl") and (name in used or module.LANGUAGE.warns_others):
            if module.LANGUAGE.has_checks:
                yield f"language '{name}'", _of_language(module.LANGUAGE)


def _of_language(language: TargetLanguage) -> Check:
    def check(program: Program) -> Iterator[Diagnostic]:
        found: Iterator[Diagnostic] = language.part("checks").check(program)
        return found

    return check


def reported_by(plugin: Plugin, name: str, check: Check, about: Any) -> list[Diagnostic]:
    """The diagnostics of a plug-in's check, and of its failure if it fails."""
    diagnostics: list[Diagnostic] = []
    try:
        with plugin.guarded(name):
            for one in check(about):
                if not isinstance(one, Diagnostic):
                    raise TypeError(f"it yields {type(one).__name__}, which is not a Diagnostic")
                diagnostics.append(one)
    except Faulty as failed:
        diagnostics += failed.diagnostics
    return diagnostics


def _in_its_workspaces(plugin: Plugin, name: str, check: Check) -> Check:
    """A plug-in's check reads the whole program, but may report only documents of workspaces that name the plug-in."""

    def run(program: Program) -> Iterator[Diagnostic]:
        for one in reported_by(plugin, name, check, program):
            if one.span.file == plugin.span.file or program.plugins_of(one.span.file).has(plugin.name):
                yield one

    return run
