"""Whatever is spelled is read back as the same: paths, plain values, TOML, YAML in blocks, docstrings."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from typing import Any

from hypothesis import example, given
from hypothesis import strategies as st

from robocomp_yaml.languages.python.text import docstring
from robocomp_yaml.semantics import paths, texts
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.semantics.toml_lines import properties
from robocomp_yaml.source.tree import parse
from robocomp_yaml.source.yaml_text import block

KEYS = st.text(max_size=8) | st.sampled_from(
    ["", "keys", "size", "%", "%41", "a.b", "a b", "é", "\ufeff", "\ud800", "=#"]
)
plain = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(max_size=30)
anything = st.recursive(
    plain,
    lambda inner: st.lists(inner, max_size=12) | st.dictionaries(st.text(min_size=1, max_size=9), inner, max_size=6),
)


@given(KEYS, KEYS)
def test_a_path(one: str, other: str) -> None:
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


@given(st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False))
def test_a_plain_value(value: bool | float) -> None:
    type_ = "bool" if isinstance(value, bool) else "long" if isinstance(value, int) else "double"
    assert texts.read(type_, texts.spelled(value)) == value


def flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, str(value)


WORDS = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs", "Zl", "Zp"], exclude_characters='"\\'))


@given(tables=st.dictionaries(
    st.from_regex(r"[A-Za-z][A-Za-z0-9_-]{0,5}(\.[a-z]{1,3})?", fullmatch=True),
    st.dictionaries(st.from_regex(r"[A-Za-z0-9_-]{1,5}", fullmatch=True), st.integers() | WORDS, min_size=1), max_size=4,
))  # fmt: skip
def test_toml_is_read_as_the_standard_library_reads_it(tables: dict[str, dict[str, int | str]]) -> None:
    text = ""
    for name, table in tables.items():
        text += f"[{name}]\n"
        for key, value in table.items():
            literal = f'"{value}"' if isinstance(value, str) else value
            text += f"{key} = {literal} # {key}\n"
    try:
        expected = dict(flat(tomllib.loads(text)))
    except tomllib.TOMLDecodeError:  # a table that is also a key
        return
    assert {key: unquoted(value) for key, value in properties(text).items()} == expected


@given(anything, st.sampled_from([20, 100]))
def test_data_in_blocks(data: Any, width: int) -> None:
    root, faults = parse("text", block(data, width))
    assert root is not None, [str(one) for one in faults]
    assert root.data == data


@given(st.lists(st.sampled_from(('"', "\\", "a", " ", "\x80", "\t", "'", "\n", "é")), max_size=10).map("".join))
@example('"\x80""')
@example('\\"')
def test_a_docstring_is_one_text(text: str) -> None:
    tree = ast.parse(f"x = {docstring(text, '')}")
    assert isinstance(tree.body[0].value, ast.Constant)
