"""Types that contain themselves: no value of such a type could ever be finished, and Slice refuses them."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml import digraph
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.link.references import kind_of, types_of
from robocomp_yaml.model.interface import Struct, TypeDefinition


def check(program: Program) -> Iterator[Diagnostic]:
    """Imports form no circles, so a circle of types lies within one module. One is told of each knot of types that
    contain each other, from the type that the author wrote first."""
    for linked in program.modules.values():
        types = {definition.name: definition for definition in reversed(linked.module.types)}
        uses = {name: [other for other in _used(linked, types[name]) if other in types] for name in types}
        for knot in digraph.cyclic_components(uses):
            start = min(knot, key=lambda name: types[name].span)
            circle = [types[name] for name in digraph.cycle_through(uses, knot, start)]
            first = circle[0]
            inside = [_holds(linked, d, circle[(n + 1) % len(circle)]) for n, d in enumerate(circle)]
            names = [definition.name for definition in (*circle, first)]
            yield codes.VALUE_CYCLE.at(
                inside[0], kind=kind_of(first), name=first.name, cycle=" → ".join(names),
                hint="hold an identifier or a key of the other value, not the value itself",
                related=[
                    Related(f"'{d.name}' holds '{circle[(n + 1) % len(circle)].name}' here", inside[n])
                    for n, d in enumerate(circle) if n
                ],
            )  # fmt: skip


def _holds(linked: LinkedModule, outer: TypeDefinition, inner: TypeDefinition) -> Span:
    """Where one type holds another: the member of a struct, else the type of the elements."""
    places = [m.span for m in outer.members] if isinstance(outer, Struct) else [ref.span for ref in types_of(outer)]
    for place, ref in zip(places, types_of(outer), strict=True):
        found = None if ref.is_basic else linked.find(ref)
        if found and found[1] is inner:
            return place
    return outer.span


def _used(linked: LinkedModule, definition: TypeDefinition) -> list[str]:
    """The own types that a type contains."""
    found = (linked.find(ref) for ref in types_of(definition) if not ref.is_basic)
    return [other[1].name for other in found if other and other[0] is linked]
