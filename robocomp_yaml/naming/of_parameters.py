"""The names of parameter documents, and their uses: in values documents, expressions, spellings and flat configs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from robocomp_yaml.addresses.own_configuration import own_configuration
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port, Program
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.naming.of_components import port_key
from robocomp_yaml.naming.of_interfaces import key_of
from robocomp_yaml.parameters.specification.document import ConstraintSpec, MemberSpec, ParameterDocument, TypeSpec
from robocomp_yaml.parameters.specification.expression import (
    Attribute,
    Each,
    Expression,
    ExpressionError,
    NameExpression,
    parse,
    parts,
)
from robocomp_yaml.parameters.specification.legacy_spelling import LegacySpelling
from robocomp_yaml.semantics import connections
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

_STEP = re.compile(r"[^.\[\]]+")


def collect(names: Names, program: Program) -> None:
    documents = {one.document.path: one.document for one in program.parameters.values() if one.document is not None}
    for document in documents.values():
        for name, spec in document.types:
            key = kinds.PARAMETER_TYPE, document.path, name
            names.define(DefinedName(key, name, spec.key_span, spec.kind, spec.doc))
            for member in spec.members:
                own = kinds.PARAMETER_MEMBER, document.path, name, member.name
                says = f"{name}.{member.name}: {member.spec.name or member.spec.kind}"
                names.define(DefinedName(own, member.name, member.span, says, member.doc or member.spec.doc, key))
        for _, spec in document.types:
            _types_in(names, document.path, spec)
        _parameters(names, document.path, document.parameters, ())
    for document in documents.values():
        tree = ParameterTree(names, document)
        for rule in document.rules:
            _rule(tree, rule)
        for spelling in document.legacy:
            tree.spelling(spelling)
        for member in document.parameters:
            tree.default(member)
    for parameters in program.parameters.values():
        if parameters.document is not None and parameters.component is not None:
            document = parameters.document
            _component(names, parameters.component, document.component, document.component_span)
    for values in program.values.values():
        _values(names, values)
    for linked in program.components.values():
        _flat(names, linked, program)


def _parameters(names: Names, path: str, members: Iterable[MemberSpec], outer: tuple[str, ...]) -> None:
    for member in members:
        steps = (*outer, member.name)
        what = member.spec.name or member.spec.kind
        inside = (kinds.PARAMETER, path, *outer) if outer else ()
        says = f"parameter {'.'.join(steps)}: {what}"
        doc = member.doc or member.spec.doc
        names.define(DefinedName((kinds.PARAMETER, path, *steps), member.name, member.span, says, doc, inside))
        _types_in(names, path, member.spec)
        if member.spec.kind == "group":
            _parameters(names, path, member.spec.members, steps)


def _types_in(names: Names, path: str, spec: TypeSpec) -> None:
    if spec.name and (kinds.PARAMETER_TYPE, path, spec.name) in names.defined:
        names.use((kinds.PARAMETER_TYPE, path, spec.name), spec.span.inside(spec.name, 0, len(spec.name)))
    if spec.element is not None:
        _types_in(names, path, spec.element)
    for member in spec.members if spec.kind == "struct" else ():
        _types_in(names, path, member.spec)


class ParameterTree:
    """The parameters of a document, in which paths are followed. `path` is the document's."""

    def __init__(self, names: Names, document: ParameterDocument) -> None:
        self.names, self.path_of = names, document.path
        self._types = dict(document.types)
        self._top = document.parameters

    def _inside(self, spec: TypeSpec | None, outer: tuple[str, ...]) -> tuple[Iterable[MemberSpec], kinds.Key]:
        """The members of a type, and the beginning of their keys."""
        if spec is None:
            return self._top, (kinds.PARAMETER, self.path_of)
        if spec.kind == "group":
            return spec.members, (kinds.PARAMETER, self.path_of, *outer)
        if spec.name in self._types:
            return self._types[spec.name].members, (kinds.PARAMETER_MEMBER, self.path_of, spec.name)
        return (), ()

    def step(
        self, spec: TypeSpec | None, outer: tuple[str, ...], name: str, span: Span, *, is_in_code: bool = False
    ) -> tuple[TypeSpec, tuple[str, ...]] | None:
        """Uses the member of a type, None for all parameters. Returns the member's type. Expressions have the names of
        members `is_in_code`: one that `as:` sets stays when the member is renamed."""
        members, head = self._inside(spec, outer)
        member = next((one for one in members if ((one.code_name if is_in_code else "") or one.name) == name), None)
        if member is None:
            return None
        self.names.use((*head, member.name), span, is_path=member.name != name)
        return member.spec, (*outer, member.name)

    def path(self, text: str, span: Span) -> tuple[TypeSpec, tuple[str, ...]] | None:
        """Uses all that a path names: `camera.width`, `motors[0].speed`. Returns the type at its end."""
        return self._path(None, (), text, span)

    def _path(
        self, spec: TypeSpec | None, outer: tuple[str, ...], text: str, span: Span
    ) -> tuple[TypeSpec, tuple[str, ...]] | None:
        for found in _STEP.finditer(text):
            if text[found.start() - 1 : found.start()] == "[":
                spec = spec.element if spec is not None else None
                if spec is None:
                    return None
                continue
            if spec is not None and spec.kind == "map" and spec.element is not None:
                spec = spec.element  # a name of the map
                continue
            made = self.step(spec, outer, found[0], span.inside(text, found.start(), found.end()))
            if made is None:
                return None
            spec, outer = made
        return (spec, outer) if spec is not None else None

    def spelling(self, spelling: LegacySpelling) -> None:
        """Uses the parameter that an entry of `legacy:` spells, and the members of its records."""
        found = self.path(spelling.path, spelling.span)
        spec, outer = found if found is not None else (None, ())
        while spec is not None and spec.element is not None:
            spec = spec.element
        for name, span in spelling.members if spec is not None else ():
            self.step(spec, outer, name, span)

    def values(self, node: Node | None, spec: TypeSpec | None = None, outer: tuple[str, ...] = ()) -> None:
        """Uses the keys of values, which are names of parameters, paths, or members of records."""
        if isinstance(node, Sequence) and spec is not None:
            for item in node.items:
                self.values(item, spec.element, outer)
        elif isinstance(node, Mapping) and spec is not None and spec.kind == "map":
            for _, value in node.items():
                self.values(value, spec.element, outer)
        elif isinstance(node, Mapping):
            for key, value in node.items():
                found = self._path(spec, outer, key.lexeme, key.span)
                if found is not None:
                    self.values(value, *found)

    def default(self, member: MemberSpec) -> None:
        """Uses the members of the records in a default."""
        self.values(member.default, member.spec, (member.name,))
        for inner in member.spec.members if member.spec.kind == "group" else ():
            self.default(inner)


def _rule(tree: ParameterTree, rule: ConstraintSpec) -> None:
    node = rule.that
    if not isinstance(node, Scalar):
        return
    try:
        expression = parse(node.lexeme)
    except ExpressionError:
        return
    _expression(tree, expression, node, {})


_Known = dict[str, tuple[TypeSpec, tuple[str, ...]] | None]


def _expression(
    tree: ParameterTree, part: Expression | Each, node: Scalar, variables: _Known
) -> tuple[TypeSpec, tuple[str, ...]] | None:  # fmt: skip
    """Uses the names in an expression. Returns the type of one that is a path."""

    def span(at: int, name: str) -> Span:
        return node.span.inside(node.lexeme, at, at + len(name))

    match part:
        case NameExpression(name=name, at=at):
            return variables[name] if name in variables else tree.step(None, (), name, span(at, name), is_in_code=True)
        case Attribute(of=of, name=name, at=at):
            found = _expression(tree, of, node, variables)
            return tree.step(*found, name, span(at, name), is_in_code=True) if found is not None else None
        case Each(source=source, variable=variable):
            found = _expression(tree, source, node, variables)
            element = (found[0].element, found[1]) if found is not None and found[0].element is not None else None
            inner: _Known = {**variables, variable: element}
            for one in (part.element, *([part.condition] if part.condition is not None else [])):
                _expression(tree, one, node, inner)
            return None
    last = None
    for inside in parts(part):
        made = _expression(tree, inside, node, variables)
        last = last or made
    is_index = type(part).__name__ == "Index" and last is not None and last[0].element is not None
    return (last[0].element, last[1]) if is_index and last is not None and last[0].element is not None else None


def _values(names: Names, linked: LinkedValues) -> None:
    own = linked.parameters
    if own is None:
        return
    if own.document is not None:
        ParameterTree(names, own.document).values(linked.document.section("parameters"))
    if own.component is not None:
        _component(names, own.component, linked.document.component, linked.document.span)
        for section in ("endpoints", "proxies", "topics"):
            for key, _ in _entries(linked.document.section(section)):
                _adapter(names, own.component, section, key.lexeme, key.span)
        required = {port.name: port for port in own.component.requires}
        for key, node in _entries(linked.document.section("proxies")):
            text = node.get("proxy") if isinstance(node, Mapping) else node
            if key.lexeme in required and isinstance(text, Scalar):
                identity(names, required[key.lexeme], text.lexeme, text.span)


def _component(names: Names, linked: LinkedComponent, text: str, span: Span) -> None:
    """What a document is about: the path of a component's document."""
    if text:
        names.use((kinds.COMPONENT, linked.component.path), span.inside(text, 0, len(text)), is_path=True)


def _adapter(names: Names, component: LinkedComponent, section: str, text: str, span: Span) -> None:
    """A port of a component, under its name in a section: that of a topic's adapter ends in Topic."""
    ports = {
        "endpoints": component.implements, "proxies": component.requires,
        "topics": (*component.publishes, *component.subscribes),
    }[section]  # fmt: skip
    known = [(port, port.name) for port in ports]
    if section == "endpoints":
        known += [(port, f"{port.name}Topic") for port in component.subscribes]
    for port, name in known:
        if text == name:
            names.use(port_key(component, port), span.inside(text, 0, len(port.name)))
            return


def _entries(node: Node | None) -> Iterator[tuple[Scalar, Node]]:
    yield from node.items() if isinstance(node, Mapping) else ()


# Flat configs


def _flat(names: Names, linked: LinkedComponent, program: Program) -> None:
    """The keys of a component's flat `etc/config`, unless the next compile writes it again from a values document."""
    flat = own_configuration(linked, program).flat
    if flat is None:
        return
    keys: dict[str, tuple[kinds.Key, str]] = {}
    for port in linked.ports:
        key = port_key(linked, port)
        made = (
            *connections.endpoints(port.name),
            *connections.topic_endpoints(port.name),
            *connections.proxy(port.name),
            connections.prefix(port.name),
            connections.prefix(f"{port.name}Pub"),
        )
        keys |= dict.fromkeys(made, (key, port.name))  # fmt: skip
    proxies = {name: port for port in linked.requires for name in connections.proxy(port.name)}
    document = linked.parameters.document
    spelled = {one.path for one in document.legacy} if document is not None else set()
    tree = ParameterTree(names, document) if document is not None else None
    for name, entry in flat.entries.items():
        span = Span(flat.path, entry.line, entry.column, entry.line, entry.column + len(name))
        if name in proxies:
            first = entry.at - flat.text.rfind("\n", 0, entry.at)
            proxy = flat.text[entry.at :].split("\n", 1)[0]
            written = Span(flat.path, entry.line, first, entry.line, first + len(proxy))
            identity(names, proxies[name], proxy, written)
        if name in keys:
            key, port_name = keys[name]
            at = name.index(port_name)
            names.use(key, span.inside(name, at, at + len(port_name)))
        elif tree is not None and not any(name == path or name.startswith(f"{path}.") for path in spelled):
            tree.path(name, span)


def identity(names: Names, port: Port, proxy: str, span: Span) -> None:
    """The identity of the object that a proxy names: the interface in lower case."""
    name = port.interface.name.lower()
    if found := re.match(rf'[ \t]*"?{re.escape(name)}(?![\w/])', proxy):
        at = span.inside(proxy, found.end() - len(name), found.end())
        names.use(key_of(port.scope, port.interface), at, is_identity=True)
