"""The linked program: what checks read and targets emit from."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.digraph import inner_first
from robocomp_yaml.model.interface import (
    Constant,
    ExceptionType,
    Interface,
    Module,
    TypeDefinition,
    TypeRef,
)
from robocomp_yaml.parameters.documents import LayeredValues, ResolvedParameters
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source.disk import Disk

if TYPE_CHECKING:
    from robocomp_yaml.diag.diagnostic import Diagnostic
    from robocomp_yaml.link.deployments import LinkedDeployment
    from robocomp_yaml.model.component import Component, Use
    from robocomp_yaml.model.statemachine import StateMachine
    from robocomp_yaml.parameters.layers.effective import Effective

Definition = Constant | TypeDefinition | ExceptionType | Interface


class LinkedModule(msgspec.Struct, frozen=True, eq=False):
    """A module with its direct imports, in the document's order. Compared by identity: two documents may define a
    module of the same name, and each importer sees the one that it imports.

    `unresolved` holds the names by which imports that could not be found might have been called (stem and
    `RoboComp` + stem), so that what they might have defined is not reported again.
    """

    module: Module
    imports: tuple[LinkedModule, ...] = ()
    unresolved: frozenset[str] = frozenset()
    _own: dict[str, Definition] = {}
    _found: dict[str, tuple[LinkedModule, Definition] | None] = {}

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
            known_as = (*([""] if scope is self else []), scope.module.name, scope.module.stem)
            if qualifier in known_as and ref.name in scope._own:
                return scope, scope._own[ref.name]
        return None

    def closure(self) -> list[LinkedModule]:
        """This module and all that it imports, directly or not: imported ones first, each once."""
        return list(inner_first([self], lambda scope: scope.imports))


class Port(msgspec.Struct, frozen=True):
    """An entry of a component's four lists with the interface it names. `scope` is the module that defines it."""

    use: Use
    interface: Interface
    scope: LinkedModule

    @property
    def name(self) -> str:
        return self.use.name


class LinkedParameters(ResolvedParameters, frozen=True, eq=False):
    """A component's parameters. `component` is None for a document that no component was found for."""

    component: LinkedComponent | None = None


def _only_the_period() -> LinkedParameters:
    from robocomp_yaml.parameters.resolution.resolve import of_no_document

    return LinkedParameters(of_no_document(None))


class LinkedValues(LayeredValues, frozen=True, eq=False):
    """A values document with its layers, and the parameters of the component that it belongs to."""

    parameters: LinkedParameters | None = None


class LinkedComponent(msgspec.Struct, frozen=True, eq=False):
    """A component whose names are resolved; `broken` when some could not be (then it cannot be compiled). `machine` is
    its state machine, from `machine_files` where it does not stand in the component's document."""

    component: Component
    imports: tuple[LinkedModule, ...] = ()
    implements: tuple[Port, ...] = ()
    requires: tuple[Port, ...] = ()
    publishes: tuple[Port, ...] = ()
    subscribes: tuple[Port, ...] = ()
    broken: bool = False
    parameters: LinkedParameters = msgspec.field(default_factory=_only_the_period)
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
        return list(dict.fromkeys(needed for scope in self.imports for needed in scope.closure()))


class Tables(msgspec.Struct):
    """A program while it is linked; keys are real paths."""

    modules: dict[str, LinkedModule] = {}
    components: dict[str, LinkedComponent] = {}
    parameters: dict[str, LinkedParameters] = {}
    values: dict[str, LinkedValues] = {}
    deployments: dict[str, LinkedDeployment] = {}


class Program(msgspec.Struct, frozen=True):
    """All documents of a run. Keys are real paths; `requested` are those that the user named (the rest was imported).
    Checks read other files through `disk`; `plugins_of` says which plug-ins count for a document."""

    modules: Mapping[str, LinkedModule] = {}
    components: Mapping[str, LinkedComponent] = {}
    parameters: Mapping[str, LinkedParameters] = {}
    values: Mapping[str, LinkedValues] = {}
    deployments: Mapping[str, LinkedDeployment] = {}
    requested: Set[str] = frozenset()
    documents: int = 0
    disk: Disk = msgspec.field(default_factory=Disk)
    plugins_of: Callable[[str], Plugins] = lambda path: NONE
    _effective: dict[LayeredValues, tuple[Effective | None, Sequence[Diagnostic]]] = {}

    def effective(self, values: LayeredValues) -> tuple[Effective | None, Sequence[Diagnostic]]:
        """What is in effect by a values document, and what is wrong with it: worked out once, when it is first asked
        for, for all that read it."""
        if values not in self._effective:
            from robocomp_yaml.parameters.layers.effective import effective  # most components have no values

            self._effective[values] = effective(values)
        return self._effective[values]

    def documents_of_components(self) -> dict[str, LinkedComponent | None]:
        """The documents of parameters and of values, each with its component."""
        documents = {real: linked.component for real, linked in self.parameters.items()}
        return documents | {
            real: linked.parameters.component for real, linked in self.values.items() if linked.parameters
        }

    def requested_components(self) -> set[str]:
        """The components that the user named, be it by their parameters, their values or a deployment of them."""
        documents = self.documents_of_components()
        wanted = {documents[real] for real in self.requested & documents.keys()}
        wanted |= {
            instance.component
            for real in self.requested & self.deployments.keys()
            for instance in self.deployments[real].instances.values()
        }
        named = {real for real, linked in self.components.items() if linked in wanted}
        return {*(self.requested & self.components.keys()), *named}

    def parameter_documents(self) -> Iterator[LinkedParameters]:
        """Every document of parameters, once for each component that has it."""
        every = (*self.parameters.values(), *(component.parameters for component in self.components.values()))
        yield from (linked for linked in dict.fromkeys(every) if linked.document is not None)
