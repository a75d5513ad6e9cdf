"""Discovers parameter documents and values documents, and links them with their components."""

from __future__ import annotations

import os
from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import Any

import msgspec

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reachable
from robocomp_yaml.link import component_references as references
from robocomp_yaml.link.component_references import References
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.knot import grow, tie
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, LinkedValues, Tables
from robocomp_yaml.model.component import Component
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.parameters.resolution.periods import of_no_document
from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument
from robocomp_yaml.source.discover import kind_of, of_kind
from robocomp_yaml.source.disk import Disk

SUFFIX = ".pdsl.yaml"


class Attachments(msgspec.Struct):
    """Resolves the references between components, parameters and values. Keys of the tables are real paths. `root_of`
    returns the folder below which the component of a document is searched."""

    documents: Documents
    tables: Tables
    root_of: Callable[[str], str]
    diagnostics: list[Diagnostic] = []
    _references: References = References(Disk())
    _parameters_of: dict[str, list[tuple[str, Span]]] = {}  # by component: its parameter documents
    _component_of: dict[str, str] = {}  # by parameter or values document: what `component:` names
    _extends: dict[str, list[str]] = {}
    _names: dict[str, dict[str, list[str]]] = {}  # by folder: its component documents by name

    @property
    def _disk(self) -> Disk:
        return self.documents.disk

    def __post_init__(self) -> None:
        self._references = References(self._disk)

    def follow(self, document: Document) -> Iterator[Document]:
        """Yields the documents that a document refers to, and reports references that cannot be resolved."""
        model = document.model
        if isinstance(model, Component):
            yield from self._follow_component(document, model)
        elif isinstance(model, (ParameterDocument, ValuesDocument)):
            if isinstance(model, ValuesDocument):
                self.tables.values[document.real] = LinkedValues(model)
            yield from self._follow_reference(document, model)
            if isinstance(model, ValuesDocument):
                yield from self._follow_layers(document, model)
                home = self._references.components_of(document.path)
                if len(home) == 1:
                    yield self.documents.get(home[0])

    def _follow_component(self, document: Document, model: Component) -> Iterator[Document]:
        folder = os.path.dirname(document.path)
        linked = self.tables.components[document.real]
        if model.parameters:
            path = os.path.normpath(os.path.join(folder, model.parameters))
            if not self._references.is_document(path, ("pdsl",)):
                advice = self._references.hint_for(model.parameters, folder, "parameters", ("pdsl",))
                fault = codes.NO_PARAMETERS.at(model.parameters_span, name=model.parameters, hint=advice.hint)
                self.diagnostics.append(fault)
                tie(linked.parameters, broken=True)
                tie(linked, broken=True)
            else:
                target = self.documents.get(path)
                self._parameters_of.setdefault(document.real, []).insert(0, (target.real, model.parameters_span))
                yield target
        yield from self._beside(document, folder)
        self._disk.has_file(os.path.normpath(os.path.join(folder, "etc", "config.yaml")))
        for values in self._references.beside(os.path.join(folder, "etc"), "config"):
            if os.path.basename(values) == "config.yaml" or _is_compiled(self.documents.glance(values)):
                yield self.documents.get(values)

    def _beside(self, document: Document, folder: str) -> Iterator[Document]:
        """The parameter documents beside a component that name the component. If there is none, the parameter documents
        that name no existing component are read too, so that their errors are reported, and the component does not
        count as one without parameters."""
        self._disk.has_file(os.path.join(folder, f"{references.stem(document.path)}{SUFFIX}"))
        doubtful = []
        for path in self._references.beside(folder, "pdsl"):
            target = self.documents.glance(path)
            name = target.component
            if name and self._is_named(document, folder, name):
                if target.model is None:  # a document with errors is not followed
                    self._parameters_of.setdefault(document.real, []).append((target.real, Span(path)))
                yield self.documents.get(path)
                continue
            named = os.path.normpath(os.path.join(folder, name)) if name is not None else ""
            if not (named and self._references.is_document(named, ("cdsl",))):
                doubtful.append(target)
        if self._parameters_of.get(document.real) or (doubtful and len(self._references.beside(folder, "cdsl")) > 1):
            return
        for target in doubtful:
            if target.model is None:
                self._parameters_of.setdefault(document.real, []).append((target.real, Span(target.path)))
            yield self.documents.get(target.path)

    def _is_named(self, document: Document, folder: str, name: str) -> bool:
        """Whether `component:` refers to this component by path, or by name, which `_follow_reference` reports."""
        names = (document.component, references.stem(document.path))
        return name in names or self._disk.real(os.path.join(folder, name)) == document.real

    def _follow_reference(self, document: Document, model: ParameterDocument | ValuesDocument) -> Iterator[Document]:
        """The component (or, for values, the parameters) that `component:` names. Parameters of a component without a
        document have a plain name there."""
        name, folder = model.component, os.path.dirname(document.path)
        if not name:
            return
        is_parameters = isinstance(model, ParameterDocument)
        span = model.component_span if isinstance(model, ParameterDocument) else model.span
        kinds = ("cdsl",) if is_parameters else ("cdsl", "pdsl")
        path = os.path.normpath(os.path.join(folder, name))
        if not self._references.is_document(path, kinds):
            root = self.root_of(document.path)
            is_name = os.path.basename(name) == name and not name.endswith((".yaml", ".yml"))
            matches = self._with_name(name, root) if is_name else []
            is_plain = is_parameters and "/" not in name and not name.endswith(".yaml")
            if is_plain:
                advice = self._references.hint_for_name(name, folder)
            else:
                advice = self._references.hint_for(name, folder, "component", kinds)
            if matches:
                fault = codes.NAMED.at(span, name=name, hint=references.entry_hint(matches, folder, "component", name))
                is_near = not is_parameters or any(os.path.dirname(path) == folder for path in matches)
                # Parameters without a component beside them may have its name by chance, as migrated ones have.
                self.diagnostics.append(fault if is_near else fault.as_severity("warning"))
                if not is_near:
                    return
            elif advice.hint or not is_plain:
                alike = [] if advice.is_known else self._with_name(os.path.basename(name), root)
                hint = references.entry_hint(alike, folder, "component", name) if alike else advice.hint
                self.diagnostics.append(codes.NO_COMPONENT.at(span, name=name, hint=hint))
            else:
                return
            self._component_of[document.real] = ""
            matches = self._references.beside(folder, "cdsl") if is_parameters and not matches else matches
            matches = self._references.components_of(document.path) or matches
            if len(matches) != 1:
                return
            path = matches[0]  # continue as if the reference were right
        target = self.documents.get(path)
        self._component_of[document.real] = target.real
        if is_parameters:
            self._parameters_of.setdefault(target.real, []).append((document.real, span))
        yield target

    def _with_name(self, name: str, root: str) -> list[str]:
        """The component documents with this name, of the component or the file, below a folder and in this run."""
        if root not in self._names:
            known = self._names[root] = {}
            below = of_kind(root, "cdsl", self._disk)
            read = [document.path for document in self.documents.read.values() if document.kind == "cdsl"]
            documents = {document.real: document for document in map(self.documents.glance, (*below, *read))}
            for document in documents.values():
                for each in {references.stem(document.path), os.path.basename(document.path), document.component or ""}:
                    known.setdefault(each, []).append(document.path)
        return self._names[root].get(name, [])

    def _follow_layers(self, document: Document, model: ValuesDocument) -> Iterator[Document]:
        disk = self._disk
        for layer in model.extends:
            path = os.path.normpath(os.path.join(os.path.dirname(document.path), str(layer.value)))
            if not (path.endswith(".yaml") and disk.has_file(path) and kind_of(path, disk) in ("config", None)):
                folder = os.path.dirname(document.path)
                advice = self._references.hint_for(str(layer.value), folder, "extends", ("config",), document.path)
                self.diagnostics.append(value_codes.NO_LAYER.at(layer.span, name=layer.value, hint=advice.hint))
                tie(self.tables.values[document.real], broken=True)
                continue
            target = self.documents.get(path, "config")
            self._extends.setdefault(document.real, []).append(target.real)
            yield target

    def join(self) -> None:
        """Links components with their parameters, and values with their layers, after all documents are read."""
        for real, component in self.tables.components.items():
            self._join_component(real, component)
        self.diagnostics += self._elsewhere()
        for document in list(self.documents.read.values()):
            if isinstance(document.model, ParameterDocument) and document.real not in self.tables.parameters:
                linked = self._resolved("", document.model)
                self.tables.parameters[document.real] = linked
                self.diagnostics += self._unclaimed(document.model)
        self._join_layers()

    def _elsewhere(self) -> Iterator[Diagnostic]:
        """Reports parameters whose component is in another folder and does not name them."""
        for real, component in self.tables.components.items():
            for other, span in self._parameters_of.get(real, ()):
                path, own = self.documents.read[other].path, component.component
                is_beside = os.path.dirname(other) == os.path.dirname(real)
                if not is_beside and not own.parameters:
                    entry = references.entry_hint([path], os.path.dirname(own.path), "parameters")
                    hint = f"{entry} in {own.path}, or move this document beside it"
                    related = [Related("the component", own.span)]
                    yield codes.NOT_BESIDE.at(span, component=own.name, related=related, hint=hint)

    def _unclaimed(self, document: ParameterDocument) -> Iterator[Diagnostic]:
        """Reports parameters that name no component, beside a component without parameters."""
        folder = os.path.dirname(document.path)
        beside = self._references.beside(folder, "cdsl")
        component = self.tables.components.get(self._disk.real(beside[0])) if len(beside) == 1 else None
        if component is not None and not document.component and component.parameters.document is None:
            yield codes.UNCLAIMED.at(
                document.span,
                component=component.component.name,
                hint=references.entry_hint(beside, folder, "component"),
                related=[Related("the component", component.component.span)],
            )

    def _join_component(self, real: str, component: LinkedComponent) -> None:
        named = self._parameters_of.get(real, [])
        reals = list(dict.fromkeys(other for other, _ in named))
        for other, span in named[1:]:
            if other != reals[0]:
                fault = codes.DISAGREEMENT.at(
                    span,
                    component=component.component.name,
                    other=os.path.basename(self.documents.read[reals[0]].path),
                    hint="remove one of them",
                    related=[Related("the first reference", named[0][1])],
                )
                self.diagnostics.append(fault)
        document = self.documents.read[reals[0]].model if reals else None
        if reals and not isinstance(document, ParameterDocument):
            own = self._without_document(component, broken=True)
            tie(component, parameters=own, broken=True)
        elif isinstance(document, ParameterDocument):
            own = self._resolved(real, document, component)
            tie(component, parameters=own, broken=component.broken or own.broken)
            self.tables.parameters.setdefault(reals[0], component.parameters)
        else:
            tie(component, parameters=self._without_document(component, broken=component.parameters.broken))

    def _resolved(
        self, real: str, document: ParameterDocument, component: LinkedComponent | None = None
    ) -> LinkedParameters:  # fmt: skip
        """The parameters of a document, for the component whose document is at `real`. Reports their problems."""
        from robocomp_yaml.parameters.resolution.resolve import leaves_types_unknown, resolve  # many have none

        period = component.component.period if component is not None else None
        part, causes = ("parameters", real, document.path), (document, period)
        parameters, faults, made = self.documents.memory.result(
            part, causes, lambda: (*resolve(document, period), dict[Hashable, Any]())
        )
        self.diagnostics += faults
        return LinkedParameters(parameters, document, leaves_types_unknown(faults), made, component=component)

    def _without_document(self, component: LinkedComponent, *, broken: bool) -> LinkedParameters:
        period = component.component.period
        parameters, made = self.documents.memory.result(
            ("no parameters", period), (), lambda: (of_no_document(period), dict[Hashable, Any]())
        )
        return LinkedParameters(parameters, None, broken, made, component=component)

    def _join_layers(self) -> None:
        values = self.tables.values
        for real, linked in values.items():
            for other in self._extends.get(real, ()):
                if other not in values:
                    tie(linked, broken=True)  # the layer has errors of its own
                elif real in reachable([other], lambda one: self._extends.get(one, ())):
                    layer = next(x for x in linked.document.extends if refers_to(x, linked.document, other))
                    self.diagnostics.append(value_codes.LAYER_CYCLE.at(layer.span, name=layer.value))
                    tie(linked, broken=True)
                else:
                    grow(linked, "extends", values[other])
                    tie(values[other], is_extended=True)
        for linked in values.values():
            home = self._references.components_of(linked.document.path)
            components = [found for path in home if (found := self.tables.components.get(self._disk.real(path)))]
            for base in reversed(linked.layers()):  # its own component, or that of its nearest layer
                target = self._component_of.get(self._disk.real(base.document.path))
                if target is not None:
                    tie(linked, parameters=self._parameters(target, components))
                    break
            else:
                if len(home) == len(components) == 1:  # `etc/config.yaml` of the only component
                    tie(linked, parameters=components[0].parameters)
                elif len(home) > len(components):  # the component's document has errors of its own
                    tie(linked, broken=True)
            self.diagnostics += _misplaced(linked, home, components)

    def _parameters(self, real: str, components: Sequence[LinkedComponent]) -> LinkedParameters | None:
        """The parameters that a values document names. If several components share the parameter document, those of the
        component beside the values are returned."""
        document = self.tables.parameters[real].document if real in self.tables.parameters else None
        for component in components:
            if document is not None and component.parameters.document is document:
                return component.parameters
        if real in self.tables.components:
            return self.tables.components[real].parameters
        return self.tables.parameters.get(real)


def _is_compiled(document: Document) -> bool:
    """Whether values are compiled to a file of their own: they were migrated from one."""
    legacy = document.model.section("legacy") if isinstance(document.model, ValuesDocument) else None
    return legacy is not None and legacy.get("file") is not None


def _misplaced(linked: LinkedValues, home: list[str], components: Sequence[LinkedComponent]) -> Iterator[Diagnostic]:
    """Reports `etc/config.yaml` of a component that names another component."""
    own = linked.parameters
    if own is None or own.component is None or not components:
        return
    if any(component.parameters is own for component in components):
        return
    folder, other = os.path.dirname(linked.document.path), own.component.component.name
    yield codes.MISPLACED.at(
        linked.document.span,
        component=components[0].component.name,
        other=other,
        hint=references.entry_hint(home, folder, "component"),
        related=[Related("the component", components[0].component.span)],
    )


def refers_to(layer: Literal, document: ValuesDocument, real: str) -> bool:
    """Whether an entry of a document's `extends:` refers to the document with this real path."""
    return os.path.realpath(os.path.join(os.path.dirname(document.path), str(layer.value))) == real
