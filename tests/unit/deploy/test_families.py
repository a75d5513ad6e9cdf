"""Families of the children of a supervisor, from a table of processes."""

from __future__ import annotations

import pytest

from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.local.procfs import ProcessEntry, descendants, families

ME = 100


def entry(pid: int, parent: int, session: int) -> ProcessEntry:
    return ProcessEntry(pid, parent, pid, session, 0, 0.0, False, False)


def test_each_process_belongs_to_one_family(monkeypatch: pytest.MonkeyPatch) -> None:
    marks = {30: "f:a", 32: "f:b", 33: "other"}
    monkeypatch.setattr(procfs, "mark_of", lambda pid: marks.get(pid, ""))
    alive = {
        one.pid: one
        for one in [
            entry(1, 0, 1), entry(ME, 1, ME),
            entry(10, ME, 10), entry(11, 10, 10), entry(12, 11, 12), entry(13, 12, 12),  # 12 has a session of its own
            entry(20, ME, 20), entry(21, 1, 20),  # in 20's session, although its parent has ended
            entry(30, ME, 30), entry(31, 30, 30),  # an orphan with the mark of 10's process
            entry(32, ME, 32), entry(33, ME, 33), entry(34, ME, 34),  # marks of another root, another tool, none
            entry(40, 1, 40), entry(41, 40, 40), entry(42, 77, 42),  # not in any family
        ]
    }  # fmt: skip
    found = families({10: "f:a", 20: "f:b", 50: "f:c"}, ME, alive)
    assert found == {10: {10, 11, 12, 13, 30, 31}, 20: {20, 21, 32}, 50: set()}
    assert descendants([40, 11], alive) == {40, 41, 11, 12, 13}
