"""Two parts of documents are equal when they say the same, wherever they stand."""

from __future__ import annotations

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Literal, TypeRef


def test_the_place_does_not_count() -> None:
    here, there = TypeRef("float", span=Span("a.idsl.yaml", 1)), TypeRef("float", span=Span("b.idsl.yaml", 7))
    assert here == there
    assert not here != there
    assert hash(here) == hash(there)


def test_the_content_and_the_kind_count() -> None:
    assert TypeRef("float") != TypeRef("double")
    assert not TypeRef("float") == TypeRef("double")
    assert TypeRef("1") != Literal(1, "1")
    assert Literal(True, "true") != Literal(True, "yes")
