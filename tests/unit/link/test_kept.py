"""A linked document is kept only if each of its facts is the same."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest
from msgspec.structs import force_setattr

from robocomp_yaml.link.kept import facts_of
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, LinkedParameters, LinkedValues, Port
from robocomp_yaml.memory import Memory
from robocomp_yaml.model.interface import Module

ANY: Any = "any"
LINKED: dict[type[msgspec.Struct], tuple[Any, ...]] = {
    LinkedModule: (Module("M", "M.idsl.yaml"),),
    Port: (ANY, ANY, ANY),
    LinkedParameters: (ANY,),
    LinkedValues: (ANY,),
    LinkedComponent: (ANY,),
}
ROWS = [(type_, field) for type_ in LINKED for field in type_.__struct_fields__ if not field.startswith("_")]


@pytest.mark.parametrize(("type_", "field"), ROWS, ids=lambda it: getattr(it, "__name__", it))
def test_each_field_is_a_cause(type_: type[msgspec.Struct], field: str) -> None:
    one, other = type_(*LINKED[type_]), type_(*LINKED[type_])
    for name in type_.__struct_fields__:
        force_setattr(other, name, getattr(one, name))
    memory = Memory()
    first = memory.result("part", facts_of(one), object)
    assert memory.result("part", facts_of(other), object) is first
    force_setattr(other, field, ("another",))
    assert memory.result("part", facts_of(other), object) is not first
