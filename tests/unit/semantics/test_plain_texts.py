"""What a text means as a plain value, by its type; and texts with quotes that are not theirs."""

from __future__ import annotations

import pytest

from robocomp_yaml.semantics import texts


@pytest.mark.parametrize(
    ("type_", "text", "value"),
    [
        ("bool", "TRUE", True),
        ("bool", " 0\t", False),
        ("bool", "tRue", None),
        ("bool", "yes", None),
        ("bool", "", None),
        ("int", "-07", -7),
        ("int", "+1.00", 1),
        ("int", "1.", 1),
        ("int", "1.5", None),
        ("int", "1e3", None),
        ("int", "0x10", None),
        ("int", "\u0663", None),
        ("long", "9" * 40, int("9" * 40)),
        ("long", "9" * 41, None),
        ("float", " .5 ", 0.5),
        ("float", "1e-3", 0.001),
        ("double", "1e400", None),
        ("double", "nan", None),
        ("double", "inf", None),
        ("double", "1_0", None),
        ("double", "", None),
        ("double", "1\n", None),
        ("string", " x ", " x "),
        ("Colour", "true", "true"),
    ],
)
def test_values_of_texts(type_: str, text: str, value: object) -> None:
    read = texts.read(type_, text)
    assert read == value and type(read) is type(value)


@pytest.mark.parametrize(
    ("text", "count"), [("3", 3), ("007", 7), ("11", None), ("-1", None), ("1.0", None), ("²", None)]
)
def test_counts(text: str, count: int | None) -> None:
    assert texts.count(text, 10) == count


@pytest.mark.parametrize(
    ("value", "bare"),
    [
        ('"tcp -p 1"', "tcp -p 1"),
        ('" ""0"', '" ""0"'),
        ('"', '"'),
        ('""', ""),
        ("x", "x"),
        ('"a" b', '"a" b'),
    ],
)
def test_quotes_of_flat_toml(value: str, bare: str) -> None:
    assert texts.unquoted(value) == bare
