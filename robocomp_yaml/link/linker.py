"""Resolves imports and interfaces: documents become one program."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from itertools import pairwise
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

import msgspec

from robocomp_yaml import digraph
from robocomp_yaml.diag.codes import cdsl, idsl
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint, removal
from robocomp_yaml.diag.suggest import did_you_mean, is_typing_error, meaning, suggest
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.knot import tie
from robocomp_yaml.link.program import (
    LinkedComponent,
    LinkedModule,
    NamedDocument,
    NamedDocuments,
    Port,
    Program,
    Tables,
    UsedValues,
)
from robocomp_yaml.link.workspace import SUFFIX, ImportSearch, Workspaces, WorkspaceSettings
from robocomp_yaml.model.interface import Import, Interface, Module
from robocomp_yaml.source.file_names import is_deployment

if TYPE_CHECKING:
    from robocomp_yaml.link.attachments import Attachments
    from robocomp_yaml.link.deployment_documents import DeploymentDocuments
    from robocomp_yaml.model.component import Component, Use
    from robocomp_yaml.model.deployment import Deployment

_ADD_FOLDER = (
    "put its document beside this one, or list its folder under `interfaces:` in rcyaml.yaml, or pass it with -I"
)


class Linker(msgspec.Struct):
    """Links the documents of one run; `diagnostics` collects the errors in references."""

    documents: Documents
    search: ImportSearch
    workspaces: Workspaces
    tables: Tables = msgspec.field(default_factory=Tables)
    diagnostics: list[Diagnostic] = []
    effective: dict[Any, Any] = {}  # the effective values of documents, as far as they are known
    _requested: set[str] = set()
    _deployments: DeploymentDocuments | None = None
    _imported: dict[str, list[str]] = {}  # by real path: the real paths of the imported modules

    def link(self, paths: Iterable[str]) -> Program:
        """Returns the program of these documents and of all documents to which they refer."""
        self.link_named(self.follow(paths))
        self.link_deployments()
        return self.linked()

    def follow(self, paths: Iterable[str]) -> NamedDocuments:
        """Reads the deployments at these paths, and those that they include. Returns the other documents at these
        paths, and those that the deployments name."""
        named: dict[NamedDocument, None] = {}
        deployments: list[Document] = []
        for path in paths:
            self._requested.add(self.documents.disk.real(path))
            if is_deployment(path):
                deployments.append(self.documents.get(path))
            else:
                named[NamedDocument(path)] = None
        seen: set[str] = set()
        while deployments:
            document = deployments.pop()
            if document.real in seen or document.model is None:
                continue
            seen.add(document.real)
            if self._deployments is None:
                from robocomp_yaml.link.deployment_documents import DeploymentDocuments  # most runs have none

                self._deployments = DeploymentDocuments(
                    self.documents, self.tables, self._root_of, self.documents.disk.apart(), self.diagnostics
                )
            for one in self._deployments.follow(document):
                if is_deployment(one.path):
                    deployments.append(self.documents.get(one.path))
                else:
                    named[one] = None
        used = self._deployments.used if self._deployments is not None else ()
        return NamedDocuments(tuple(named), tuple(used))

    def link_named(self, named: NamedDocuments) -> None:
        """Links documents other than deployments, and all documents to which they refer."""
        todo = [self.documents.get(one.path, one.kind) for one in named.documents]
        components: list[tuple[Document, LinkedComponent]] = []
        attachments: Attachments | None = None
        seen: set[str] = set()
        while todo:
            document = todo.pop()
            if document.real in seen:
                continue
            seen.add(document.real)
            if isinstance(document.model, Module):
                linked = self.tables.modules[document.real] = LinkedModule(document.model)
                unresolved: set[str] = set()
                todo += self._imports(document, document.model.imports, unresolved, idsl)
                tie(linked, unresolved=frozenset(unresolved))
                continue
            if document.kind == "cdsl" and document.model is not None:
                component = self.tables.components[document.real] = self._expanded(cast("Component", document.model))
                components.append((document, component))
                unresolved = set()
                todo += self._imports(document, component.component.imports, unresolved, cdsl)
                tie(component, broken=bool(unresolved))
            if attachments is None:
                from robocomp_yaml.link.attachments import Attachments  # interfaces alone have none

                attachments = Attachments(self.documents, self.tables, self._root_of, self.diagnostics)
            todo += attachments.follow(document)
        self._join()
        if attachments is not None:
            attachments.join()
        for used in named.values:
            self._use(used)
        for document, component in sorted(components, key=lambda pair: pair[0].path):
            self.diagnostics += _link_ports(component, partial(self._importable, document))
            self._read_machine(component)
        if self.documents.memory.is_lasting:
            from robocomp_yaml.link.kept import keep  # most analyses are not followed by another one

            keep(self.tables, self.documents.memory)

    def _use(self, used: UsedValues) -> None:
        """Links values as an entry of a deployment uses them."""
        real = self.documents.disk.real
        values, component = self.tables.values.get(real(used.values)), self.tables.components.get(real(used.component))
        if values is None or component is None:
            return
        if used.is_completed:
            tie(values, is_extended=True)  # `set:` has the missing values
        if values.parameters is None:  # values without a component belong to the component that uses them
            tie(values, parameters=component.parameters)

    def linked(self) -> Program:
        """The program as far as it is linked."""
        return Program(
            **msgspec.structs.asdict(self.tables),
            requested=frozenset(self._requested),
            documents=len(self.documents.read),
            disk=self.documents.disk,
            memory=self.documents.memory,
            plugins_of=self.workspaces.plugins_of,
            _effective=self.effective,
        )

    @property
    def deployments(self) -> Mapping[str, Deployment]:
        """The deployments that were followed, by real path."""
        return self._deployments.models if self._deployments is not None else {}

    def link_deployments(self) -> None:
        """Links the deployments, after all other documents are linked."""
        if self._deployments is not None:
            self._deployments.join()

    def _expanded(self, component: Component) -> LinkedComponent:
        """The component with the interfaces that its options add."""
        if component.options:
            from robocomp_yaml.link import options  # of legacy components

            component, diagnostics = options.expanded(component)
            self.diagnostics += diagnostics
        return LinkedComponent(component)

    def _root_of(self, path: str) -> str:
        """The root of a document's workspace; without a declared workspace, the folder of its component."""
        workspace = self.workspaces.of(path)
        is_deep = not workspace.declared and os.path.basename(os.path.abspath(workspace.root or ".")) == "etc"
        return os.path.normpath(os.path.join(workspace.root, os.pardir)) if is_deep else workspace.root

    def _read_machine(self, linked: LinkedComponent) -> None:
        if linked.component.machine is not None or not linked.component.statemachine:
            tie(linked, machine=linked.component.machine)
            return
        from robocomp_yaml.link.machines import MachineReader  # it imports the parser of XML, which few runs need

        reader = MachineReader(self.documents.disk)
        machine = reader.of(linked.component)
        tie(linked, machine=machine, machine_files=tuple(reader.files), broken=linked.broken or machine is None)
        self.diagnostics += reader.diagnostics

    def _imports(
        self, document: Document, imports: tuple[Import, ...], unresolved: set[str], codes: ModuleType
    ) -> list[Document]:
        """The imported documents. The names of modules that imports without a usable document might define are added to
        `unresolved`."""
        workspace = self.workspaces.of(document.path)
        documents: dict[str, Document] = {}
        for imported in imports:
            path, other_case = self.search.find(imported.text, document.path, workspace)
            if path is None:
                self._unresolved(document, imported, {other.text for other in imports}, workspace, codes)
                unresolved.update(_names(imported))
                continue
            target = self.documents.get(path)
            name = os.path.basename(path).removesuffix(SUFFIX)
            if other_case:
                hint = Hint(f"write '{name}'", imported.stem, name, safe=True)
                self.diagnostics.append(codes.IMPORT_CASE.at(imported.span, name=imported.text, found=name, hint=hint))
            if target.real in documents or target.real == document.real:
                # A component cannot import itself: it is no module.
                why = "is this document itself" if target.real == document.real else "is already imported"
                facts = {"problem": why} if codes is idsl else {}
                fix = removal(imported.span)
                self.diagnostics.append(
                    codes.DUPLICATE_IMPORT.at(imported.span, name=imported.text, **facts, fixes=[fix])
                )
                continue
            documents[target.real] = target
            if not isinstance(target.model, Module):
                unresolved.update(_names(imported), {target.module} - {""})
        self._imported[document.real] = [real for real, target in documents.items() if isinstance(target.model, Module)]
        return list(documents.values())

    def _unresolved(
        self, document: Document, imported: Import, others: set[str], workspace: WorkspaceSettings, codes: ModuleType
    ) -> None:
        itself = os.path.basename(document.path).removesuffix(SUFFIX)
        known = [name for name in self.search.known(document.path, workspace) if name != itself]
        known = [name for name in known if is_typing_error(imported.text, name)]  # its file may be missing
        hint = did_you_mean(imported.text, known, others, open_=True, otherwise=_ADD_FOLDER)
        self.diagnostics.append(codes.UNRESOLVED_IMPORT.at(imported.span, name=imported.text, hint=hint))

    def _join(self) -> None:
        """Links modules with the modules that they import, except for imports on a circle, which are reported."""
        graph = {
            real: [other for other in self._imported.get(real, ()) if other in self.tables.modules]
            for real in self.tables.modules
        }
        in_circle = self._circles(graph)
        for real, linked in self.tables.modules.items():
            circular = [self.tables.modules[other].module for other in graph[real] if (real, other) in in_circle]
            direct = (self.tables.modules[other] for other in graph[real] if (real, other) not in in_circle)
            names = {name for imported in circular for name in (imported.name, imported.stem)}
            tie(linked, imports=tuple(direct), unresolved=linked.unresolved | names)
        for real, component in self.tables.components.items():
            tie(component, imports=tuple(self.tables.modules[other] for other in self._imported.get(real, ())))

    def _circles(self, graph: dict[str, list[str]]) -> set[tuple[str, str]]:
        """The imports on circles. Each circle is reported once, at the first of its documents."""
        circles: set[tuple[str, str]] = set()
        for members in digraph.cyclic_components(graph):
            circles |= {(real, other) for real in members for other in graph[real] if other in members}
            first = min(members, key=lambda real: self.tables.modules[real].module.path)
            circle = [
                self.tables.modules[real].module for real in (*digraph.cycle_through(graph, members, first), first)
            ]
            steps = [
                Related(f"{one.stem} imports {next_.stem}", _import_of(one, next_).span)
                for one, next_ in pairwise(circle)
            ]
            cycle = " → ".join(module.stem for module in circle)
            hint = "move the definitions that both need to a third document"
            self.diagnostics.append(idsl.IMPORT_CYCLE.at(steps[0].span, cycle=cycle, related=steps[1:], hint=hint))
        return circles

    def _importable(self, document: Document, interface: str) -> str | None:
        """The document to import for an interface that no imported module defines; None if it is unknown."""
        for linked in sorted(self.tables.modules.values(), key=lambda m: m.module.path):
            if any(i.name == interface for i in linked.module.all_interfaces):
                return linked.module.stem
        known = self.search.known(document.path, self.workspaces.of(document.path))
        return interface if interface in known else None


def _names(imported: Import) -> set[str]:
    return {imported.stem, f"RoboComp{imported.stem}"}


def _import_of(module: Module, other: Module) -> Import:
    named = (imported for imported in module.imports if imported.stem.lower() == other.stem.lower())
    return next(named, module.imports[0])


def _link_ports(linked: LinkedComponent, importable: Callable[[str], str | None]) -> Iterator[Diagnostic]:
    """Resolves the interfaces of a component's ports; an unknown one makes the component `broken`. `importable` returns
    the document to import for an interface, or None."""
    from robocomp_yaml.model.component import LISTS  # interfaces alone need no components

    component = linked.component
    for list_ in LISTS:
        ports = []
        for use in getattr(component, list_):
            matches = list(_lookup(linked, use))
            if len(matches) == 1:
                ports.append(Port(use, matches[0][1], matches[0][0]))
                continue
            if matches:
                names = " or ".join(f"{scope.module.name}.{interface.name}" for scope, interface in matches)
                yield cdsl.AMBIGUOUS_INTERFACE.at(use.span, name=use.interface, hint=f"write {names}")
            elif not linked.broken or not _may_be_missing(linked):
                yield cdsl.UNKNOWN_INTERFACE.at(
                    use.span,
                    component=component.name,
                    verb="subscribes to" if list_ == "subscribes" else list_,
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
    """Whether an import without a usable document may define an unknown name."""
    return len(linked.imports) < len({imported.text for imported in linked.component.imports})


def _hint(linked: LinkedComponent, use: Use, importable: Callable[[str], str | None], others: set[str]) -> Hint:
    """The hint at an unknown interface; `others` are the interfaces in the same list."""
    name = use.interface.rpartition(".")[2]
    if name == "CommonBehavior" and use in linked.component.implements:
        return Hint("remove it: every component implements CommonBehavior")
    document = importable(name)
    imported = {scope.module.stem for scope in linked.imports}
    if document and document not in imported:
        return Hint(f"add '{document}' to `imports`", imports=document)
    where = {i.name: scope.module.path for scope in linked.imports for i in scope.module.all_interfaces}
    meant = suggest(name, (one for one in where if one not in others))
    if meant:
        return meaning(name, meant, more=f" ({where[meant]})", safe=meant.lower() == name.lower())
    if meant := suggest(name, others & where.keys()):
        return Hint(f"the list already has '{meant}'")
    return Hint(f"the imported modules define: {', '.join(where)}" if where else "import the module that defines it")
