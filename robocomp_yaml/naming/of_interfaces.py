"""The names of interface documents, and their uses there and in mock scripts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedModule, Program, interfaces_by_name
from robocomp_yaml.model.interface import (
    Constant,
    Enum,
    ExceptionType,
    Import,
    Interface,
    Literal,
    Map,
    Method,
    Sequence,
    Struct,
    TypeRef,
)
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Key, Names
from robocomp_yaml.source.discover import is_script
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.source.tree import Sequence as SequenceNode


def collect(names: Names, program: Program, trees: Mapping[str, Node | None]) -> None:
    for linked in program.modules.values():
        _module(names, linked)
    for path, tree in trees.items():
        if is_script(path) and isinstance(tree, MappingNode):
            _script(names, program, tree)


def key_of(scope: LinkedModule, definition: object) -> Key:
    path, name = scope.module.path, str(getattr(definition, "name", ""))
    match definition:
        case Interface(is_topic=is_topic):
            return (kinds.TOPIC if is_topic else kinds.INTERFACE), path, name
        case ExceptionType():
            return kinds.EXCEPTION, path, name
        case Constant():
            return kinds.CONSTANT, path, name
    return kinds.TYPE, path, name


def method_key(interface: Key, method: str) -> Key:
    return (kinds.EVENT if interface[0] == kinds.TOPIC else kinds.METHOD), *interface[1:], method


def imports(names: Names, imported: Iterable[Import], modules: Iterable[LinkedModule]) -> None:
    by_stem = {one.module.stem: one.module.path for one in modules}
    for one in imported:
        if path := by_stem.get(one.stem):
            names.use((kinds.MODULE, path), one.span, is_path=True)


def qualified(names: Names, scope: LinkedModule, definition: object, text: str, span: Span) -> None:
    """A name with its module before it, or without."""
    last = text.rpartition(".")[2]
    at = len(text) - len(last)
    names.use(key_of(scope, definition), span.inside(text, at, len(text)))
    if at:
        is_stem = text[: at - 1] != scope.module.name
        names.use((kinds.MODULE, scope.module.path), span.inside(text, 0, at - 1), is_path=is_stem)


def _module(names: Names, linked: LinkedModule) -> None:
    module, path = linked.module, linked.module.path
    names.define(DefinedName((kinds.MODULE, path), module.name, module.span, f"module {module.name}", module.doc))
    imports(names, module.imports, linked.imports)
    for definition in module.definitions:
        key = key_of(linked, definition)
        says = f"{key[0]} {module.name}.{definition.name}"
        names.define(DefinedName(key, definition.name, definition.span, says, definition.doc))
        match definition:
            case Interface(methods=methods):
                for method in methods:
                    inputs = ", ".join(f"{one.name}: {one.type.text}" for one in (*method.inputs, *method.outputs))
                    returns = f" → {method.returns.text}" if method.returns else ""
                    says = f"{definition.name}.{method.name}({inputs}){returns}"
                    own = method_key(key, method.name)
                    names.define(DefinedName(own, method.name, method.span, says, method.doc, key))
                    for argument in (*method.inputs, *method.outputs):
                        says = f"{definition.name}.{method.name}: {argument.name}: {argument.type.text}"
                        inside = kinds.ARGUMENT, path, definition.name, method.name, argument.name
                        names.define(DefinedName(inside, argument.name, argument.span, says, argument.doc, own))
                    parts = [one.type for one in (*method.inputs, *method.outputs)]
                    _refer(names, linked, [*parts, *method.throws, *([method.returns] if method.returns else [])])
            case Struct(members=members) | ExceptionType(members=members):
                for member in members:
                    own = kinds.MEMBER, path, definition.name, member.name
                    says = f"{definition.name}.{member.name}: {member.type.text}"
                    names.define(DefinedName(own, member.name, member.span, says, member.doc, key))
                    _enumerator(names, linked, member.type, member.default)
                _refer(names, linked, (member.type for member in members))
            case Enum(enumerators=enumerators):
                for one in enumerators:
                    own = kinds.ENUMERATOR, path, definition.name, one.name
                    says = f"{definition.name}.{one.name}"
                    names.define(DefinedName(own, one.name, one.span, says, one.doc, key))
            case Sequence(element=element):
                _refer(names, linked, [element])
            case Map(key=of_key, value=value):
                _refer(names, linked, [of_key, value])
            case Constant(type=type_, value=literal):
                _refer(names, linked, [type_])
                _enumerator(names, linked, type_, literal)


def _refer(names: Names, linked: LinkedModule, references: Iterable[TypeRef]) -> None:
    for reference in references:
        found = linked.find(reference)
        if found is not None:
            qualified(names, *found, reference.text, reference.span)


def _enumerator(names: Names, linked: LinkedModule, type_: TypeRef, literal: Literal | None) -> None:
    """A value that is an enumerator, perhaps with its type before it."""
    found = linked.find(type_) if literal is not None else None
    if literal is None or found is None or not isinstance(found[1], Enum):
        return
    name = literal.lexeme.rpartition(".")[2]
    key = kinds.ENUMERATOR, found[0].module.path, found[1].name, name
    if any(one.name == name for one in found[1].enumerators):
        names.use(key, literal.span.inside(literal.lexeme, len(literal.lexeme) - len(name), len(literal.lexeme)))


# Mock scripts


def _script(names: Names, program: Program, tree: MappingNode) -> None:
    known = interfaces_by_name(program.modules.values())
    for section in ("interfaces", "topics"):
        for key, node in _entries(tree.get(section)):
            found = known.get(key.lexeme, [])
            if len(found) == 1:
                qualified(names, *found[0], key.lexeme, key.span)
                of = key_of(*found[0])
                listed = node.get("messages")
                messages = listed.items if isinstance(listed, SequenceNode) else ()
                for called, said in (
                    *_entries(node.get("methods")),
                    *(pair for one in messages for pair in _entries(one)),
                ):
                    method = next((one for one in found[0][1].methods if one.name == called.lexeme), None)
                    if method is not None:
                        names.use(method_key(of, method.name), called.span.inside(method.name, 0, len(method.name)))
                        _arguments(names, found[0][0], of, method, said, is_message=section == "topics")


def _arguments(
    names: Names, scope: LinkedModule, interface: Key, method: Method, said: Node, *, is_message: bool
) -> None:  # fmt: skip
    """What a message of a topic contains, or the answers of a method: arguments, results and exceptions."""
    answers = said.items if isinstance(said, SequenceNode) else [said]
    given = [pair for one in answers for pair in _entries(one if is_message else one.get("out"))]
    known = {one.name: one.type for one in (*method.inputs, *method.outputs)}
    for key, value in given:
        if key.lexeme in known:
            names.use((kinds.ARGUMENT, *interface[1:], method.name, key.lexeme), _inside(key))
            _value(names, scope, known[key.lexeme], value)
    for answer in answers if not is_message else ():
        if method.returns is not None and (returned := answer.get("returns")) is not None:
            _value(names, scope, method.returns, returned)
        for key, value in _entries(answer.get("throws")):
            for reference in method.throws:
                if key.lexeme in (reference.text, reference.name) and (found := scope.find(reference)) is not None:
                    qualified(names, *found, key.lexeme, key.span)
                    _members(names, *found, value)


def _value(names: Names, scope: LinkedModule, type_: TypeRef, value: Node) -> None:
    """The members and enumerators in a value, as values documents have them."""
    match scope.find(type_):
        case (found, Sequence(element=element)):
            for item in value.items if isinstance(value, SequenceNode) else ():
                _value(names, found, element, item)
        case (found, Map(key=of_key, value=of_value)):
            for key, inner in _entries(value):
                _value(names, found, of_key, key)
                _value(names, found, of_value, inner)
            for item in value.items if isinstance(value, SequenceNode) else ():  # with keys that are no texts
                for part, of_part in (("key", of_key), ("value", of_value)):
                    if (inside := item.get(part)) is not None:
                        _value(names, found, of_part, inside)
        case (found, Enum(name=name, enumerators=enumerators)) if isinstance(value, Scalar):
            if any(one.name == value.lexeme for one in enumerators):
                names.use((kinds.ENUMERATOR, found.module.path, name, value.lexeme), _inside(value))
        case (found, Struct() as struct):
            _members(names, found, struct, value)


def _members(names: Names, scope: LinkedModule, definition: object, value: Node) -> None:
    """The members of a struct or exception in a value."""
    members = (
        {one.name: one.type for one in definition.members} if isinstance(definition, Struct | ExceptionType) else {}
    )
    for key, inner in _entries(value):
        if key.lexeme in members and isinstance(definition, Struct | ExceptionType):
            names.use((kinds.MEMBER, scope.module.path, definition.name, key.lexeme), _inside(key))
            _value(names, scope, members[key.lexeme], inner)


def _inside(word: Scalar) -> Span:
    """A word without its quotes."""
    return word.span.inside(word.lexeme, 0, len(word.lexeme))


def _entries(node: Node | None) -> Iterator[tuple[Scalar, Node]]:
    yield from node.items() if isinstance(node, MappingNode) else ()
