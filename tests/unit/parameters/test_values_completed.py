"""Values completed: what is not given comes from defaults, at every level, and what is given stays."""

from __future__ import annotations

from typing import Any

import cerberus
import pytest

from parameters import Data, linked, values
from robocomp_yaml.link.program import Program
from robocomp_yaml.parameters.hidden import secrets_of
from robocomp_yaml.parameters.layers import effective as layers
from robocomp_yaml.parameters.layers.effective import effective

DOCUMENT: Data = {
    "types": {
        "Point": {"struct": {"x": "double", "y": {"type": "double", "default": 2}, "tag": {"type": "string", "optional": True}}},
        "Arm": {"struct": {"name": "string", "at": {"type": "Point", "default": {"x": 1}}, "way": {"list": "Point", "default": []}}},
    },
    "parameters": {
        "arms": {"list": "Arm", "default": []},
        "named": {"map": {"list": "Point"}, "default": {"home": [{"x": 0}]}},
        "camera": {"group": {"rate": {"type": "int", "default": 30}, "device": "string"}},
        "speed": {"type": "double", "optional": True},
    },
}  # fmt: skip
PERIOD = {"compute": 100, "emergency": 500}
LEFT = {"name": "left", "at": {"x": 1, "y": 2}, "way": []}


def completed(**given: Any) -> Data:
    found, faults = effective(values(linked(DOCUMENT), {"camera": {"device": "d"}, **given}))
    assert found is not None, faults
    return found.data


def test_extensions_in_lists_are_no_values() -> None:
    arms = [{"name": "left", "at": {"x": 1, "x-at": {"a": 1}}, "x-note": "new"}]
    assert completed(arms=arms)["arms"] == [LEFT]


def test_the_names_of_secrets() -> None:
    found = linked({
        "types": {"Login": {"struct": {"user": "string", "pin": {"type": "string", "secret": True}}}},
        "parameters": {"logins": {"list": "Login", "default": []}, "code": {"type": "string", "secret": True}, "n": "int"},
    })  # fmt: skip
    assert secrets_of(found) == ("code", "pin")


def test_defaults_alone() -> None:
    assert completed() == {
        "arms": [],
        "named": {"home": [{"x": 0, "y": 2}]},
        "camera": {"rate": 30, "device": "d"},
        "period": PERIOD,
    }


@pytest.mark.parametrize(
    ("given", "whole"),
    [
        ({"name": "left"}, LEFT),
        ({"way": [], "name": "left"}, LEFT),
        (LEFT, LEFT),
        ({"name": "left", "at": {"x": 5}}, {**LEFT, "at": {"x": 5, "y": 2}}),
        ({"name": "left", "at": {"y": 5, "x": 1, "tag": "t"}}, {**LEFT, "at": {"x": 1, "y": 5, "tag": "t"}}),
        ({"name": "left", "way": [{"x": 1}, {"x": 2, "y": 3}]}, {**LEFT, "way": [{"x": 1, "y": 2}, {"x": 2, "y": 3}]}),
        ({"name": {"env": "SIDE"}}, {**LEFT, "name": {"env": "SIDE"}}),
    ],
)
def test_records_that_lack_something(given: Data, whole: Data) -> None:
    other = {"name": "right", "at": {"x": 9, "y": 9}}
    assert completed(arms=[other, given, other, given])["arms"] == [{**LEFT, **other}, whole, {**LEFT, **other}, whole]


def test_what_is_completed_stands_in_the_order_of_its_type() -> None:
    arms = completed(arms=[{"way": [], "name": name} for name in "ab"])["arms"]
    assert [list(arm) for arm in arms] == [["name", "at", "way"]] * 2


def test_maps_and_lists_inside_of_each_other() -> None:
    assert completed(named={"a b": [{"x": 1}], "": []})["named"] == {"a b": [{"x": 1, "y": 2}], "": []}


def test_of_many_records_that_lack_the_same_cerberus_sees_one(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Data] = []
    normalized = cerberus.Validator.normalized

    def counted(self: Any, document: Data, *args: Any, **more: Any) -> Any:
        if "name" in document:  # and no part of it
            seen.append(document)
        return normalized(self, document, *args, **more)

    monkeypatch.setattr(cerberus.Validator, "normalized", counted)
    found = completed(arms=[{"name": f"arm{n}"} for n in range(50)] + [{"name": "other", "way": []}])["arms"]
    assert [arm["name"] for arm in seen] == ["arm0", "other"]
    assert [arm["name"] for arm in found] == [*(f"arm{n}" for n in range(50)), "other"]
    assert all(arm["at"] == {"x": 1, "y": 2} for arm in found)


def test_a_program_works_values_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def counted(document: Any) -> Any:
        asked.append(document)
        return effective(document)

    monkeypatch.setattr(layers, "effective", counted)
    program, of = Program(), linked(DOCUMENT)
    good, bad = values(of, {"camera": {"device": "d"}}), values(of, {"camera": {"rate": "fast"}})
    first = [program.effective(document) for document in (good, bad)]
    assert all(program.effective(document) is found for document, found in zip((good, bad), first, strict=True))
    assert asked == [good, bad]
    assert first[0][0] is not None and first[1][0] is None
    assert [fault.fact("path") for fault in first[1][1]] == ["camera.rate", "camera.device"]
