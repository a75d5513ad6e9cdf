"""Whatever the order of compiles, edits, removals and kills: no text of the user is lost, and the tree is the plan."""

from __future__ import annotations

import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from disk import always, carry_out, killed_in, once, plan
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.transactions.plan import ONCE, FilePlan

PATHS = ("generated/a", "generated/deep/b", "etc/config")
OWNERS = ("one.cdsl.yaml", "two.cdsl.yaml")

file_plans = st.builds(
    lambda path, text, make: make(path, text),
    st.sampled_from(PATHS),
    st.sampled_from(("1\n", "2\n")),
    st.sampled_from((always, once)),
)
# Both documents may want a file only in the same way: each plan is a choice from one list.
plans = st.lists(file_plans, min_size=1, max_size=3, unique_by=lambda file: file.path)
actions = st.one_of(
    st.tuples(
        st.just("compile"),
        plans,
        st.sets(st.sampled_from(OWNERS), min_size=1),
        st.booleans(),
        st.one_of(st.none(), st.integers(1, 60)),
    ),
    st.tuples(st.just("edit"), st.sampled_from((*PATHS, "generated/a.orig"))),
    st.tuples(st.just("delete"), st.sampled_from((*PATHS, *OWNERS, "generated/a.orig"))),
)


class User:
    """Writes texts that occur nowhere else, and knows which of them ought to be there still."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.written = 0
        self.treasured: set[str] = set()

    def edit(self, path: str) -> None:
        self._forget(path)
        self.written += 1
        text = f"mine {self.written}\n"
        target = self.root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
        self.treasured.add(text)

    def delete(self, path: str) -> None:
        self._forget(path)
        (self.root / path).unlink(missing_ok=True)

    def lost(self) -> set[str]:
        return self.treasured - {path.read_text() for path in self.root.rglob("*") if path.is_file()}

    def _forget(self, path: str) -> None:
        target = self.root / path
        if target.is_file() and target.read_text() not in self._elsewhere(target):
            self.treasured.discard(target.read_text())

    def _elsewhere(self, target: Path) -> set[str]:
        return {path.read_text() for path in self.root.rglob("*") if path.is_file() and path != target}


def compile_(root: Path, files: list[FilePlan], owners: set[str], *, adopt: bool, kill: int | None) -> None:
    planned = [plan(root, *files, owner=owner) for owner in sorted(owners)]
    if kill:
        with killed_in(kill):
            carry_out(*planned, adopt=adopt)
        # A run that was killed is followed by one that is not.
    _, said = carry_out(*planned, adopt=adopt)
    if has_errors(said):
        assert not adopt
        return
    for file in files:
        target = root / file.path
        assert target.is_file() if file.policy == ONCE else target.read_text() == file.text
    assert not carry_out(*planned)[0].dirty, "a second run finds nothing to do"


@given(st.lists(actions, max_size=12))
@settings(max_examples=150, deadline=None)
def test_nothing_of_the_user_is_lost(sequence: list[tuple]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        user = User(root)
        for what, *facts in sequence:
            if what == "compile":
                files, owners, adopt, kill = facts
                compile_(root, files, owners, adopt=adopt, kill=kill)
            elif what == "edit":
                user.edit(*facts)
            else:
                user.delete(*facts)
            assert not user.lost()
            assert not list(root.rglob(".rcyaml-*"))
