"""Types that contain themselves: no value of such a type could ever be finished, and Slice refuses them."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedModule, Program
from robocomp_yaml.link.references import kind_of, types_of
from robocomp_yaml.model.interface import Struct, TypeDefinition


def check(program: Program) -> Iterator[Diagnostic]:
    """Imports form no circles, so a circle of types lies within one module."""
    for linked in program.modules.values():
        for circle in circles(_uses(linked)):
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


Uses = dict[str, tuple[TypeDefinition, list[str]]]


def _uses(linked: LinkedModule) -> Uses:
    """The types of a module by name, each with the own types that it contains."""
    uses: Uses = {}
    for definition in linked.module.types:
        found = (linked.find(ref) for ref in types_of(definition) if not ref.is_basic)
        uses.setdefault(definition.name, (definition, [f[1].name for f in found if f and f[0] is linked]))
    return uses


def circles(uses: Uses) -> Iterator[list[TypeDefinition]]:
    """One circle for each knot of types that contain each other, from the type that the author wrote first.

    A walk in depth, without recursion; a type met again on the way closes a circle, and types on a reported circle
    are left out of later ones.
    """
    done: set[str] = set()
    for start in uses:
        way: dict[str, Iterator[str]] = {}
        todo = "" if start in done else start
        while todo or way:
            if todo:
                way[todo] = iter(uses[todo][1])
            here = next(reversed(way))
            todo = ""
            for name in way[here]:
                if name in way:
                    names = list(way)
                    circle = names[names.index(name) :]
                    if not done.intersection(circle):
                        yield _from_first([uses[member][0] for member in circle])
                    done.update(circle)
                elif name in uses and name not in done:
                    todo = name
                    break
            else:
                way.popitem()
                done.add(here)


def _from_first(circle: list[TypeDefinition]) -> list[TypeDefinition]:
    first = min(range(len(circle)), key=lambda i: circle[i].span)
    return circle[first:] + circle[:first]
