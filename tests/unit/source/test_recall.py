"""A result that reads the disk is kept as long as it would read the same again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from robocomp_yaml.memory import Memory
from robocomp_yaml.source.disk import Disk, KeptFiles
from robocomp_yaml.source.recall import recalled

READS: dict[str, Callable[[Disk], object]] = {
    "content": lambda disk: disk.read("a.yaml")[0],
    "head": lambda disk: disk.peek("a.yaml", 3),
    "state": lambda disk: disk.state("b.yaml"),
    "documents": lambda disk: disk.documents(""),
    "names": lambda disk: disk.names(""),
    "nothing": lambda disk: None,
}
CHANGES: dict[str, Callable[[], object]] = {
    "same": lambda: Path("a.yaml").write_text("old"),
    "content": lambda: Path("a.yaml").write_text("new"),
    "another file": lambda: Path("b.yaml").write_text("new"),
}


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.yaml").write_text("old")


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("read", READS)
@pytest.mark.parametrize("is_saved", [True, False])
def test_a_recalled_result_is_that_of_a_fresh_disk(read: str, change: str, is_saved: bool) -> None:
    memory, files = Memory(), KeptFiles()
    recalled(memory, Disk(None, files), "part", (), READS[read])
    overlay: dict[str, bytes] = {}
    if is_saved:
        CHANGES[change]()
        files.renew()
    elif change != "same":
        overlay = {"a.yaml" if change == "content" else "b.yaml": b"new"}
    disk, fresh = Disk(overlay, files), Disk(overlay)
    made: list[Disk] = []

    def make(disk: Disk) -> object:
        made.append(disk)
        return READS[read](disk)

    assert recalled(memory, disk, "part", (), make) == READS[read](fresh)
    assert disk.record() == fresh.record()
    if change == "same" or (read == "nothing" and change == "content"):
        assert not made
