"""Full names of topics: closed in the innermost include that has both ends."""

from __future__ import annotations

import pytest

from robocomp_yaml.network.topic_names import NamedEnd, full_names

SCOPES = ("", "l.", "r.", "l.hand.", "r.hand.")
OUT, IN = True, False

CASES: tuple[tuple[str, list[NamedEnd], list[str]], ...] = (
    ("the innermost include that has both ends", [
        NamedEnd("l.hand.a", "l.hand.", "T", OUT), NamedEnd("l.hand.b", "l.hand.", "T", IN),
        NamedEnd("l.c", "l.", "T", IN), NamedEnd("d", "", "T", OUT),
    ], ["l/hand/T", "l/hand/T", "T", "T"]),
    ("ends in two inner includes of one", [
        NamedEnd("l.hand.a", "l.hand.", "T", OUT), NamedEnd("l.c", "l.", "T", IN), NamedEnd("r.c", "r.", "T", IN),
    ], ["l/T", "l/T", "T"]),
    ("alike that talk to each other", [
        NamedEnd("l.a", "l.", "T", OUT), NamedEnd("l.a", "l.", "T", IN),
        NamedEnd("r.a", "r.", "T", OUT), NamedEnd("r.a", "r.", "T", IN),
    ], ["T", "T", "T", "T"]),
    ("a name that leads inside", [NamedEnd("d", "", "l/hand/T", IN), NamedEnd("l.hand.a", "l.hand.", "T", OUT)],
     ["l/hand/T", "l/hand/T"]),
    ("a name that leads inside, where nobody is", [NamedEnd("d", "", "l/T", IN), NamedEnd("r.a", "r.", "T", OUT)],
     ["l/T", "T"]),
    ("from one include into the other", [NamedEnd("l.a", "l.", "/r/T", IN), NamedEnd("r.a", "r.", "T", OUT)],
     ["r/T", "r/T"]),
    ("out of all of them", [NamedEnd("l.a", "l.", "/T", IN), NamedEnd("l.b", "l.", "T", OUT)], ["T", "T"]),
    ("a name like a path, which leads nowhere", [
        NamedEnd("l.a", "l.", "zed/T", OUT), NamedEnd("l.b", "l.", "zed/T", IN),
    ], ["l/zed/T", "l/zed/T"]),
    ("nothing but a slash", [NamedEnd("a", "", "/", OUT)], ["/"]),
)  # fmt: skip


@pytest.mark.parametrize(("ends", "names"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_full_names(ends: list[NamedEnd], names: list[str]) -> None:
    assert full_names(ends, SCOPES) == names


def test_an_icestorm_of_an_include() -> None:
    ends = [NamedEnd("l.a", "l.", "T", OUT), NamedEnd("l.b", "l.", "T", IN), NamedEnd("l.hand.c", "l.hand.", "/T", IN)]
    assert full_names(ends, SCOPES, "l.") == ["T", "T", "T"]
