"""The merge of texts, which has the same result with git and with merge3."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from robocomp_yaml.emit.specific import threeway
from robocomp_yaml.emit.specific.threeway import merge

pytestmark = pytest.mark.processes  # runs git

BASE = "".join(f"line {n}\n" for n in range(1, 13))


@pytest.fixture(params=["git", "merge3"], autouse=True)
def _engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.param == "merge3":
        monkeypatch.setattr(threeway, "_git", lambda: None)
    elif threeway._git() is None:
        pytest.skip("git is not installed")


def edit(old: str, new: str) -> str:
    assert old in BASE
    return BASE.replace(old, new, 1)


def test_changes_of_both_sides_are_merged() -> None:
    merged = merge(BASE, edit("line 2\n", "mine\n"), edit("line 9\n", "line 9\nnew\n"))
    assert merged.text == edit("line 2\n", "mine\n").replace("line 9\n", "line 9\nnew\n")
    assert not merged.conflicts


@pytest.mark.parametrize("ending", ["\n", ""])
def test_a_conflict_has_its_lines_and_both_texts(ending: str) -> None:
    yours = edit("line 1\n", "mine\nline 1\n").replace("line 12\n", f"my 12{ending}")
    merged = merge(BASE, yours, edit("line 12\n", "new 12\n"))
    (conflict,) = merged.conflicts
    assert (conflict.first, conflict.end) == (12, 13)
    assert conflict.text == (
        "<<<<<<< yours\nmy 12\n||||||| as generated before\nline 12\n=======\nnew 12\n>>>>>>> as generated now\n"
    )
    assert merged.text.rstrip("\n") == yours.rstrip("\n"), "the user's side of it"


def test_a_conflict_with_deleted_lines() -> None:
    merged = merge(BASE, edit("line 5\nline 6\n", ""), edit("line 5\n", "new 5\n"))
    (conflict,) = merged.conflicts
    assert (conflict.first, conflict.end) == (4, 4)
    assert merged.text == edit("line 5\nline 6\n", "")


@pytest.mark.parametrize("same", ["yours is new", "yours is base", "new is base"])
def test_changes_of_one_side(same: str) -> None:
    yours, new = BASE + "mine\n", "new\n" + BASE
    results: dict[str, Callable[[], object]] = {
        "yours is new": lambda: merge(BASE, new, new).text == new,
        "yours is base": lambda: merge(BASE, BASE, new).text == new,
        "new is base": lambda: merge(BASE, yours, BASE).text == yours,
    }
    assert results[same]()
