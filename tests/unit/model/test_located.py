"""Two parts of documents are equal if their contents are, at any location."""

from __future__ import annotations

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal, TypeRef


def test_the_location_is_ignored() -> None:
    here, there = TypeRef("float", span=Span("a.idsl.yaml", 1)), TypeRef("float", span=Span("b.idsl.yaml", 7))
    assert here == there
    assert not here != there
    assert hash(here) == hash(there)


def test_content_and_kind_are_compared() -> None:
    assert TypeRef("float") != TypeRef("double")
    assert not TypeRef("float") == TypeRef("double")
    assert TypeRef("1") != Literal(1, "1")
    assert Literal(True, "true") != Literal(True, "yes")
