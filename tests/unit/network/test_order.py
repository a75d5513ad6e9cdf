"""The order in which processes start: waves by dependences, and circles broken at a process that can wait."""

from __future__ import annotations

import pytest

from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.order import AFTER, Dependence, awaited, optional, ordered

Arrow = tuple[str, str, str]


def needs(*arrows: Arrow) -> list[Dependence]:
    """`("a", "b", "wait")`: a depends on b; `after` is from the document."""
    return [
        Dependence(
            source, target, "" if how == AFTER else how, AFTER if how == AFTER else "Proxy", Span("x", number + 1)
        )
        for number, (source, target, how) in enumerate(arrows)
    ]


def test_each_process_is_after_its_dependences() -> None:
    arrows = [("a", "b", "wait"), ("b", "c", "fail"), ("a", "d", AFTER), ("e", "c", "ignore")]
    waves, after, told = ordered("abcdef", needs(*arrows))
    assert waves == [("c", "d", "f"), ("b", "e"), ("a",)] and not told
    assert after["a"] == ("b", "d")


def test_optional_dependences() -> None:
    arrows = [("a", "b", "ignore"), ("a", "c", "ignore"), ("a", "c", "wait"), ("a", "d", "ignore"), ("a", "d", AFTER)]
    assert optional(needs(*arrows)) == {"a": {"b"}}


@pytest.mark.parametrize(
    ("arrows", "first"),
    [
        ([("a", "b", "wait"), ("b", "a", "wait")], "a"),
        ([("a", "b", "wait"), ("b", "a", "ignore")], "b"),
        ([("a", "b", "fail"), ("b", "a", "wait")], "b"),
        ([("a", "b", AFTER), ("b", "a", "wait")], "b"),
        ([("a", "b", "wait"), ("a", "b", "fail"), ("b", "a", "wait")], "b"),
        ([("a", "b", "fail"), ("b", "c", "fail"), ("c", "a", "wait")], "c"),
    ],
)
def test_in_a_circle_a_process_that_can_wait_starts_first(arrows: list[Arrow], first: str) -> None:
    waves, _, (told,) = ordered("abc", needs(*arrows))
    assert first in waves[0] and (told.code, told.severity) == ("RC4401", "warning")
    assert f"'{first}' starts before" in told.message
    circle = told.message.removeprefix("these processes depend on each other: ").partition(";")[0].split(" → ")
    assert circle[0] == circle[-1] == first and len(circle) == len(set(circle)) + 1


@pytest.mark.parametrize("how", ["fail", AFTER])
def test_a_circle_in_which_no_process_can_wait(how: str) -> None:
    _, _, (told,) = ordered("ab", needs(("a", "b", how), ("b", "a", how)))
    assert (told.code, told.severity) == ("RC4402", "error")


def test_a_process_that_depends_on_itself() -> None:
    waves, after, (told,) = ordered("a", needs(("a", "a", AFTER)))
    assert waves == [("a",)] and after == {"a": ()} and told.code == "RC4402"


def test_disabled_processes_are_ignored() -> None:
    assert ordered("a", needs(("a", "b", "wait"))) == ([("a",)], {"a": ()}, [])


@pytest.mark.parametrize(
    ("arrows", "expected"),
    [
        ([("a", "b", "wait"), ("b", "a", "fail")], {"a": ("b",)}),
        ([("a", "b", "ignore"), ("b", "a", "wait")], {}),
        ([("a", "b", "wait"), ("b", "c", "fail"), ("c", "a", AFTER)], {"a": ("b",)}),
        ([("a", "b", "wait"), ("b", "a", "fail"), ("c", "d", "wait"), ("d", "c", "fail")], {"a": ("b",), "c": ("d",)}),
        ([("a", "b", "wait"), ("c", "gone", "wait")], {}),
    ],
)
def test_what_starts_first_in_a_circle_awaits_the_other(arrows: list[Arrow], expected: dict[str, object]) -> None:
    needed = needs(*arrows)
    _, after, _ = ordered("abcd", needed)
    assert awaited(needed, after) == expected
