"""The linked program: what checks read and targets emit from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from robocomp_yaml.model.component import Component, Use
from robocomp_yaml.model.interface import (
    Constant,
    ExceptionType,
    Interface,
    Module,
    TypeDefinition,
    TypeRef,
)
from robocomp_yaml.model.statemachine import StateMachine

Definition = Constant | TypeDefinition | ExceptionType | Interface


@dataclass(eq=False, slots=True)
class LinkedModule:
    """A module with its direct imports, in the document's order. Compared by identity: two documents may define a
    module of the same name, and each importer sees the one that it imports.

    `unresolved` holds the names by which imports that could not be found might have been called (stem and
    `RoboComp` + stem), so that what they might have defined is not reported again.
    """

    module: Module
    imports: list[LinkedModule] = field(default_factory=list)
    unresolved: set[str] = field(default_factory=set)
    _own: dict[str, Definition] = field(default_factory=dict)
    _found: dict[str, tuple[LinkedModule, Definition] | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for definition in self.module.definitions:
            self._own.setdefault(definition.name, definition)

    def find(self, ref: TypeRef) -> tuple[LinkedModule, Definition] | None:
        """The definition that a reference of this module names, with the module it stands in; None for a basic type
        and for what is not there. Own names need no qualifier; a name of an imported module needs one.

        Answers are kept: names are looked up once the imports are joined, and often."""
        if ref.text not in self._found:
            self._found[ref.text] = self._look_up(ref)
        return self._found[ref.text]

    def _look_up(self, ref: TypeRef) -> tuple[LinkedModule, Definition] | None:
        qualifier = ref.module
        for scope in (self, *self.imports):
            known_as = ("", scope.module.name, scope.module.stem) if scope is self else (
                scope.module.name,
                scope.module.stem,
            )
            if qualifier in known_as and ref.name in scope._own:
                return scope, scope._own[ref.name]
        return None

    def closure(self) -> list[LinkedModule]:
        """This module and all that it imports, directly or not: imported ones first, each once."""
        done: dict[int, LinkedModule] = {}
        todo: list[tuple[LinkedModule, bool]] = [(self, False)]
        entered: set[int] = set()
        while todo:  # without recursion: a chain of imports may be long
            scope, left = todo.pop()
            if left:
                done[id(scope)] = scope
            elif id(scope) not in entered:
                entered.add(id(scope))
                todo.append((scope, True))
                todo += [(imported, False) for imported in reversed(scope.imports)]
        return list(done.values())


@dataclass(frozen=True, slots=True)
class Port:
    """An entry of a component's four lists with the interface it names. `scope` is the module that defines it."""

    use: Use
    interface: Interface
    scope: LinkedModule

    @property
    def name(self) -> str:
        return self.use.name


@dataclass(eq=False, slots=True)
class LinkedComponent:
    """A component whose names are resolved; `broken` when some could not be (then it cannot be compiled). `machine` is
    its state machine, from `machine_files` where it does not stand in the component's document."""

    component: Component
    imports: list[LinkedModule] = field(default_factory=list)
    implements: tuple[Port, ...] = ()
    requires: tuple[Port, ...] = ()
    publishes: tuple[Port, ...] = ()
    subscribes: tuple[Port, ...] = ()
    broken: bool = False
    machine: StateMachine | None = None
    machine_files: tuple[str, ...] = ()

    @property
    def ports(self) -> Iterator[Port]:
        yield from self.implements
        yield from self.requires
        yield from self.publishes
        yield from self.subscribes

    def modules(self) -> list[LinkedModule]:
        """Every module that the component's Slice needs, imported ones first, each once."""
        done: dict[int, LinkedModule] = {}
        for scope in self.imports:
            for needed in scope.closure():
                done.setdefault(id(needed), needed)
        return list(done.values())


@dataclass(slots=True)
class Program:
    """All documents of a run. Keys are real paths; `asked` are those that the user named (the rest was imported)."""

    modules: dict[str, LinkedModule] = field(default_factory=dict)
    components: dict[str, LinkedComponent] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)
    documents: int = 0
