"""Keys that belong one level deeper, in each kind of document."""

from __future__ import annotations

import pytest

from robocomp_yaml.source import schema, tree

CASES = [
    ("idsl", "module: A\ninterfaces: {Base: {get: {returns: float}}}\n", "get", "write it below `methods:`"),
    ("idsl", "module: A\nSide: {enum: [left, right]}\n", "Side", "write it below `types:`"),
    ("idsl", "module: A\nArm: {methods: {go: }}\n", "Arm", "known keys: doc"),  # an interface, or a topic
    ("idsl", "module: A\ninterfaces: {Base: {methods: {put: {params: {x: float}}}}}\n", "params", "did you mean 'in'?"),
    ("pdsl", "device: {type: string, default: x}\n", "device", "write it below `parameters:`"),
    ("pdsl", "parameters: {g: {n: {type: int, range: [0, 1]}}}\n", "n", "write it below `group:`"),
    ("pdsl", "parameters: {g: {n: int}}\n", "n", "known keys: doc"),
    ("ddsl", "deployment: A\nmouth: {program: sleep}\n", "mouth", "write it below `components:`"),
    ("ddsl", "deployment: A\nlocal: {address: 1.2.3.4}\n", "local", "write it below `hosts:`"),
    ("ddsl", "deployment: A\nhots: {local: 1.2.3.4}\n", "hots", "did you mean 'hosts'?"),
    ("cdsl", "component: A\nlanguage: python\nnothing: {x: 1}\n", "nothing", "known keys: doc"),
]


@pytest.mark.parametrize(("kind", "text", "key", "hint"), CASES, ids=[f"{one[0]}-{one[2]}" for one in CASES])
def test_where_a_key_belongs(kind: str, text: str, key: str, hint: str) -> None:
    root, _ = tree.parse("a.yaml", text)
    assert root is not None
    found = schema.validate(kind, root)
    assert [str(one.hint).startswith(hint) for one in found if one.fact("key") == key] == [True], found
