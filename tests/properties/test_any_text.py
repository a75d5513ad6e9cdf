"""Any text is read, or is rejected with its faults: YAML, and conditions of state machines."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml.model.conditions import NullSyntaxError, condition, names
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import parse


@given(st.text(alphabet=st.characters(codec="utf-8"), max_size=60))
def test_no_text_gives_a_traceback(text: str) -> None:
    decoded, diagnostics = decode("x.yaml", text.encode())
    tree = None
    if decoded is not None:
        tree, diagnostics = parse("x.yaml", decoded)
    assert (tree is None) == bool(diagnostics)


@given(st.text(alphabet="ab:{}[],&*!|>-'\"# \n\t?0.%@", max_size=40))
def test_no_punctuation_gives_a_traceback(text: str) -> None:
    tree, diagnostics = parse("x.yaml", text)
    assert (tree is None) == bool(diagnostics)
    lines = text.split("\n")
    for diagnostic in diagnostics:
        assert 1 <= diagnostic.span.line <= len(lines)


@given(st.text(alphabet="lowIn('a') andort!&|=.;\n\0é", max_size=60))
def test_any_text_is_a_condition_or_is_rejected(text: str) -> None:
    try:
        found = condition(text)
    except NullSyntaxError:
        return
    assert all(name.isidentifier() and name.isascii() for name in names(found, "guard"))
