"""The linked program, which checks read and emitters lower."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.digraph import postorder
from robocomp_yaml.grouping import grouped
from robocomp_yaml.memory import Memory
from robocomp_yaml.parameters.documents import LayeredValues, ResolvedParameters
from robocomp_yaml.plugins import NONE, Plugins
from robocomp_yaml.source.disk import Disk

if TYPE_CHECKING:
    from robocomp_yaml.diag.diagnostic import Diagnostic
    from robocomp_yaml.link.deployments import LinkedDeployment
    from robocomp_yaml.model.component import Component, Use
    from robocomp_yaml.model.interface import Definition, Interface, Module, TypeRef
    from robocomp_yaml.model.statemachine import StateMachine
    from robocomp_yaml.parameters.layers.effective import Effective


class LinkedModule(msgspec.Struct, frozen=True, eq=False):
    """A module with its direct imports, in the order of the document. Modules are compared by identity: two documents
    may define modules of the same name, and each importer sees the one that it imports.

    `unresolved` has the possible module names of unknown imports (stem and `RoboComp` + stem), so that types from these
    modules are not reported too.
    """

    module: Module
    imports: tuple[LinkedModule, ...] = ()
    unresolved: frozenset[str] = frozenset()
    _own: dict[str, Definition] = {}
    _resolved: dict[str, tuple[LinkedModule, Definition] | None] = {}
    _closure: list[LinkedModule] = []

    def __post_init__(self) -> None:
        for definition in self.module.definitions:
            self._own.setdefault(definition.name, definition)

    def find(self, ref: TypeRef) -> tuple[LinkedModule, Definition] | None:
        """Resolves a reference in this module. Returns the defining module and the definition; None for basic types and
        unknown names. Own names need no qualifier, names of imported modules do.

        Results are cached, because references are resolved often, and only after the imports are linked."""
        if ref.text not in self._resolved:
            qualified = (s for s in (self, *self.imports) if ref.module in (s.module.name, s.module.stem))
            scopes = (s for s in (qualified if ref.module else [self]) if ref.name in s._own)
            self._resolved[ref.text] = next(((s, s._own[ref.name]) for s in scopes), None)
        return self._resolved[ref.text]

    def closure(self) -> Sequence[LinkedModule]:
        """This module and all that it imports, directly or not, once each. Importers follow the modules they import.
        It is cached, as in `find`."""
        if not self._closure:
            self._closure.extend(postorder([self], lambda scope: scope.imports))
        return self._closure


class Port(msgspec.Struct, frozen=True):
    """A port of a component with its interface. `scope` is the module that defines the interface."""

    use: Use
    interface: Interface
    scope: LinkedModule

    @property
    def name(self) -> str:
        return self.use.name


class LinkedParameters(ResolvedParameters, frozen=True, eq=False):
    """A component's parameters. `component` is None for a parameter document without a component."""

    component: LinkedComponent | None = None


def _no_parameters() -> LinkedParameters:
    from robocomp_yaml.parameters.resolution.periods import of_no_document

    return LinkedParameters(of_no_document(None))


class LinkedValues(LayeredValues, frozen=True, eq=False):
    """A values document with its layers, and the parameters of its component."""

    parameters: LinkedParameters | None = None


class LinkedComponent(msgspec.Struct, frozen=True, eq=False):
    """A component with resolved names; `broken` if a name is unknown, so that the component cannot be compiled.
    `machine` is its state machine; `machine_files` are the SCXML files of a machine that is not in the component's
    document."""

    component: Component
    imports: tuple[LinkedModule, ...] = ()
    implements: tuple[Port, ...] = ()
    requires: tuple[Port, ...] = ()
    publishes: tuple[Port, ...] = ()
    subscribes: tuple[Port, ...] = ()
    broken: bool = False
    parameters: LinkedParameters = msgspec.field(default_factory=_no_parameters)
    machine: StateMachine | None = None
    machine_files: tuple[str, ...] = ()

    @property
    def ports(self) -> Iterator[Port]:
        yield from self.implements
        yield from self.requires
        yield from self.publishes
        yield from self.subscribes

    def modules(self) -> list[LinkedModule]:
        """Every module that the component's Slice needs, once each. Importers follow what they import."""
        return list(dict.fromkeys(needed for scope in self.imports for needed in scope.closure()))


class NamedDocument(msgspec.Struct, frozen=True):
    """The path of a document that is requested, or that a deployment names. `kind` is for a name that does not have
    the kind."""

    path: str
    kind: str = ""


class UsedValues(msgspec.Struct, frozen=True):
    """A values document that an entry of a deployment uses for a component, by their paths. `is_completed`: the entry
    has values, too, so that some may be missing in the document."""

    values: str
    component: str
    is_completed: bool


class NamedDocuments(msgspec.Struct, frozen=True):
    """What a program consists of beside its deployments: the documents that are requested or that a deployment names,
    and how deployments use values."""

    documents: tuple[NamedDocument, ...]
    values: tuple[UsedValues, ...] = ()


class Tables(msgspec.Struct):
    """The tables of a program that is being linked. Keys are real paths."""

    modules: dict[str, LinkedModule] = {}
    components: dict[str, LinkedComponent] = {}
    parameters: dict[str, LinkedParameters] = {}
    values: dict[str, LinkedValues] = {}
    deployments: dict[str, LinkedDeployment] = {}


class Program(msgspec.Struct, frozen=True):
    """All documents of a run. Keys are real paths. `requested` are the documents that the user named; the others are
    there because requested ones refer to them. `documents` is the number of all. Checks read other files through
    `disk`; `plugins_of` returns the plug-ins of a document's workspace. `memory` keeps results for the next program."""

    modules: Mapping[str, LinkedModule] = {}
    components: Mapping[str, LinkedComponent] = {}
    parameters: Mapping[str, LinkedParameters] = {}
    values: Mapping[str, LinkedValues] = {}
    deployments: Mapping[str, LinkedDeployment] = {}
    requested: Set[str] = frozenset()
    documents: int = 0
    disk: Disk = msgspec.field(default_factory=Disk)
    plugins_of: Callable[[str], Plugins] = lambda path: NONE
    memory: Memory = msgspec.field(default_factory=Memory)
    _effective: dict[LayeredValues, tuple[Effective | None, Sequence[Diagnostic]]] = {}
    _values: dict[str, dict[str, LinkedValues]] = {}

    def values_in(self, folder: str) -> Mapping[str, LinkedValues]:
        """The values documents in a folder, a real path, by their real paths."""
        if not self._values:
            for real, linked in self.values.items():
                self._values.setdefault(os.path.dirname(real), {})[real] = linked
        return self._values.get(folder, {})

    def effective(self, values: LayeredValues) -> tuple[Effective | None, Sequence[Diagnostic]]:
        """The effective values of a values document, None if there are errors, and their diagnostics. They are computed
        at the first call, and cached."""
        if values not in self._effective:
            from robocomp_yaml.parameters.layers.effective import effective  # most components have no values

            part = "effective", values.document.path
            self._effective[values] = self.memory.result(part, values.causes(), lambda: effective(values))
        return self._effective[values]

    def documents_of_components(self) -> dict[str, LinkedComponent | None]:
        """The parameter and values documents by real path, each with its component."""
        documents = {real: linked.component for real, linked in self.parameters.items()}
        return documents | {
            real: linked.parameters.component for real, linked in self.values.items() if linked.parameters
        }

    def requested_components(self) -> set[str]:
        """The real paths of requested components, also those whose parameters, values or deployment are requested."""
        documents = self.documents_of_components()
        components = {documents[real] for real in self.requested & documents.keys()}
        components |= {
            instance.component
            for real in self.requested & self.deployments.keys()
            for instance in self.deployments[real].instances.values()
        }
        indirect = {real for real, linked in self.components.items() if linked in components}
        return {*(self.requested & self.components.keys()), *indirect}

    def parameter_documents(self) -> Iterator[LinkedParameters]:
        """Every parameter document, once for each component with it."""
        every = (*self.parameters.values(), *(component.parameters for component in self.components.values()))
        yield from (linked for linked in dict.fromkeys(every) if linked.document is not None)


def interfaces_by_name(modules: Iterable[LinkedModule]) -> dict[str, list[tuple[LinkedModule, Interface]]]:
    """The interfaces and topics of modules with their module, by name, and by name behind that of the module."""
    every = [(scope, one) for scope in modules for one in scope.module.all_interfaces]
    return grouped((name, (s, one)) for s, one in every for name in (one.name, f"{s.module.name}.{one.name}"))
