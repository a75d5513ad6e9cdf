"""Keeps linked documents from one analysis to the next.

Documents are linked anew in each analysis. A linked document whose facts are all the same as in the last one is then
replaced by the object of the last one, so that it is an equal cause of later passes.
"""

from __future__ import annotations

from functools import cache
from typing import Any, TypeVar

import msgspec
from msgspec.structs import replace

from robocomp_yaml.digraph import postorder
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import LinkedModule, LinkedParameters, LinkedValues, Port, Tables
from robocomp_yaml.memory import Memory
from robocomp_yaml.model.component import LISTS

_Linked = TypeVar("_Linked", bound=msgspec.Struct)


def keep(tables: Tables, memory: Memory) -> None:
    """Replaces linked documents by equal ones of the last analysis: first those to which others refer."""
    _Kept(tables, memory).run()


class _Kept:
    def __init__(self, tables: Tables, memory: Memory) -> None:
        self._tables, self._memory = tables, memory
        self._same: dict[Any, Any] = {}  # by what was linked now: what replaces it

    def run(self) -> None:
        tables = self._tables
        for scope in postorder(tables.modules.values(), lambda scope: scope.imports):
            self._keep_module(scope)
        tables.modules.update((real, self._of(linked)) for real, linked in tables.modules.items())
        for real in tables.components:
            self._keep_component(real)
        for real, linked in tables.parameters.items():
            tables.parameters[real] = self._of(linked) if linked.component else self._keep_parameters(linked)
        for values in postorder(tables.values.values(), lambda values: values.extends):
            self._keep_values(values)
        tables.values.update((real, self._of(linked)) for real, linked in tables.values.items())

    def _of(self, linked: _Linked) -> _Linked:
        kept: _Linked = self._same.get(linked, linked)
        return kept

    def _keep(self, linked: _Linked, path: str, facts: tuple[object, ...]) -> _Linked:
        part = type(linked).__name__, path
        kept = self._same[linked] = self._memory.result(part, facts, lambda: linked)
        return kept

    def _keep_module(self, linked: LinkedModule) -> None:
        tie(linked, imports=tuple(map(self._of, linked.imports)))
        self._keep(linked, linked.module.path, facts_of(linked))

    def _keep_component(self, real: str) -> None:
        linked = self._tables.components[real]
        ports = {list_: tuple(map(self._port, getattr(linked, list_))) for list_ in LISTS}
        tie(linked, imports=tuple(map(self._of, linked.imports)), **ports)
        facts = *facts_of(linked, "parameters"), *_facts_of_parameters(linked.parameters)
        kept = self._tables.components[real] = self._keep(linked, linked.component.path, facts)
        self._same[linked.parameters] = _unjudged(kept.parameters)

    def _port(self, port: Port) -> Port:
        return replace(port, scope=self._of(port.scope))

    def _keep_parameters(self, linked: LinkedParameters) -> LinkedParameters:
        assert linked.document is not None
        return _unjudged(self._keep(linked, linked.document.path, _facts_of_parameters(linked)))

    def _keep_values(self, linked: LinkedValues) -> None:
        tie(linked, extends=tuple(map(self._of, linked.extends)))
        if linked.parameters is not None:
            tie(linked, parameters=self._of(linked.parameters))
        self._keep(linked, linked.document.path, facts_of(linked))


def facts_of(linked: msgspec.Struct, *without: str) -> tuple[object, ...]:
    """The facts of a linked document, as causes for a memory: all fields, except for caches."""
    return tuple([_fact(getattr(linked, name)) for name in _names(type(linked), without)])


@cache
def _names(type_: type[msgspec.Struct], without: tuple[str, ...]) -> list[str]:
    return [name for name in type_.__struct_fields__ if not name.startswith("_") and name not in without]


def _fact(value: object) -> object:
    if type(value) is tuple:
        return tuple(map(_fact, value))
    if type(value) is frozenset:
        return tuple(sorted(value))
    return facts_of(value) if type(value) is Port else value


def _facts_of_parameters(linked: LinkedParameters) -> tuple[object, ...]:
    """Parameters and their component refer to each other: these are the facts of the parameters alone."""
    return facts_of(linked, "component", "faults")


def _unjudged(linked: LinkedParameters) -> LinkedParameters:
    """Kept parameters without the faults of values of the last analysis."""
    linked.faults.clear()
    return linked
