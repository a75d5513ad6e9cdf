"""Docstrings: every text of a document stays inside its quotes."""

from __future__ import annotations

import ast

import pytest

from robocomp_yaml.languages.python.text import docstring


@pytest.mark.parametrize("text", ["Says things.", 'Says "things"', "C:\\temp"])
def test_it_has_the_text(text: str) -> None:
    assert ast.literal_eval(docstring(text, "")) == text
