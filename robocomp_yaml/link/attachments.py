"""Documents of parameters and of values, found and joined with their components."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

import msgspec

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related, has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.link.documents import Document, Documents
from robocomp_yaml.link.parameters import of_no_document, resolve
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, LinkedValues, Program
from robocomp_yaml.model.component import Component
from robocomp_yaml.model.interface import Literal
from robocomp_yaml.model.pdsl import ParameterDocument, ValuesDocument
from robocomp_yaml.source.discover import kind_of

SUFFIX = ".pdsl.yaml"
_NAMES_COMPONENT = re.compile(rb"^component:[ \t]*[\"']?([^\"'#\r\n]+?)[\"']?[ \t]*(?:#.*)?\r?$", re.MULTILINE)


class Attachments(msgspec.Struct):
    """Follows the references between components, parameters and values. Keys of the tables are real paths; `absent`
    collects the paths at which a document would be found if it were there."""

    documents: Documents
    program: Program
    absent: set[str]
    diagnostics: list[Diagnostic] = []
    _parameters_of: dict[str, list[tuple[str, Span]]] = {}  # component: its PDSLs
    _component_of: dict[str, str] = {}  # PDSL or values: what `component:` names
    _extends: dict[str, list[str]] = {}

    def follow(self, document: Document) -> Iterator[Document]:
        """The documents that a document refers to."""
        model = document.model
        if isinstance(model, Component):
            yield from self._follow_component(document, model)
        elif isinstance(model, ParameterDocument | ValuesDocument):
            if isinstance(model, ValuesDocument):
                self.program.values[document.real] = LinkedValues(model)
            yield from self._follow_reference(document, model)
            if isinstance(model, ValuesDocument):
                yield from self._follow_layers(document, model)

    def _follow_component(self, document: Document, model: Component) -> Iterator[Document]:
        folder = os.path.dirname(document.path)
        linked = self.program.components[document.real]
        if model.parameters:
            path = os.path.normpath(os.path.join(folder, model.parameters))
            if not (path.endswith(".yaml") and os.path.isfile(path)):
                hint = _similar(path, SUFFIX)
                self.diagnostics.append(codes.NO_PARAMETERS.at(model.parameters_span, name=model.parameters, hint=hint))
                linked.parameters.broken = linked.broken = True
            else:
                target = self.documents.get(path)
                self._parameters_of.setdefault(document.real, []).insert(0, (target.real, model.parameters_span))
                yield target
        else:
            yield from self._beside(document, folder)
        values = os.path.normpath(os.path.join(folder, "etc", "config.yaml"))
        if os.path.isfile(values):
            yield self.documents.get(values)
        else:
            self.absent.add(values)

    def _beside(self, document: Document, folder: str) -> Iterator[Document]:
        """The documents beside a component that name it as theirs."""
        named_alike = os.path.normpath(document.path.removesuffix(".cdsl.yaml") + SUFFIX)
        if not os.path.lexists(named_alike):
            self.absent.add(named_alike)
        try:
            names = sorted(name for name in os.listdir(folder or ".") if name.endswith(SUFFIX))
        except OSError:
            names = []
        for name in names:
            path = os.path.normpath(os.path.join(folder, name))
            try:
                with open(path, "rb") as file:
                    found = _NAMES_COMPONENT.search(file.read(1 << 16))
            except OSError:
                continue
            if found and os.path.normpath(found[1].decode(errors="replace")) == os.path.basename(document.path):
                target = self.documents.get(path)
                if target.model is None:  # it will not name the component itself
                    self._parameters_of.setdefault(document.real, []).append((target.real, Span(path)))
                yield target

    def _follow_reference(self, document: Document, model: ParameterDocument | ValuesDocument) -> Iterator[Document]:
        """The component (or, for values, the parameters) that `component:` names; a plain name names no document."""
        name = model.component
        if not name or (isinstance(model, ParameterDocument) and "/" not in name and not name.endswith(".yaml")):
            return
        span = model.component_span if isinstance(model, ParameterDocument) else model.span
        path = os.path.normpath(os.path.join(os.path.dirname(document.path), name))
        kinds = (".cdsl.yaml",) if isinstance(model, ParameterDocument) else (".cdsl.yaml", SUFFIX)
        is_kind = path.endswith(kinds) or os.path.basename(path) in ("cdsl.yaml", "pdsl.yaml")
        if not (is_kind and os.path.isfile(path)):
            self.diagnostics.append(codes.NO_COMPONENT.at(span, name=name, hint=_similar(path, *kinds)))
            self._component_of[document.real] = ""
            return
        target = self.documents.get(path)
        self._component_of[document.real] = target.real
        if isinstance(model, ParameterDocument):
            self._parameters_of.setdefault(target.real, []).append((document.real, span))
        yield target

    def _follow_layers(self, document: Document, model: ValuesDocument) -> Iterator[Document]:
        for layer in model.extends:
            path = os.path.normpath(os.path.join(os.path.dirname(document.path), str(layer.value)))
            if not (path.endswith(".yaml") and os.path.isfile(path) and kind_of(path) in ("config", None)):
                hint = _similar(path, "config.yaml")
                self.diagnostics.append(value_codes.NO_LAYER.at(layer.span, name=layer.value, hint=hint))
                self.program.values[document.real].broken = True
                continue
            target = self.documents.get(path, "config")
            self._extends.setdefault(document.real, []).append(target.real)
            yield target

    def join(self) -> None:
        """After all documents are read: each component has its parameters, each values document its layers."""
        for real, component in self.program.components.items():
            self._join_component(real, component)
        for document in list(self.documents.read.values()):
            if isinstance(document.model, ParameterDocument) and document.real not in self.program.parameters:
                parameters, found = resolve(document.model)
                self.diagnostics += found
                self.program.parameters[document.real] = LinkedParameters(
                    parameters, document.model, broken=_hides_types(found)
                )
        self._join_layers()

    def _join_component(self, real: str, component: LinkedComponent) -> None:
        named = self._parameters_of.get(real, [])
        reals = list(dict.fromkeys(other for other, _ in named))
        for other, span in named[1:]:
            if other != reals[0]:
                first, name = self.documents.read[reals[0]], component.component.name
                self.diagnostics.append(codes.DISAGREEMENT.at(
                    span, component=name, other=os.path.basename(first.path), hint="leave one of them out",
                    related=[Related("named here", named[0][1])],
                ))
        period = component.component.period
        document = self.documents.read[reals[0]].model if reals else None
        if reals and not isinstance(document, ParameterDocument):
            component.parameters = LinkedParameters(of_no_document(period), component=component, broken=True)
            component.broken = True
        elif isinstance(document, ParameterDocument):
            parameters, found = resolve(document, period)
            self.diagnostics += found
            broken = _hides_types(found)
            component.parameters = LinkedParameters(parameters, document, component, broken)
            component.broken = component.broken or broken
            self.program.parameters.setdefault(reals[0], component.parameters)
        else:
            broken = component.parameters.broken
            component.parameters = LinkedParameters(of_no_document(period), None, component, broken)

    def _join_layers(self) -> None:
        values = self.program.values
        for real, linked in values.items():
            for other in self._extends.get(real, ()):
                if other not in values:
                    linked.broken = True  # the layer has errors of its own
                elif self._reaches(other, real):
                    layer = next(x for x in linked.document.extends if leads_to(x, linked.document, other))
                    self.diagnostics.append(value_codes.LAYER_CYCLE.at(layer.span, name=layer.value))
                    linked.broken = True
                else:
                    linked.extends.append(values[other])
                    values[other].is_extended = True
        for linked in values.values():
            for base in reversed(linked.layers()):  # its own component, else that of the nearest layer
                target = self._component_of.get(os.path.realpath(base.document.path))
                if target is not None:
                    linked.parameters = self._parameters(target)
                    break

    def _parameters(self, real: str) -> LinkedParameters | None:
        if real in self.program.components:
            return self.program.components[real].parameters
        return self.program.parameters.get(real)

    def _reaches(self, start: str, goal: str) -> bool:
        todo, seen = [start], set()
        while todo:
            real = todo.pop()
            if real == goal:
                return True
            if real not in seen:
                seen.add(real)
                todo += self._extends.get(real, ())
        return False


def _hides_types(found: Iterable[Diagnostic]) -> bool:
    """Whether some parameters have no usable type; a constraint that cannot be read harms no other."""
    return has_errors(fault for fault in found if fault.code != codes.BAD_EXPRESSION.id)


def leads_to(layer: Literal, document: ValuesDocument, real: str) -> bool:
    """Whether an entry of a document's `extends:` means the document with this real path."""
    return os.path.realpath(os.path.join(os.path.dirname(document.path), str(layer.value))) == real


def _similar(path: str, *suffixes: str) -> str:
    """The document in the same folder that was probably meant."""
    folder = os.path.dirname(path)
    try:
        names = [name for name in sorted(os.listdir(folder or ".")) if name.endswith(suffixes)]
    except OSError:
        return f"there is no folder '{folder}'"
    meant = suggest(os.path.basename(path), names)
    return f"did you mean '{meant}'?" if meant else ""
