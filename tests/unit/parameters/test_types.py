"""Types of parameters: what is one step below."""

from __future__ import annotations

import pytest

from parameters import parameters
from robocomp_yaml.parameters.types import below

PDSL = "component: c.cdsl.yaml\nparameters: {l: {list: {list: int}}, m: {map: string}, g: {group: {a: bool}}}\n"


@pytest.mark.parametrize(
    ("steps", "name"),
    [
        (("l", 3, 0), "int"), (("l", "3", "0"), "int"), (("l", "x"), None), (("l", "-1"), None), (("l", "²"), None),
        (("m", "any"), "string"), (("g", "a"), "bool"), (("g", "b"), None), (("g", 0), None), (("g", "a", "b"), None),
        (("none",), None),
    ],
)  # fmt: skip
def test_what_is_below(steps: tuple[str | int, ...], name: str | None) -> None:
    found, _ = parameters(PDSL)
    type_ = found.root
    for step in steps:
        type_ = below(type_, step)
    assert getattr(type_, "name", None) == name
