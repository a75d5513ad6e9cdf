"""Paths of values, in words and in properties, and the keys of maps in them."""

from __future__ import annotations

import pytest

from robocomp_yaml.semantics import paths


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("speed", ["speed"]),
        ("motors[0].vel", ["motors", "0", "vel"]),
        ("motors.0.vel", ["motors", "0", "vel"]),
        ('offsets["a.b"]', ["offsets", "a.b"]),
        (r'offsets["a\"b\\"].x', ["offsets", r'a"b' + "\\", "x"]),
        ("offsets['a b']", ["offsets", "a b"]),
        ("offsets.a%2Eb.%", ["offsets", "a.b", ""]),
        ("", []),
        (".a", []),
        ("a..b", []),
        ("a[", []),
        ("a[x]", []),
        ("a[-1]", []),
        ("[0]a", []),
        ("a[1234567890]", []),
    ],
)
def test_both_spellings_are_read(text: str, steps: list[str]) -> None:
    assert paths.parse(text) == steps


@pytest.mark.parametrize(
    ("key", "segment"), [("", "%"), ("keys", "%6Beys"), ("a.b", "a%2Eb"), ("100%", "100%25"), ("ñ", "ñ"), ("\t", "%09")]
)
def test_what_is_escaped(key: str, segment: str) -> None:
    assert paths.escaped(key) == segment


def test_what_is_no_escape_stands_for_itself() -> None:
    assert [paths.unescaped(text) for text in ("50%", "%zz", "%4", "%41%")] == ["50%", "%zz", "%4", "A%"]
