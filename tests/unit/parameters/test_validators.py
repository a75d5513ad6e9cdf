"""Of all compiled schemas, those used last are kept."""

from __future__ import annotations

import gc

import pytest

from robocomp_yaml.parameters import validators
from robocomp_yaml.parameters.validators import ValuesValidator


@pytest.fixture(autouse=True)
def _few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(validators, "MOST", 3)
    monkeypatch.setattr(validators, "_used_last", type(validators._used_last)())


def test_what_was_not_used_for_long_is_compiled_again() -> None:
    compiled: list[int] = []

    def schema(number: int) -> dict[str, object]:
        compiled.append(number)
        return {"maximum": number}

    made = [ValuesValidator() for _ in range(4)]
    for number, one in enumerate(made[:3]):
        assert one.is_valid(number, lambda number=number: schema(number))  # type: ignore[misc]
    assert made[0].is_valid(0, lambda: schema(0)) and compiled == [0, 1, 2]
    assert not made[3].is_valid(4, lambda: schema(3))
    assert made[0].is_valid(0, lambda: schema(0)) and compiled == [0, 1, 2, 3], "the one of before was used later"
    assert not made[1].is_valid(2, lambda: schema(1)) and compiled == [0, 1, 2, 3, 1]


def test_what_nothing_uses_any_more_is_not_kept() -> None:
    for _ in range(20):
        assert ValuesValidator().is_valid(1, dict)
    gc.collect(0)  # they are young; all objects of the run would take a tenth of a second
    assert len(validators._used_last) <= 3
    assert ValuesValidator().is_valid(1, dict)
