"""The expression language of the data model null: conditions, literals, scripts."""

from __future__ import annotations

import pytest

from robocomp_yaml.model.conditions import (
    MAX_PARTS,
    Condition,
    NullSyntaxError,
    condition,
    literal,
    script,
)

LOW, NEAR = Condition("guard", "low"), Condition("guard", "near")


@pytest.mark.parametrize(("text", "found"), [
    ("low", LOW),
    ("low()", LOW),
    (" low ( ) ", LOW),
    ("true", Condition("always")),
    ("False", Condition("never")),
    ("In('a')", Condition("in", "a")),
    ('In ( "a" )', Condition("in", "a")),
    ("not low", Condition("not", parts=(LOW,))),
    ("!low && near", Condition("and", parts=(Condition("not", parts=(LOW,)), NEAR))),
    ("low or near and low", Condition("or", parts=(LOW, Condition("and", parts=(NEAR, LOW))))),
    ("(low || near) and low", Condition("and", parts=(Condition("or", parts=(LOW, NEAR)), LOW))),
    ("not not low", Condition("not", parts=(Condition("not", parts=(LOW,)),))),
])  # fmt: skip
def test_conditions(text: str, found: Condition) -> None:
    assert condition(text) == found


@pytest.mark.parametrize("text", [
    "", "low near", "low and", "and", "(low", "low)", "low == 3", "low(1)", "In(a)", "In()", "__import__('os')",
    "low; near", "a.b", "!= low", "1", "not", "low " + "or low " * MAX_PARTS,
])  # fmt: skip
def test_wrong_conditions(text: str) -> None:
    with pytest.raises(NullSyntaxError):
        condition(text)


def test_a_condition_has_so_many_words_and_no_more() -> None:
    most = " or ".join(["low"] * (MAX_PARTS // 2))
    assert condition(most).kind == "or"
    with pytest.raises(NullSyntaxError, match=f"at most {MAX_PARTS} words"):
        condition(f"{most} or low or low")


@pytest.mark.parametrize(("text", "json"), [
    ("'a b'", '"a b"'), ('"é"', '"é"'), ("3", "3"), ("-2.5", "-2.5"), (".5", "0.5"), ("1e3", "1000"),
    ("True", "true"), ("false", "false"), ("''", '""'),
])  # fmt: skip
def test_literals(text: str, json: str) -> None:
    assert literal(text) == json


@pytest.mark.parametrize("text", ["", "a", "'a", "'a' + 'b'", "1 + 1", "[1]", "nan", "1_000", "'a\\'b'"])
def test_wrong_literals(text: str) -> None:
    with pytest.raises(NullSyntaxError):
        literal(text)


def test_scripts() -> None:
    assert script(" park; beep()\n  stop ( ) ;; ") == ["park", "beep", "stop"]
    for text in ("park(1)", "x = 1", "park beep", "import os"):
        with pytest.raises(NullSyntaxError):
            script(text)
