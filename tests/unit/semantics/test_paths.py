"""Paths of values, in words and in properties, and the keys of maps in them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml.semantics import paths

KEYS = st.text(max_size=8) | st.sampled_from(
    ["", "keys", "size", "%", "%41", "a.b", "a b", "é", "\ufeff", "\ud800", "=#"]
)


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


@given(KEYS, KEYS)
def test_whatever_is_written_is_read_back(one: str, other: str) -> None:
    steps = ["top", 3, one, other]
    said = [str(step) for step in steps]
    if not {*one, *other} & {*"[]"}:  # which a path may have instead of dots
        assert paths.parse(paths.dotted(steps)) == [*said[:2], *(_kept(key) for key in said[2:])]
    if one and other:
        assert paths.parse(paths.in_words(steps)) == said


def _kept(key: str) -> str:
    """A half of a pair of surrogates is no character: three signs stand for it."""
    return key.encode("utf-8", "surrogatepass").decode("utf-8", "replace")


@given(KEYS)
def test_a_key_is_one_segment_of_a_name(key: str) -> None:
    segment = paths.escaped(key)
    assert segment and segment != "keys" and segment.isprintable()
    assert not set(segment) & set(".= \t\n\ufeff")
    assert paths.unescaped(segment) == _kept(key)


@pytest.mark.parametrize(
    ("key", "segment"), [("", "%"), ("keys", "%6Beys"), ("a.b", "a%2Eb"), ("100%", "100%25"), ("ñ", "ñ"), ("\t", "%09")]
)
def test_what_is_escaped(key: str, segment: str) -> None:
    assert paths.escaped(key) == segment


def test_what_is_no_escape_stands_for_itself() -> None:
    assert [paths.unescaped(text) for text in ("50%", "%zz", "%4", "%41%")] == ["50%", "%zz", "%4", "A%"]
