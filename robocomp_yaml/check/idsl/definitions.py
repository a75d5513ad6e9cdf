"""Types that Slice rejects: types that contain themselves, empty types, numbers of enums, keys of maps."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml import digraph
from robocomp_yaml.check import repeated
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.link.references import kind_of, types_of
from robocomp_yaml.model.interface import Enum, Enumerator, Map, Sequence, Struct, TypeDefinition, TypeRef

LARGEST = 2**31 - 1


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.modules.values():
        yield from _cycles(linked)
        for definition in linked.module.types:
            if isinstance(definition, Enum):
                yield from _numbers(definition)
                if not definition.enumerators:
                    yield _empty(definition, "enum", "enumerators", "add at least one: {enum: [first]}")
            elif isinstance(definition, Struct) and not definition.members:
                yield _empty(definition, "struct", "members", "add a member: {struct: {x: float}}")
            elif isinstance(definition, Map):
                yield from _key(linked, definition.key)


def _empty(definition: Enum | Struct, kind: str, parts: str, hint: str) -> Diagnostic:
    return codes.EMPTY_TYPE.at(definition.list_span, kind=kind, name=definition.name, parts=parts, hint=hint)


def _cycles(linked: LinkedModule) -> Iterator[Diagnostic]:
    """Reports types that contain themselves: one circle of each group of types that contain each other, from the type
    that is first in the document. Imports have no circles, so a circle of types is in one module."""
    types = {definition.name: definition for definition in reversed(linked.module.types)}
    uses = {name: [other for other in _used(linked, types[name]) if other in types] for name in types}
    for knot in digraph.cyclic_components(uses):
        start = min(knot, key=lambda name: types[name].span)
        circle = [types[name] for name in digraph.cycle_through(uses, knot, start)]
        first = circle[0]
        inside = [_span_of_use(linked, d, circle[(n + 1) % len(circle)]) for n, d in enumerate(circle)]
        names = [definition.name for definition in (*circle, first)]
        yield codes.VALUE_CYCLE.at(
            inside[0], kind=kind_of(first), name=first.name, cycle=" → ".join(names),
            hint="use an identifier or a key of the other value, not the value itself",
            related=[
                Related(f"'{d.name}' contains '{circle[(n + 1) % len(circle)].name}'", inside[n])
                for n, d in enumerate(circle) if n
            ],
        )  # fmt: skip


def _span_of_use(linked: LinkedModule, outer: TypeDefinition, inner: TypeDefinition) -> Span:
    """The span where one type contains another: the member of a struct, or the type of the elements."""
    spans = [m.span for m in outer.members] if isinstance(outer, Struct) else [ref.span for ref in types_of(outer)]
    for span, ref in zip(spans, types_of(outer), strict=True):
        target = None if ref.is_basic else linked.find(ref)
        if target and target[1] is inner:
            return span
    return outer.span


def _used(linked: LinkedModule, definition: TypeDefinition) -> list[str]:
    """The types of the same module that a type contains."""
    targets = (linked.find(ref) for ref in types_of(definition) if not ref.is_basic)
    return [target[1].name for target in targets if target and target[0] is linked]


def _numbers(enum: Enum) -> Iterator[Diagnostic]:
    numbered: list[tuple[int, Enumerator]] = []
    number = -1
    for enumerator in enum.enumerators:
        number = number + 1 if enumerator.value is None else enumerator.value
        if 0 <= number <= LARGEST:
            numbered.append((number, enumerator))
            continue
        yield codes.ENUM_NUMBER.at(
            enumerator.span,
            name=enumerator.name,
            number=number,
            largest=LARGEST,
            hint="write its number: without one, it is the number before, plus 1",
        )
    for (number, other), (_, enumerator) in repeated(numbered, lambda pair: pair[0]):
        yield codes.ENUM_NUMBER_TWICE.at(
            enumerator.span,
            name=enumerator.name,
            other=other.name,
            number=number,
            hint="change one of the numbers",
            related=[Related(f"'{other.name}'", other.span)],
        )


def _key(linked: LinkedModule, key: TypeRef) -> Iterator[Diagnostic]:
    """Checks the key of a map: its values must compare exactly; those of a struct do if its members do."""

    def members(part: tuple[LinkedModule, TypeRef]) -> Iterator[tuple[LinkedModule, TypeRef]]:
        target = part[0].find(part[1])
        if target is not None and isinstance(target[1], Struct):
            yield from ((target[0], member.type) for member in target[1].members)

    reasons = [_reason(scope, ref) for scope, ref in digraph.reachable([(linked, key)], members)]
    other = next((reason for reason in reasons if reason not in ("", _SEQUENCE)), "")
    if not other and _SEQUENCE in reasons:
        hint = "use a string, an integer, or a struct of them"
        yield codes.SEQUENCE_KEY.at(key.span, type=key.text, hint=hint)
    elif other:
        hint = "a key is a bool, an integer, a string, an enum, or a struct of these"
        yield codes.MAP_KEY.at(key.span, type=key.text, reason=other, hint=hint)


_SEQUENCE = "sequence"


def _reason(scope: LinkedModule, ref: TypeRef) -> str:
    """Why a type by itself cannot be a key, or ''."""
    if ref.text in ("float", "double"):
        return f"a {ref.text} cannot be compared exactly"
    target = None if ref.is_basic else scope.find(ref)
    if target is not None and isinstance(target[1], Map):
        return "a map cannot be a key"
    return _SEQUENCE if target is not None and isinstance(target[1], Sequence) else ""
