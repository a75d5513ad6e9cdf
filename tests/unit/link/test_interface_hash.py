"""Hashes of interfaces: equal if what travels is the same."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from robocomp_yaml.link.interface_hash import interface_hash
from robocomp_yaml.link.program import LinkedComponent

Link = Callable[[Mapping[str, str]], LinkedComponent]
TYPES = """\
module: RoboCompTypes
types:
  Side: {enum: [left, right]}
  Pose: {struct: {x: float, side: Side}}
  Path: {sequence: Pose}
  Named: {map: {key: string, value: Path}}
exceptions:
  Blocked: {struct: {at: Pose}}
"""
ARM = """\
module: RoboCompArm
imports: [Types]
interfaces:
  Arm:
    methods:
      move: {in: {path: Types.Path}, returns: float, throws: [Types.Blocked]}
      where: {out: {poses: Types.Named}, idempotent: true}
"""


@pytest.fixture
def hashed(link: Link) -> Callable[[str, str], str]:
    def of(types: str, arm: str) -> str:
        component = "component: C\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n"
        linked = link({"Types.idsl.yaml": types, "Arm.idsl.yaml": arm, "c.cdsl.yaml": component})
        return interface_hash(linked.implements[0])

    return of


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("x: float", "x: double"),
        ("x: float, side: Side", "side: Side, x: float"),
        ("[left, right]", "[right, left]"),
        ("{enum: [left, right]}", "{enum: {left: 0, right: 7}}"),
        ("{sequence: Pose}", "{sequence: float}"),
        ("key: string", "key: int"),
        ("at: Pose", "at: Side"),
        ("move:", "go:"),
        ("path: Types.Path", "way: Types.Path"),
        ("returns: float, ", ""),
        (", throws: [Types.Blocked]", ""),
        (", idempotent: true", ""),
        ("module: RoboCompArm", "module: RoboCompLeg"),
    ],
)
def test_a_change_that_travels(hashed: Callable[[str, str], str], old: str, new: str) -> None:
    assert (TYPES + ARM).count(old) == 1
    assert hashed(TYPES, ARM) != hashed(TYPES.replace(old, new), ARM.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("module: RoboCompTypes", "# Hello\nmodule: RoboCompTypes"),
        ("x: float", "x: {type: float, unit: mm, default: 2, doc: Where.}"),
        ("{enum: [left, right]}", "{enum: {left: 0, right: 1}}"),
        ("returns: float", "doc: Moves., returns: float"),
        ("types:\n", "types:\n  Unused: {struct: {n: int}}\n"),
    ],
)
def test_a_change_that_does_not(hashed: Callable[[str, str], str], old: str, new: str) -> None:
    assert hashed(TYPES, ARM) == hashed(TYPES.replace(old, new), ARM.replace(old, new))


def test_the_order_of_methods_does_not_matter(hashed: Callable[[str, str], str]) -> None:
    *head, move, where = ARM.splitlines(keepends=True)
    assert hashed(TYPES, ARM) == hashed(TYPES, "".join([*head, where, move]))
