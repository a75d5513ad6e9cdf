"""Names that are illegal in Java after Ice's mapping. They are errors if a component in Java needs the module."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.emit.lowering.types import results
from robocomp_yaml.languages._shared.checks import needed_by, result_structs, users
from robocomp_yaml.languages.java import LANGUAGE
from robocomp_yaml.languages.java.names import PACKAGE
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.references import Identifier, groups, kind_of, types_of
from robocomp_yaml.model.interface import ExceptionType, Interface, Map, Member, Sequence, Struct, TypeRef

# slice2java does not escape these, and Java rejects them (`tests/ice/test_java_names.py` compares with both).
TYPES = frozenset(
    """CloneNotSupportedException Override Throwable com context current istr java ostr permits record sealed
    serialVersionUID slice var yield""".split()
)
INSIDE = {
    "member": frozenset(("com", "java", "serialVersionUID")), "enumerator": frozenset(("com", "java", "slice")),
    "parameter": frozenset(("com", "ex")), "method": frozenset(("yield",)),
}  # fmt: skip


def check(program: Program) -> Iterator[Diagnostic]:
    for scope, (user, *_) in users(program, LANGUAGE).items():
        for name, other in _impossible(scope):
            yield _diagnostic(name, other, user)


def _impossible(scope: LinkedModule) -> Iterator[tuple[Identifier, str]]:
    """The illegal names, each with a proposed one."""
    for definition in scope.module.definitions:
        if definition.name in TYPES and not isinstance(definition, (Sequence, Map)):
            yield Identifier(kind_of(definition), definition.name, definition.span), _other(definition.name)
        for group in groups(definition):
            for name in group:
                if name.text in INSIDE.get(name.kind, ()):
                    yield name, _other(name.text)
        match definition:
            case Struct(name=own, members=members):
                yield from _hiding(members, [member.type for member in members], scope, own)
            case ExceptionType(members=members):
                yield from _hiding(members, [member.type for member in members], scope)
            case Interface(methods=methods):
                for method in methods:
                    if len(results(method)) > 1:
                        yield from _hiding(method.outputs, results(method), scope)
                yield from _hidden(definition)


def _hiding(
    members: Iterable[Member], types: Collection[TypeRef], scope: LinkedModule, own: str = ""
) -> Iterator[tuple[Identifier, str]]:
    """In a class, a member hides the type of the same name from the code that marshals the other members; a member
    `slice` hides the package of all modules. A member of that type itself is hidden too."""
    for member in members:
        hidden = any(_is_hidden(ref, member, scope) for ref in types)
        if hidden or member.name == own:
            yield Identifier("member", member.name, member.span), _other(member.name)


def _is_hidden(ref: TypeRef, member: Member, scope: LinkedModule) -> bool:
    if ref.is_basic:
        return False
    found = scope.find(ref)
    if found is None:
        return False  # the unknown type is reported
    home, definition = found
    if home.module.name != scope.module.name:
        return member.name == PACKAGE
    is_class = not isinstance(definition, (Sequence, Map))
    return is_class and definition.name == member.name and member.type.text != ref.text


def _hidden(interface: Interface) -> Iterator[tuple[Identifier, str]]:
    """A method with several results returns a class inside of the interface, which hides a type of the same name."""
    made = result_structs(interface)
    for ref in types_of(interface):
        if ref.name in made:
            method = made[ref.name]
            yield Identifier("method", method.name, method.span), f"{method.name}Now"


def _other(name: str) -> str:
    return f"the{name[:1].upper()}{name[1:]}" if name[0].islower() else f"{name}Value"


def _diagnostic(name: Identifier, other: str, user: LinkedComponent) -> Diagnostic:
    return codes.IMPOSSIBLE_NAME.at(
        name.span,
        language=LANGUAGE.title,
        kind=name.kind,
        name=name.text,
        related=[needed_by(user)],
        hint=f"call it '{other}'",
    )
