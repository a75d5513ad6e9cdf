"""Documents of parameters and of values, found and joined with their components."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence

import msgspec

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reached
from robocomp_yaml.link import component_references as references
from robocomp_yaml.link.component_references import References
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.knot import grow, tie
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, LinkedValues, Tables
from robocomp_yaml.model.component import Component
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.parameters.resolution.resolve import leaves_types_unknown, of_no_document, resolve
from robocomp_yaml.parameters.specification.document import ParameterDocument, ValuesDocument
from robocomp_yaml.source.discover import kind_of, of_kind
from robocomp_yaml.source.disk import Disk

SUFFIX = ".pdsl.yaml"


class Attachments(msgspec.Struct):
    """Follows the references between components, parameters and values. Keys of the tables are real paths; `root_of`
    gives the folder below which a document's component may be."""

    documents: Documents
    tables: Tables
    root_of: Callable[[str], str]
    diagnostics: list[Diagnostic] = []
    _parameters_of: dict[str, list[tuple[str, Span]]] = {}  # component: its PDSLs
    _component_of: dict[str, str] = {}  # PDSL or values: what `component:` names
    _extends: dict[str, list[str]] = {}
    _names: dict[str, dict[str, list[str]]] = {}  # folder: its component documents by name

    @property
    def _disk(self) -> Disk:
        return self.documents.disk

    @property
    def _references(self) -> References:
        return References(self._disk)

    def follow(self, document: Document) -> Iterator[Document]:
        """The documents that a document refers to."""
        model = document.model
        if isinstance(model, Component):
            yield from self._follow_component(document, model)
        elif isinstance(model, ParameterDocument | ValuesDocument):
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
                advice = self._references.advice(model.parameters, folder, "parameters", ("pdsl",))
                told = codes.NO_PARAMETERS.at(model.parameters_span, name=model.parameters, hint=advice.hint)
                self.diagnostics.append(told)
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
        """The documents beside a component that name it as theirs. Where none does, those are read too that may have
        been meant to: what is wrong with them is told, and the component is not taken to have no parameters."""
        self._disk.has_file(os.path.join(folder, f"{references.stem(document.path)}{SUFFIX}"))
        doubtful = []
        for path in self._references.beside(folder, "pdsl"):
            target = self.documents.glance(path)
            said = target.component
            if said and self._is_named(document, folder, said):
                if target.model is None:  # it will not name the component itself
                    self._parameters_of.setdefault(document.real, []).append((target.real, Span(path)))
                yield self.documents.get(path)
                continue
            named = os.path.normpath(os.path.join(folder, said)) if said is not None else ""
            if not (named and self._references.is_document(named, ("cdsl",))):
                doubtful.append(target)
        if self._parameters_of.get(document.real) or (doubtful and len(self._references.beside(folder, "cdsl")) > 1):
            return
        for target in doubtful:
            if target.model is None:
                self._parameters_of.setdefault(document.real, []).append((target.real, Span(target.path)))
            yield self.documents.get(target.path)

    def _is_named(self, document: Document, folder: str, said: str) -> bool:
        """Whether this component is meant; by its name too, of which `_follow_reference` says what is wrong with it."""
        names = (document.component, references.stem(document.path))
        return said in names or os.path.realpath(os.path.join(folder, said)) == document.real

    def _follow_reference(self, document: Document, model: ParameterDocument | ValuesDocument) -> Iterator[Document]:
        """The component (or, for values, the parameters) that `component:` names. Parameters of a component that has
        no document name no document."""
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
            found = self._called(name, root) if is_name else []
            is_plain = is_parameters and "/" not in name and not name.endswith(".yaml")
            advice = (
                self._references.advice_for_name(name, folder)
                if is_plain
                else (self._references.advice(name, folder, "component", kinds))
            )
            if found:
                told = codes.NAMED.at(span, name=name, hint=references.write(found, folder, "component", name))
                is_near = not is_parameters or any(os.path.dirname(path) == folder for path in found)
                # Parameters that stand alone may have a component's name by chance, as migrated ones have.
                self.diagnostics.append(told if is_near else told.as_severity("warning"))
                if not is_near:
                    return
            elif advice.hint or not is_plain:
                alike = [] if advice.is_known else self._called(os.path.basename(name), root)
                hint = references.write(alike, folder, "component", name) if alike else advice.hint
                self.diagnostics.append(codes.NO_COMPONENT.at(span, name=name, hint=hint))
            else:
                return
            self._component_of[document.real] = ""
            found = self._references.beside(folder, "cdsl") if is_parameters and not found else found
            found = self._references.components_of(document.path) or found
            if len(found) != 1:
                return
            path = found[0]  # what follows is judged as if it were right
        target = self.documents.get(path)
        self._component_of[document.real] = target.real
        if is_parameters:
            self._parameters_of.setdefault(target.real, []).append((document.real, span))
        yield target

    def _called(self, name: str, root: str) -> list[str]:
        """The documents whose component is called so, or whose file is: below a folder, and in this run."""
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
                advice = self._references.advice(str(layer.value), folder, "extends", ("config",), document.path)
                self.diagnostics.append(value_codes.NO_LAYER.at(layer.span, name=layer.value, hint=advice.hint))
                tie(self.tables.values[document.real], broken=True)
                continue
            target = self.documents.get(path, "config")
            self._extends.setdefault(document.real, []).append(target.real)
            yield target

    def join(self) -> None:
        """After all documents are read: each component has its parameters, each values document its layers."""
        for real, component in self.tables.components.items():
            self._join_component(real, component)
        self.diagnostics += self._elsewhere()
        for document in list(self.documents.read.values()):
            if isinstance(document.model, ParameterDocument) and document.real not in self.tables.parameters:
                parameters, found = resolve(document.model)
                self.diagnostics += found
                self.tables.parameters[document.real] = LinkedParameters(
                    parameters, document.model, broken=leaves_types_unknown(found)
                )
                self.diagnostics += self._unclaimed(document.model)
        self._join_layers()

    def _elsewhere(self) -> Iterator[Diagnostic]:
        """Parameters that name a component which would not find them by itself."""
        for real, component in self.tables.components.items():
            for other, span in self._parameters_of.get(real, ()):
                path, own = self.documents.read[other].path, component.component
                is_beside = os.path.dirname(other) == os.path.dirname(real)
                if not is_beside and not own.parameters:
                    folder = os.path.dirname(own.path)
                    yield codes.NOT_BESIDE.at(
                        span,
                        component=own.name,
                        related=[Related("the component", own.span)],
                        hint=f"{references.write([path], folder, 'parameters')} in {own.path}, or move this document "
                        "beside it",
                    )

    def _unclaimed(self, document: ParameterDocument) -> Iterator[Diagnostic]:
        """Parameters that name no component, beside one that names no parameters."""
        folder = os.path.dirname(document.path)
        beside = self._references.beside(folder, "cdsl")
        component = self.tables.components.get(os.path.realpath(beside[0])) if len(beside) == 1 else None
        if component is not None and not document.component and component.parameters.document is None:
            yield codes.UNCLAIMED.at(
                document.span,
                component=component.component.name,
                hint=references.write(beside, folder, "component"),
                related=[Related("the component", component.component.span)],
            )

    def _join_component(self, real: str, component: LinkedComponent) -> None:
        named = self._parameters_of.get(real, [])
        reals = list(dict.fromkeys(other for other, _ in named))
        for other, span in named[1:]:
            if other != reals[0]:
                first, name = self.documents.read[reals[0]], component.component.name
                self.diagnostics.append(
                    codes.DISAGREEMENT.at(
                        span,
                        component=name,
                        other=os.path.basename(first.path),
                        hint="leave one of them out",
                        related=[Related("named here", named[0][1])],
                    )
                )
        period = component.component.period
        document = self.documents.read[reals[0]].model if reals else None
        if reals and not isinstance(document, ParameterDocument):
            own = LinkedParameters(of_no_document(period), component=component, broken=True)
            tie(component, parameters=own, broken=True)
        elif isinstance(document, ParameterDocument):
            parameters, found = resolve(document, period)
            self.diagnostics += found
            broken = leaves_types_unknown(found)
            own = LinkedParameters(parameters, document, broken, component=component)
            tie(component, parameters=own, broken=component.broken or broken)
            self.tables.parameters.setdefault(reals[0], component.parameters)
        else:
            broken = component.parameters.broken
            tie(component, parameters=LinkedParameters(of_no_document(period), None, broken, component=component))

    def _join_layers(self) -> None:
        values = self.tables.values
        for real, linked in values.items():
            for other in self._extends.get(real, ()):
                if other not in values:
                    tie(linked, broken=True)  # the layer has errors of its own
                elif self._reaches(other, real):
                    layer = next(x for x in linked.document.extends if leads_to(x, linked.document, other))
                    self.diagnostics.append(value_codes.LAYER_CYCLE.at(layer.span, name=layer.value))
                    tie(linked, broken=True)
                else:
                    grow(linked, "extends", values[other])
                    tie(values[other], is_extended=True)
        for linked in values.values():
            home = self._references.components_of(linked.document.path)
            here = [found for path in home if (found := self.tables.components.get(os.path.realpath(path)))]
            for base in reversed(linked.layers()):  # its own component, else that of the nearest layer
                target = self._component_of.get(os.path.realpath(base.document.path))
                if target is not None:
                    tie(linked, parameters=self._parameters(target, here))
                    break
            else:
                if len(home) == len(here) == 1:  # whose else could they be
                    tie(linked, parameters=here[0].parameters)
            self.diagnostics += _misplaced(linked, home, here)

    def _parameters(self, real: str, here: Sequence[LinkedComponent]) -> LinkedParameters | None:
        """Those that a values document names; of a document that several components share, those of the component
        at hand."""
        document = self.tables.parameters[real].document if real in self.tables.parameters else None
        for component in here:
            if document is not None and component.parameters.document is document:
                return component.parameters
        if real in self.tables.components:
            return self.tables.components[real].parameters
        return self.tables.parameters.get(real)

    def _reaches(self, start: str, goal: str) -> bool:
        return goal in reached([start], lambda real: self._extends.get(real, ()))


def _is_compiled(document: Document) -> bool:
    """Whether values become a file of their own, as those do that were migrated from one."""
    legacy = document.model.section("legacy") if isinstance(document.model, ValuesDocument) else None
    return legacy is not None and legacy.get("file") is not None


def _misplaced(linked: LinkedValues, home: list[str], here: Sequence[LinkedComponent]) -> Iterator[Diagnostic]:
    """The values that a component would take for its own, and that name another one."""
    own = linked.parameters
    if own is None or own.component is None or not here or any(component.parameters is own for component in here):
        return
    folder, whose = os.path.dirname(linked.document.path), own.component.component.name
    yield codes.MISPLACED.at(
        linked.document.span,
        component=here[0].component.name,
        other=whose,
        hint=references.write(home, folder, "component"),
        related=[Related("the component", here[0].component.span)],
    )


def leads_to(layer: Literal, document: ValuesDocument, real: str) -> bool:
    """Whether an entry of a document's `extends:` means the document with this real path."""
    return os.path.realpath(os.path.join(os.path.dirname(document.path), str(layer.value))) == real
