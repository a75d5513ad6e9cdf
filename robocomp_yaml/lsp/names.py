"""The names of a program: where each is defined, and where it is used. Definition, references, hover, symbols and
completion read them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedGroup, LinkedInstance, LinkedStorm
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, LinkedValues, Program
from robocomp_yaml.model.component import LISTS
from robocomp_yaml.model.deployment import COMPONENT as OF_COMPONENT
from robocomp_yaml.model.interface import Constant, ExceptionType, Import, Interface, Map, Sequence, Struct, TypeRef
from robocomp_yaml.parameters.specification.document import MemberSpec, TypeSpec
from robocomp_yaml.source.tree import Mapping, Node

MODULE, INTERFACE, TOPIC, METHOD, EVENT = "module", "interface", "topic", "method", "event"
TYPE, CONSTANT, EXCEPTION, MEMBER = "type", "constant", "exception", "member"
COMPONENT, PARAMETER, PARAMETER_TYPE = "component", "parameter", "type of parameters"
DEPLOYMENT, HOST, SERVICE, ENTRY, GROUP = "deployment", "host", "service", "entry", "group"

Key = tuple[str, ...]
"""What a name means: its kind, its document and the names around it."""


class DefinedName(msgspec.Struct, frozen=True):
    """`says` describes it in the words of the document; `inside` is the name that contains it."""

    key: Key
    name: str
    span: Span
    says: str = ""
    doc: str = ""
    inside: Key = ()

    @property
    def kind(self) -> str:
        return self.key[0]


class Names:
    """All names of a program. Keys have the path of the document that defines the name, as its span has it."""

    def __init__(self, program: Program) -> None:
        self.defined: dict[Key, DefinedName] = {}
        self.uses: dict[Key, list[Span]] = {}
        self._by_file: dict[str, list[tuple[Span, Key]]] = {}
        for linked in program.modules.values():
            self._module(linked)
        for component in program.components.values():
            self._component(component)
        for parameters in program.parameters.values():
            if parameters.document is not None:
                document = parameters.document
                for name, spec in document.types:
                    key = PARAMETER_TYPE, document.path, name
                    self._define(DefinedName(key, name, spec.key_span, spec.kind, spec.doc))
                    self._types_in(document.path, spec)
                self._parameters(document.path, document.parameters, ())
        for values in program.values.values():
            self._values(values)
        for deployment in program.deployments.values():
            self._deployment(deployment)

    def at(self, file: str, line: int, column: int) -> tuple[Span, DefinedName] | None:
        """The name at a place, or right before it, with its definition."""
        for span, key in self._by_file.get(file, ()):
            if span.line == line == span.end_line and span.column <= column <= span.end_column and key in self.defined:
                return span, self.defined[key]
        return None

    def in_document(self, file: str) -> list[DefinedName]:
        """The names that a document defines, in its order."""
        found = (one for one in self.defined.values() if one.span.file == file)
        return sorted(found, key=lambda one: one.span)

    def of_kinds(self, *kinds: str) -> Iterator[DefinedName]:
        return (one for one in self.defined.values() if one.kind in kinds)

    def _define(self, one: DefinedName) -> None:
        if one.key not in self.defined:
            self.defined[one.key] = one
            self._by_file.setdefault(one.span.file, []).append((one.span, one.key))

    def _use(self, key: Key | None, span: Span) -> None:
        if key is not None and span.file:
            self.uses.setdefault(key, []).append(span)
            self._by_file.setdefault(span.file, []).append((span, key))

    # Interfaces

    def _module(self, linked: LinkedModule) -> None:
        module = linked.module
        path = module.path
        self._define(DefinedName((MODULE, path), module.name, module.span, f"module {module.name}", module.doc))
        self._imports(module.imports, linked.imports)
        for definition in module.definitions:
            key = _key_of(linked, definition)
            says = f"{key[0]} {module.name}.{definition.name}"
            self._define(DefinedName(key, definition.name, definition.span, says, definition.doc))
            if isinstance(definition, Interface):
                for method in definition.methods:
                    inputs = ", ".join(f"{one.name}: {one.type.text}" for one in (*method.inputs, *method.outputs))
                    returns = f" → {method.returns.text}" if method.returns else ""
                    own = (EVENT if definition.is_topic else METHOD, path, definition.name, method.name)
                    says = f"{definition.name}.{method.name}({inputs}){returns}"
                    self._define(DefinedName(own, method.name, method.span, says, method.doc, key))
                    parts = [one.type for one in (*method.inputs, *method.outputs)]
                    self._refer(linked, [*parts, *method.throws, *([method.returns] if method.returns else [])])
            elif isinstance(definition, (Struct, ExceptionType)):
                for member in definition.members:
                    own = MEMBER, path, definition.name, member.name
                    says = f"{definition.name}.{member.name}: {member.type.text}"
                    self._define(DefinedName(own, member.name, member.span, says, member.doc, key))
                self._refer(linked, (member.type for member in definition.members))
            elif isinstance(definition, Sequence):
                self._refer(linked, [definition.element])
            elif isinstance(definition, Map):
                self._refer(linked, [definition.key, definition.value])
            elif isinstance(definition, Constant):
                self._refer(linked, [definition.type])

    def _imports(self, imports: Iterable[Import], modules: Iterable[LinkedModule]) -> None:
        by_stem = {one.module.stem: one.module.path for one in modules}
        for imported in imports:
            if path := by_stem.get(imported.stem):
                self._use((MODULE, path), imported.span)

    def _refer(self, linked: LinkedModule, references: Iterable[TypeRef]) -> None:
        for reference in references:
            found = linked.find(reference)
            if found is not None:
                self._use(_key_of(*found), reference.span)

    # Components and parameters

    def _component(self, linked: LinkedComponent) -> None:
        component = linked.component
        says = f"component {component.name}, in {component.language.target.title}"
        self._define(DefinedName((COMPONENT, component.path), component.name, component.span, says, component.doc))
        self._imports(component.imports, linked.imports)
        for list_ in LISTS:
            for port in getattr(linked, list_):
                self._use(_key_of(port.scope, port.interface), port.use.span)

    def _parameters(self, path: str, members: Iterable[MemberSpec], outer: tuple[str, ...]) -> None:
        for member in members:
            steps = (*outer, member.name)
            what = member.spec.name or member.spec.kind
            inside = (PARAMETER, path, *outer) if outer else ()
            says = f"parameter {'.'.join(steps)}: {what}"
            doc = member.doc or member.spec.doc
            self._define(DefinedName((PARAMETER, path, *steps), member.name, member.span, says, doc, inside))
            self._types_in(path, member.spec)
            if member.spec.kind == "group":
                self._parameters(path, member.spec.members, steps)

    def _types_in(self, path: str, spec: TypeSpec) -> None:
        if spec.name and (PARAMETER_TYPE, path, spec.name) in self.defined:
            self._use((PARAMETER_TYPE, path, spec.name), spec.span)
        if spec.element is not None:
            self._types_in(path, spec.element)
        for member in spec.members if spec.kind == "struct" else ():
            self._types_in(path, member.spec)

    def _values(self, linked: LinkedValues) -> None:
        own = linked.parameters
        if own is not None and own.document is not None:
            self._set(own.document.path, linked.document.section("parameters"), ())

    def _set(self, path: str, node: Node | None, outer: tuple[str, ...]) -> None:
        """The keys of values, which are names of parameters."""
        for key, value in node.items() if isinstance(node, Mapping) else ():
            steps = (*outer, *key.lexeme.split("."))
            if (PARAMETER, path, *steps) in self.defined:
                self._use((PARAMETER, path, *steps), key.span)
                self._set(path, value, steps)

    # Deployments

    def _deployment(self, linked: LinkedDeployment) -> None:
        deployment = linked.deployment
        path = deployment.path
        self._define(DefinedName((DEPLOYMENT, path), deployment.name, deployment.span, "deployment", deployment.doc))
        for host in deployment.hosts:
            says = f"host {host.name}: {host.address.text}"
            self._define(DefinedName((HOST, path, host.name), host.name, host.span, says, host.doc))
        for storm in deployment.services:
            self._define(DefinedName((SERVICE, path, storm.name), storm.name, storm.span, "service", storm.doc))
        for group in deployment.groups:
            self._define(DefinedName((GROUP, path, group.name), group.name, group.span, "group", group.doc))
        for entry in deployment.entries:
            says = f"{entry.kind} {entry.target.text}"
            self._define(DefinedName((ENTRY, path, entry.name), entry.name, entry.span, says, entry.doc))
        placed = [*(one.host for one in deployment.services), *(one.host for one in deployment.groups)]
        for text in (*placed, *(one.host for one in deployment.entries)):
            if text is not None:
                self._use((HOST, path, text.text), text.span)
        by_span = {one.entry.span: one for one in linked.instances.values()}
        for entry in deployment.entries:
            instance = by_span.get(entry.span)
            if entry.kind == OF_COMPONENT and instance is not None and instance.component is not None:
                self._use((COMPONENT, instance.component.component.path), entry.target.span)
                own = instance.component.parameters.document
                if own is not None:
                    self._set(own.path, entry.settings, ())
            for pair in entry.connect:
                self._name(linked, pair.text, pair.span)
            for text in entry.after:
                self._name(linked, text.text, text.span)
        for group in deployment.groups:
            for member in group.members:
                self._name(linked, member.text, member.span)

    def _name(self, linked: LinkedDeployment, text: str, span: Span) -> None:
        for target in linked.find(text, "")[0][:1]:
            match target:
                case LinkedInstance():
                    key: Key = ENTRY, target.document.path, target.entry.name
                case LinkedStorm():
                    key = SERVICE, target.document.path, target.storm.name
                case LinkedGroup():
                    key = GROUP, target.document.path, target.group.name
            self._use(self._known(key, target), span)

    def _known(self, key: Key, target: LinkedInstance | LinkedStorm | LinkedGroup) -> Key:
        """The key of an entry with instances, whose names have numbers, is that of the entry as written."""
        if key in self.defined or not isinstance(target, LinkedInstance):
            return key
        span = target.entry.span
        return next((k for s, k in self._by_file.get(span.file, ()) if s == span), key)


def _key_of(scope: LinkedModule, definition: object) -> Key:
    path, name = scope.module.path, str(getattr(definition, "name", ""))
    match definition:
        case Interface(is_topic=is_topic):
            return (TOPIC if is_topic else INTERFACE), path, name
        case ExceptionType():
            return EXCEPTION, path, name
        case Constant():
            return CONSTANT, path, name
    return TYPE, path, name
