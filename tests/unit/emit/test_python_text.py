"""Docstrings: every text of a document stays inside its quotes."""

from __future__ import annotations

import ast

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robocomp_yaml.languages.python.text import docstring


@given(st.lists(st.sampled_from(('"', "\\", "a", " ", "\x80", "\t", "'", "\n", "é")), max_size=10).map("".join))
@example('"\x80""')
@example('\\"')
def test_it_is_one_text(text: str) -> None:
    tree = ast.parse(f"x = {docstring(text, '')}")
    assert isinstance(tree.body[0].value, ast.Constant)


@pytest.mark.parametrize("text", ["Says things.", 'Says "things"', "C:\\temp"])
def test_it_has_the_text(text: str) -> None:
    assert ast.literal_eval(docstring(text, "")) == text
