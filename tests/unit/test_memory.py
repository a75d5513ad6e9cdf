"""Results are kept as long as their causes are the same, and no longer."""

from __future__ import annotations

import pytest

from robocomp_yaml.diag.span import Span
from robocomp_yaml.memory import Memory
from robocomp_yaml.model.located import Text

HERE, BELOW = Text("a", span=Span("f", 1, 1)), Text("a", span=Span("f", 2, 1))


@pytest.mark.parametrize(
    ("causes", "others", "is_kept"),
    [
        ((), (), True),
        (("a", 1, b"x", None, ("b", ())), ("a", 1, b"x", None, ("b", ())), True),
        ((HERE,), (HERE,), True),
        ((HERE,), (BELOW,), False),  # equal, but elsewhere
        (("a",), ("b",), False),
        ((1,), (True,), False),
        ((1,), (1.0,), False),
        (("a",), ("a", "b"), False),
        ((("a", HERE),), (("a", BELOW),), False),
        (([],), ([],), False),
    ],
)
def test_a_result_is_kept_for_the_same_causes(
    causes: tuple[object, ...], others: tuple[object, ...], is_kept: bool
) -> None:
    memory = Memory()
    first = memory.result("part", causes, object)
    assert (memory.result("part", others, object) is first) == is_kept
    assert memory.result("other part", causes, object) is not first


def test_a_result_that_says_that_it_holds_no_more_is_made_again() -> None:
    memory = Memory()
    first = memory.result("part", ("a",), object)
    assert memory.result("part", ("a",), object, lambda kept: kept is first) is first
    assert memory.result("part", ("a",), object, lambda kept: kept is not first) is not first


def test_only_the_last_result_of_a_part_is_kept() -> None:
    memory = Memory()
    first = memory.result("part", ("a",), object)
    memory.result("part", ("b",), object)
    assert memory.result("part", ("a",), object) is not first
    assert len(memory._results) == 1


def test_what_two_rounds_do_not_use_is_forgotten() -> None:
    memory = Memory()
    memory.result("old", (), object)
    for kept in (2, 2, 2, 1):
        memory.result("new", (), object)
        assert len(memory._results) == kept
        memory.forget_unused()


def test_parts_are_prepared_only_for_an_analysis_that_others_follow() -> None:
    memory = Memory()
    assert memory.parts("a.yaml") is memory.parts("a.yaml") is not None
    assert Memory(once=True).parts("a.yaml") is memory.fork().parts("a.yaml") is None
