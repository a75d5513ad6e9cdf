"""Names that Java cannot have where Ice's mapping puts them: told where a component in Java needs the module."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from robocomp_yaml.diag.codes import languages as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.emit.lowering.types import resolve, results
from robocomp_yaml.languages.java import LANGUAGE
from robocomp_yaml.languages.java.names import PACKAGE
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Program
from robocomp_yaml.link.references import Name, groups, kind_of, types_of
from robocomp_yaml.model.interface import ExceptionType, Interface, Map, Member, Sequence, Struct, TypeRef

# What slice2java leaves as it is, and Java does not take (`tests/ice/test_java_names.py` asks both).
TYPES = frozenset(
    """CloneNotSupportedException Override Throwable com context current istr java ostr permits record sealed
    serialVersionUID slice var yield""".split()
)
INSIDE = {
    "member": frozenset(("com", "java", "serialVersionUID")), "enumerator": frozenset(("com", "java", "slice")),
    "parameter": frozenset(("com", "ex")), "method": frozenset(("yield",)),
}  # fmt: skip


def check(program: Program) -> Iterator[Diagnostic]:
    users: dict[LinkedModule, LinkedComponent] = {}
    for component in program.components.values():
        if component.component.language.target is LANGUAGE:
            for scope in component.modules():
                users.setdefault(scope, component)
    for scope, user in users.items():
        for name, other in _impossible(scope):
            yield _told(name, other, user)


def _impossible(scope: LinkedModule) -> Iterator[tuple[Name, str]]:
    """Names, and what each should be called."""
    for definition in scope.module.definitions:
        if definition.name in TYPES and not isinstance(definition, Sequence | Map):
            yield Name(kind_of(definition), definition.name, definition.span), _other(definition.name)
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
) -> Iterator[tuple[Name, str]]:
    """In a class, a member hides the type of the same name from the code that reads and writes the others; one called
    `slice` the package of all modules. What is of that type itself leads there as well."""
    for member in members:
        hidden = any(_is_hidden(ref, member, scope) for ref in types)
        if hidden or member.name == own:
            yield Name("member", member.name, member.span), _other(member.name)


def _is_hidden(ref: TypeRef, member: Member, scope: LinkedModule) -> bool:
    if ref.is_basic:
        return False
    home, definition = resolve(ref, scope)
    if home.module.name != scope.module.name:
        return member.name == PACKAGE
    is_class = not isinstance(definition, Sequence | Map)
    return is_class and definition.name == member.name and member.type.text != ref.text


def _hidden(interface: Interface) -> Iterator[tuple[Name, str]]:
    """What a method gives back, if it is more than one thing, becomes a class in the interface: it hides a type."""
    made = {f"{m.name[:1].upper()}{m.name[1:]}Result": m for m in interface.methods if len(results(m)) > 1}
    for ref in types_of(interface):
        if ref.name in made:
            method = made[ref.name]
            yield Name("method", method.name, method.span), f"{method.name}Now"


def _other(name: str) -> str:
    return f"the{name[:1].upper()}{name[1:]}" if name[0].islower() else f"{name}Value"


def _told(name: Name, other: str, user: LinkedComponent) -> Diagnostic:
    related = Related(f"component {user.component.name} is in Java, and needs it", user.component.language.span)
    return codes.IMPOSSIBLE_NAME.at(
        name.span,
        language=LANGUAGE.title,
        kind=name.kind,
        name=name.text,
        related=[related],
        hint=f"call it '{other}'",
    )
