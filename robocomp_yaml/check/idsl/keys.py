"""Keys of maps: only values that can be compared exactly."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.link.program import Definition, LinkedModule, Program
from robocomp_yaml.model.interface import Map, Sequence, Struct, TypeRef


def check(program: Program) -> Iterator[Diagnostic]:
    verdicts: dict[_Place, str] = {}
    for linked in program.modules.values():
        for definition in linked.module.types:
            if not isinstance(definition, Map):
                continue
            reason = _reason(linked, definition.key, verdicts)
            if reason == _SEQUENCE:
                yield codes.SEQUENCE_KEY.at(
                    definition.key.span, type=definition.key.text, hint="use a string, an integer, or a struct of them"
                )
            elif reason:
                yield codes.MAP_KEY.at(
                    definition.key.span,
                    type=definition.key.text,
                    reason=reason,
                    hint="a key is a bool, an integer, a string, an enum, or a struct of these",
                )


_SEQUENCE = "sequence"
_Place = tuple[LinkedModule, str]
"""A definition: its module, and its name there."""


def _reason(linked: LinkedModule, key: TypeRef, verdicts: dict[_Place, str]) -> str:
    """Why a type cannot be a key, or ''. `verdicts` remembers those of structs.

    The parts of a struct are judged from a list, not by recursion: structs may be nested a thousand deep.
    """
    todo: list[tuple[LinkedModule, TypeRef]] = [(linked, key)]
    seen: set[_Place] = set()
    found = ""
    while todo:
        scope, ref = todo.pop()
        part = f"a {ref.text} cannot be compared exactly" if ref.text in ("float", "double") else ""
        target = None if ref.is_basic else scope.find(ref)
        if target is not None and (place := (target[0], target[1].name)) not in seen:
            seen.add(place)
            part = verdicts.get(place, _of(target[1]))
            if isinstance(target[1], Struct) and place not in verdicts:
                todo += [(target[0], member.type) for member in target[1].members]
        if part and part != _SEQUENCE:
            found = part
            break
        found = found or part
    target = None if key.is_basic else linked.find(key)
    if target is not None:
        verdicts[target[0], target[1].name] = found
    return found


def _of(definition: Definition) -> str:
    """What a type is by itself, whatever it is made of."""
    if isinstance(definition, Map):
        return "a map cannot be a key"
    return _SEQUENCE if isinstance(definition, Sequence) else ""
